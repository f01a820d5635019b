"""Nine commands, each ended by a signal at a random moment: is there half a file, a process or a temporary left, and does
the next run tidy up and give what an uninterrupted one gives?"""
import collections
import concurrent.futures
import os
import queue
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

from left_over import orphans, tree

ROOT = Path(__file__).resolve().parent.parent.parent.parent
SCENES = ROOT / 'scenes'
OLD = b'old'
FOUND_END = b'width: 1 }\n'  # of a whole model by `fit`
SIGNALS = ('INT', 'TERM', 'HUP', 'KILL')
TURN = ['animate', SCENES / 'hart/pound_sign.rifs', '-q', '--size', '96x54', '--frames', '4', '--antialias', 'off',
        '--plain-light']

# Name -> the arguments, and what is written. `models` holds what models() has made.
MODES = {
    'compile, with palettes': (['compile', 'models/tinted.inst', '-q'], 'out.pov'),
    'points, .png': (['points', SCENES / 'hart/pound_sign.rifs', '-q', '--size', '320x240', '--points', '3e6'], 'out.png'),
    'points, .ply': (['points', SCENES / 'hart/pound_sign.rifs', '-q', '--points', '3e6'], 'out.ply'),
    'collage': (['collage', 'models/target.png', SCENES / 'ifs/fern.rifs'], None),
    'fit': (['fit', 'models/target.png', '-q', '--work', '2'], 'out.rifs'),
    'compare, .exr': (['compare', 'models/a.exr', 'models/a.exr'], None),
    'render, POV-Ray': (['render', '--engine', 'povray', SCENES / 'hart/pound_sign.rifs', '-q', '--size', '160x120', '--plain-light'], 'out.png'),
    'render, native, .exr': (['render', SCENES / 'abop/fig1_24f.lsys', '-q', '--size', '320x240', '--no-progressive'],
                             'out.exr'),
    'animate, native, .gif': ([*TURN, '--engine', 'native'], 'out.gif'),
    'animate, POV-Ray, frames': ([*TURN, '--engine', 'povray'], 'out/'),
}


def models(folder, program):
    folder.mkdir()
    for number in range(12):
        shutil.copy(ROOT / 'tests/golden/textured/bands.png', folder / f'bark_{number}.png')
    (folder / 'tinted.inst').write_text(
        ''.join(f'material m{i} {{ texture: "bark_{i}.png" }}\n' for i in range(12)) +
        'object bed {\n' + ''.join(f' scatter: cone over: disc 60 count: 4000 material: m{i}\n' for i in range(12)) + '}\n')
    for name, words in {'target.png': ['points', SCENES / 'ifs/fern.rifs', '--size', '900x900', '--transparent'],
                        'a.exr': ['render', SCENES / 'hart/pound_sign.rifs', '--engine', 'native', '--size', '900x900',
                                  '--antialias', 'off', '--plain-light']}.items():
        subprocess.run([program, *words, '-q', '-o', name], cwd=folder, check=True)


class Place:
    """A folder for one trial after the other."""

    def __init__(self, folder, program):
        self.folder, self.program = folder, program
        folder.mkdir()

    def prepare(self, old):
        for name in ('here', 'tmp'):
            shutil.rmtree(self.folder / name, ignore_errors=True)
            (self.folder / name).mkdir()
        (self.folder / 'here/models').symlink_to('../../models')
        if old:
            (self.folder / 'here' / old).write_bytes(OLD)

    def start(self, mode):
        words, output = MODES[mode]
        return subprocess.Popen([self.program, *words, *(['-o', output] if output else [])], cwd=self.folder / 'here',
                                env={**os.environ, 'TMPDIR': str(self.folder / 'tmp')}, stdin=subprocess.DEVNULL,
                                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, start_new_session=True)

    def outputs(self):
        return {name: data for name, data in tree(self.folder / 'here').items() if not Path(name).name.startswith('.')}

    def temporaries(self):
        hidden = [name for name in tree(self.folder / 'here') if Path(name).name.startswith('.')]
        return hidden + os.listdir(self.folder / 'tmp')

    def reference(self, mode):
        """What an uninterrupted run gives, and the seconds that it takes; of an animation the frames too."""
        self.prepare(None)
        start = time.monotonic()
        message = self.start(mode).communicate()[1]
        seconds, good = time.monotonic() - start, self.outputs()
        if MODES[mode][1] and not good:
            sys.exit(f'{mode}: no output: {message}')
        return seconds, good


class Trial:
    def __init__(self, place, mode, number, good, moment, old):
        self.mode, self.number = mode, number
        output = MODES[mode][1]
        self.old = output if old and output and not output.endswith('/') else None
        place.prepare(self.old)
        process = place.start(mode)
        time.sleep(moment)
        self.too_late = process.poll() is not None
        if not self.too_late:
            process.send_signal(number)
        struck = time.monotonic()
        self.message = process.communicate()[1].decode(errors='replace').strip()
        self.gone_after = time.monotonic() - struck
        self.status = process.returncode
        self.orphans = orphans(process.pid)
        self.half = self.half_files(place.outputs(), good)
        self.left = place.temporaries()
        again = place.start(mode)
        again.communicate()
        self.equal = again.returncode == 0 and place.outputs() == good
        self.left_at_last = place.temporaries()

    def half_files(self, outputs, good):
        """Files under final names that are neither what was there nor what should be; of those that belong together all
        or none. Frames are done one by one, and those of a film lie beside it until it is. `fit` keeps the best so far."""
        before = {self.old: OLD} if self.old else {}
        if outputs in (before, good):
            return []
        frames = {name for name, data in outputs.items()
                  if name.startswith('out/') and data == good.get(name) or
                  name.startswith('out.frames/') and data.endswith(b'IEND\xaeB`\x82') or
                  name == 'out.rifs' and data.endswith(FOUND_END)}
        return sorted(name for name, data in outputs.items() if name not in frames and before.get(name) != data)

    def findings(self):
        expected = {0, -self.number} | ({128 + self.number} if self.number != signal.SIGKILL else set())
        if self.status not in expected:
            yield f'status {self.status}'
        if self.half:
            yield f'half files {self.half}'
        if self.orphans:
            yield f'orphans {self.orphans}'
        if self.left and self.number != signal.SIGKILL:
            yield f'left {self.left}'
        if self.left_at_last:
            yield f'not swept {self.left_at_last}'
        if not self.equal:
            yield 'the next run differs'


def table(rows):
    lines = ['| mode | trials | too late | half files | orphans | left after INT, TERM, HUP | left after KILL '
             '| left after the next run | next run equal | gone after |', '|---' * 10 + '|']
    for mode in [*dict.fromkeys(row.mode for row in rows), None]:
        mine = [row for row in rows if mode in (row.mode, None)]
        killed = [row for row in mine if row.number == signal.SIGKILL]
        counts = [len(mine), sum(row.too_late for row in mine), sum(len(row.half) for row in mine),
                  sum(len(row.orphans) for row in mine), sum(len(row.left) for row in mine if row not in killed),
                  sum(len(row.left) for row in killed), sum(len(row.left_at_last) for row in mine),
                  sum(row.equal for row in mine), f'{max(row.gone_after for row in mine):.2f} s']
        lines.append('| ' + ' | '.join(map(str, [mode or 'all', *counts])) + ' |')
    statuses = collections.defaultdict(collections.Counter)
    for row in rows:
        statuses[row.number][row.status if row.status >= 0 else 128 - row.status] += 1
    ends = '; '.join(f'{signal.Signals(number).name} ' + ', '.join(f'{times} x {status}' for status, times in sorted(ended.items()))
                     for number, ended in sorted(statuses.items()))
    return '\n'.join(lines) + f'\n\nStatuses, as a shell has them: {ends}.'


def campaign(program, scratch, trials, seed, jobs, only=None):
    """All trials, each mode and each signal equally often; prints findings as they come."""
    models(scratch / 'models', program)
    places = queue.SimpleQueue()
    for number in range(jobs):
        places.put(Place(scratch / f'kills-{number}', program))
    first = places.get()
    references = {mode: first.reference(mode) for mode in only or MODES}
    places.put(first)
    dice = random.Random(seed)
    plan = []
    for index in range(trials):
        mode = list(references)[index % len(references)]
        name = SIGNALS[index // len(references) % len(SIGNALS)]
        plan.append((index, mode, getattr(signal, f'SIG{name}'), dice.random(), dice.random() < 0.5))

    def one(index, mode, number, share, old):
        place = places.get()
        try:
            seconds, good = references[mode]
            trial = Trial(place, mode, number, good, share * seconds, old)
        finally:
            places.put(place)
        for finding in trial.findings():
            print(f'FAULT kill {index}: {mode}: {signal.Signals(number).name} after {share * seconds:.3f} s: {finding}: '
                  f'{trial.message[-200:]}', file=sys.stderr, flush=True)
        return trial

    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        rows = [done.result() for done in [pool.submit(one, *step) for step in plan]]
    return rows
