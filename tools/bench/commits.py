"""The commit that figures are measured at."""
import os
import subprocess
from pathlib import Path


def name(root):
    """Its short name; a plus sign follows where the program's sources differ from it. A script that measures for long
    says in MEASURED_COMMIT what it was when the programs were built."""
    def git(*words):
        return subprocess.run(['git', '-C', root, *words], check=True, capture_output=True, text=True).stdout.strip()
    if os.environ.get('MEASURED_COMMIT'):
        return os.environ['MEASURED_COMMIT']
    changed = git('status', '--porcelain', '--untracked-files=no', 'compiler', 'runtime', 'tools/graftal')
    return git('rev-parse', '--short=7', 'HEAD') + ('+' if changed else '')


if __name__ == '__main__':
    print(name(Path(__file__).resolve().parent.parent.parent))
