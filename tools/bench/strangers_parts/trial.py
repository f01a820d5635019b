"""Runs the commands of graftal on one model, and judges how each ended."""
import json
import os
import re
import shutil
from pathlib import Path

import picture
from limited import observe

# Name of a trial -> the command, and the file that it writes.
COMMANDS = {
    'check': (['check'], None),
    'stats': (['stats', '--json'], None),
    'compile small': (['compile', '--size', '64x36'], 'small.pov'),
    'compile': (['compile'], 'scene.pov'),
    'native': (['render', '--engine', 'native'], 'native.png'),
    'povray': (['render', '--engine', 'povray'], 'povray.png'),
}

START_S = 2   # that a command may take besides its --work
REFERENCE = Path(__file__).resolve().parents[3] / 'scenes/showpieces/toy_wood.inst'
REFERENCE_WORK_S = 3


def command_line(program, name, model, size=None):
    words, result = COMMANDS[name]
    line = [program, *words, model['model'], *model['options'], '--work', str(model['work'])]
    if result:
        line += [*model['drawn'], '-o', f'out/{result}']
        if name != 'native' and model['visible_only']:
            line.append('--visible-only')
        if size and '--size' not in words:
            line += ['--size', size]
    return line


def attempt(program, name, folder, limits, size=None):
    """One row of the results; what the command leaves in the folder is looked at and taken away."""
    model = json.loads((folder / 'options.json').read_text())
    out, temporary = folder / 'out', folder / 'tmp'
    for fresh in (out, temporary):
        shutil.rmtree(fresh, ignore_errors=True)
        fresh.mkdir()
    line = command_line(program, name, model, size)
    ended = observe(line, limits, folder / 'stdout', folder / 'stderr', folder, {**os.environ, 'TMPDIR': str(temporary)})
    said = (folder / 'stderr').read_text(errors='replace').splitlines()
    wrong = [text for text in said if 'error' in text]
    row = {'command': name, 'code': ended.code, 'signal': ended.signal, 'cpu': round(ended.usage.cpu, 2),
           'peak': round(ended.usage.peak), 'said': (wrong or said or [''])[0][:200] if ended.code != 0 else '',
           'line': ' '.join(['graftal', *line[1:]])}
    # Seconds that graftal foretells count in place of its --work.
    foretold = re.search(r'(?:will take|, in) about (\d+) seconds', ' '.join(said))
    work_s = max(model['work'], int(foretold[1]) if foretold else 0)
    row['findings'] = judged(row, ended, limits, work_s)
    if row['findings'] in (['time'], ['work']) and row['cpu'] <= limits.report_s:
        # A machine with other loads makes seconds longer: those of a reference picture say by how much.
        slowness = reference_slowness(program, folder, limits)
        quiet = {**row, 'cpu': row['cpu'] / slowness}
        row['findings'] = judged(quiet, ended, limits, work_s)
        row['slowness'] = round(slowness, 2)
    if row['findings'] == ['time'] and work_s > limits.report_s / 2:
        row['findings'], row['foretold'] = [], work_s
    row['findings'] += leftovers(name, row, out, temporary)
    if name in ('native', 'povray') and ended.code == 0 and not model['drawn']:
        if not picture.shows_something(out / COMMANDS[name][1]):
            row['blank'] = True
    for used in ('out', 'tmp', 'stdout', 'stderr'):
        path = folder / used
        shutil.rmtree(path) if path.is_dir() else path.unlink()
    return row


def reference_slowness(program, folder, limits):
    """Seconds of a processor that a second of work takes at this moment, by a scene that keeps to its work; at least 1."""
    line = [program, 'render', str(REFERENCE), '--engine', 'native', '--work', str(REFERENCE_WORK_S), '-o', 'reference.png']
    ended = observe(line, limits, folder / 'stdout', folder / 'stderr', folder)
    (folder / 'reference.png').unlink(missing_ok=True)
    return max(1.0, ended.usage.cpu / REFERENCE_WORK_S) if ended.code == 0 else 1.0


def judged(row, ended, limits, work_s):
    if ended.over == 'time (it hangs)':
        return ['hangs']
    if ended.over == 'time' or row['cpu'] > limits.report_s:
        return ['time']
    found = ['work'] if row['cpu'] > limits.ratio * work_s + START_S else []
    found += ['memory'] if ended.over == 'memory' or row['peak'] > limits.report_mib else []
    if row['signal'] and not ended.over:
        found.append(f'signal {row["signal"]}')
    elif row['code'] not in (0, 1, None):
        found.append(f'status {row["code"]}')
    return found


def leftovers(name, row, out, temporary):
    """Files that should not be there; palettes stand beside a scene that was written. What is killed may leave some."""
    if row['code'] is None:
        return []
    expected = COMMANDS[name][1] if row['code'] == 0 else None
    found = {path.name for path in out.iterdir()}
    if expected and expected not in found:
        return ['no result']
    palettes = {file for file in found if expected and re.search(r'_[IPT]_\d+\.png$|_sky\.exr$', file)}
    extra = found - {expected} - palettes | {path.name for path in temporary.iterdir()}
    return ['leaves ' + ' '.join(sorted(extra)[:3])] if extra else []


def run_all(program, folder, limits, povray, keep, size=None):
    """Calls `keep` with each row; commands that draw are tried where `check` accepts the model."""
    for name in COMMANDS:
        if name == 'povray' and not povray:
            continue
        row = attempt(program, name, folder, limits, size)
        # Other loads of the machine make a run take longer, and none makes it take less.
        for _ in range(2):
            if not {'time', 'work'} & set(row['findings']):
                break
            row = min(row, attempt(program, name, folder, limits, size), key=lambda tried: tried['cpu'])
        keep(row)
        if name == 'check' and row['code'] != 0:
            return
