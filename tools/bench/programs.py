"""The programs that the benchmarks measure."""
import os
import subprocess
from pathlib import Path

BENCH = Path(__file__).resolve().parent


def graftal(needs=''):
    """Installs what is missing, builds graftal unless GRAFTAL_BUILD names a folder where it is, and returns its path.
    `needs`: more of tools/bench/common.sh, such as 'need cfdg contextfree'."""
    subprocess.run(['bash', '-c', f'set -e; . "{BENCH}/common.sh"; programs graftal; {needs}'], check=True)
    return str(Path(os.environ.get('GRAFTAL_BUILD') or BENCH.parent.parent / 'build/release') / 'graftal')
