"""Whole processes of graftal: models drawn by tools/bench/strangers, scenes and what the fuzzers came to, mostly changed,
with drawn options; and the same where something is wrong with the environment. Judged by what anybody sees: status,
signal, message, time, memory, files."""
import json
import os
import re
import resource
import shlex
import shutil
import signal
import time
from pathlib import Path

import hostile
from draw import Draw
from limited import Limits, observe
from model import LANGUAGES, generate

ROOT = Path(__file__).resolve().parent.parent.parent
CPU_S = 60
MEMORY_MIB = 2560   # graftal may take 2 GiB itself (--memory)


class Processes:
    def __init__(self, program, out, seed, broken):
        self.program, self.out, self.seed, self.broken = program, out, seed, broken
        self.name = 'environments' if broken else 'processes'
        self.number = 0
        self.limits = Limits(CPU_S, MEMORY_MIB)
        self.limits.wall_s = 20 * CPU_S
        self.scenes = sorted(path for path in (ROOT / 'scenes').rglob('*.*') if path.suffix[1:] in LANGUAGES)
        self.pictures = sorted((ROOT / 'tests/fuzz/corpus/picture').iterdir())

    def run(self, deadline, book, count=None):
        """Until the deadline, or so many processes."""
        done = 0
        while (count is None or done < count) and (deadline is None or time.monotonic() < deadline):
            self.one(Draw(self.seed, self.name, self.number), book)
            self.number += 1
            done += 1

    def one(self, draw, book):
        folder = self.out / 'process'
        shutil.rmtree(folder, ignore_errors=True)
        for name in ('here', 'tmp'):
            (folder / name).mkdir(parents=True)
        model = self.model(draw, folder / 'here')
        words, output = hostile.command(draw, model, [path.name for path in (folder / 'here').iterdir()])
        trouble = hostile.trouble(draw) if self.broken else hostile.Trouble()
        before = {path.name for path in (folder / 'here').iterdir()}
        environment = {**os.environ, 'TMPDIR': str(folder / 'tmp'), **trouble.environment}
        ended = observe(trouble.started([self.program, *words]), self.limits, folder / 'stdout', folder / 'stderr', folder / 'here',
                        environment)
        said = (folder / 'stderr').read_text(errors='replace')
        book.count(self.name, 1, ended.usage.cpu, ended.usage.peak, ended.usage.cpu)
        left = {path.name for path in (folder / 'here').iterdir()} - before
        temporary = [path.name for path in (folder / 'tmp').iterdir()]
        for what in faults(ended, said, words, output, left, temporary, trouble):
            self.keep(what, folder, [*trouble.words, 'graftal', *words], said, book)

    def model(self, draw, here):
        """The name of the model, which stands in the folder with what it may use."""
        kind = draw.weighted({'stranger': 3, 'scene': 3, 'fuzzed': 3})
        fuzzed = sorted((self.out / 'corpus').glob('*')) if kind == 'fuzzed' else []
        fuzzed = [folder for folder in fuzzed if folder.name in ('inst', 'rifs', 'lsys', 'lsys_lower', 'model')]
        if kind == 'stranger' or (kind == 'fuzzed' and not fuzzed):
            language = draw.pick(list(LANGUAGES))
            generate(draw.whole(0, 10**9), language, 0).write(here)
            (here / 'options.json').unlink()
            path = here / f'model.{language}'
        else:
            source = draw.pick(self.scenes) if kind == 'scene' else self.fuzzed(draw, draw.pick(fuzzed))
            path = here / ('model' + hostile.ending(source))
            path.write_bytes(source.read_bytes())
        if draw.chance(0.6):
            other = draw.pick(self.scenes).read_text()
            path.write_bytes(hostile.changed(draw, path.read_bytes().decode(errors='replace'), other).encode())
        for name in re.findall(rb'"([\w.]+)"', path.read_bytes())[:8]:
            self.bring(draw, here / name.decode())
        return path.name

    def fuzzed(self, draw, folder):
        return Path(folder / draw.pick(sorted(os.listdir(folder))))

    def bring(self, draw, path):
        """What a model names."""
        if path.exists():
            return
        if path.suffix[1:] in LANGUAGES:
            same = [scene for scene in self.scenes if scene.name == path.name]
            shutil.copy((same or [draw.pick(self.scenes)])[0], path)
        elif path.suffix and path.suffix != '.json':
            picture = draw.pick(self.pictures)
            path.write_bytes(picture.read_bytes()[1:])  # the first byte is the fuzzer's

    def keep(self, what, folder, words, said, book):
        """The folder, with the command and what it said."""
        kept = self.out / 'findings' / self.name / re.sub(r'[^A-Za-z0-9_]+', '_', what)[:60]
        if not kept.exists():
            shutil.copytree(folder / 'here', kept, ignore=lambda *_: [])
            (kept / 'command').write_text(shlex.join(words) + '\n\n' + said[:5000])
            (kept / 'command.json').write_text(json.dumps(words))
        book.find(self.name, what, str(kept))


def faults(ended, said, words, output, left, temporary, trouble):
    """What nobody may see, in a few words each."""
    command = words[0] if words else ''
    if ended.code == 127 and 'loading shared libraries' in said:
        return []  # it has not begun
    if 'will take about' in said or is_long(words):
        return []
    if ended.over or ended.usage.cpu > CPU_S:
        return [f'{command}: {ended.over or "time"}']
    if ended.usage.peak > MEMORY_MIB:
        return [f'{command}: memory']
    found = []
    if ended.signal:
        name = signal.Signals(ended.signal).name
        found.append(f'{command}: {name}')
    elif ended.code not in (0, 1, 2) and not (ended.code == 3 and (trouble.status_3 or honest(said))):
        found.append(f'{command}: status {ended.code}: {kind(said)}')
    said_of_library = 'one of its libraries crashed' in said and trouble.status_3
    if not said_of_library and re.search(r'internal error|broken invariant|terminate called|Sanitizer|runtime error:', said):
        found.append(f'{command}: {kind(said)}')
    if ended.code not in (0, None) and not said.strip() and not trouble.mute and '-q' not in words and '--quiet' not in words:
        found.append(f'{command}: no message')
    if ended.signal is None:
        extra = [name for name in left if not is_due(name, words, output, ended.code)]
        found += [f'{command}: leaves {re.sub(r"[0-9]+", "N", name)}' for name in (extra + temporary)[:1]]
    return found


def is_long(words):
    """Whether somebody asks for so many points, and to be told nothing."""
    points = [number for option, number in zip(words, words[1:]) if option == '--points' and re.fullmatch(r'[0-9.e+]+', number)]
    return 'points' in words and any(float(number) > 3e8 for number in points[-1:])


def is_due(name, words, output, code):
    """Whether the command may leave this file or folder: what it was asked for, the palettes of a scene, which are called
    after the model, a card, and what an end before the end leaves on purpose."""
    if code not in (0, 1):
        return name.endswith('.frames') if 'animate' in words else name == output and 'render' in words and '--no-progressive' not in words
    scene = r'(model\.\w+)(_[IPT]_\d+\.png|_sky\.exr)$' if 'compile' in words and output else '$^'
    stem = re.escape(output.rsplit('.', 1)[0]) + r'(_[IPT]_\d+|_sky|_\d+)?\.\w+$' if output else '$^'
    cards = [file for option, card in zip(words, words[1:]) if option == '--card'
             for file in (card, card.rsplit('.', 1)[0] + '.png')]
    return bool(re.match(stem, name) or re.match(scene, name)) or name in cards


def honest(said):
    """Refusals that are the environment's also where nothing is wrong with it."""
    return re.search(r'No such file|not a regular file|cannot (open|read|find|write)|Is a directory|Permission denied|not a picture|'
                     r'File name too long|File exists', said)


def kind(said):
    lines = [line for line in said.splitlines() if 'error' in line or 'graftal:' in line] or said.splitlines() or ['']
    return re.sub(r"'[^']*'", "'...'", re.sub(r'\d[\d.]*(e[+-]?\d+)?', 'N', lines[-1]))[:100]
