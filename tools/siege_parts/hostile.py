"""Commands, options, changes to texts and troubles of the environment that nobody in his senses would have."""
import re

NUMBERS = ['0', '1', '-1', '2', '0.5', '1e-3', '1e-100', '1e100', '1e101', '1e308', '5e-324', '1e400', 'nan', 'inf', '', 'x', '7.3',
           '4294967296', '18446744073709551615', '-0', '1/3', '2^330', '1e-17', '3,4', '1..2', '0x10', '1e6', '٣']
SMALL = ['64x36', '1x1', '160x90', '3x200', '200x3']
OPTIONS = {
    'render': ['--size', '--error', '--error-world', '--work', '--zoom', '--at', '--camera', '--antialias', '--test-linear',
               '--progressive', '--no-progressive', '--flatten', '--visible-only', '--keep', '--aovs', '--tile'],
    'compile': ['--size', '--error', '--error-world', '--work', '--zoom', '--at', '--camera', '--flatten', '--visible-only', '--name'],
    'points': ['--size', '--points', '--color', '--exposure', '--camera', '--zoom', '--at', '--transparent', '--card'],
    'export': ['--limit', '--unit', '--levels', '--nodes', '--part', '--instancing', '--plotter', '--size', '--error', '--error-world',
               '--zoom', '--at', '--camera'],
    'animate': ['--frames', '--fps', '--turn', '--ease', '--camera', '--zoom', '--keep-frames'],
    'stats': ['--json', '--work'], 'check': ['--work'], 'print': ['--after', '--work'], 'graph': ['--after', '--work'], 'collage': ['--threshold', '--light', '--json'],
    'compare': ['--threshold', '-q'], 'fit': ['--maps', '--similar', '--objective', '--threshold', '--light', '--start', '--json', '--blocks', '--tolerance'],
}
COMMON = ['--steps', '--set', '--seed', '--exact', '--memory', '--threads', '--dump-after', '--time', '-q', '--root']
FLAGS = {'--test-linear', '--progressive', '--no-progressive', '--aovs', '--flatten', '--visible-only', '--transparent', '--json', '--light', '--exact', '--time', '-q',
         '--keep-frames', '--similar', '--blocks', '--instancing', '--plotter'}
VALUES = {
    '--size': [*SMALL, *SMALL, '32768x1', '0x0', '64', '99999x99999'],
    '--tile': ['0,0,8x8', '60,30,9x9', '0,0,1x1', '-1,0,1x1', '0,0,0x0', '1,2', '2147483647,0,1x1', ',,x'],
    '--at': ['a', 'a.b.(c)*40', '(a)*', 'top#2', '(', 'w1.(w2.w1)*', '#1', '.', 'o0#1.(o1#1)*1000000000'],
    '--camera': ['location=0,0,5 look_at=0,0,0', 'width=1e-99 orthographic', 'angle=179.9', 'location=1e100,0,0', 'up=0,0,0', 'angle=0',
                 'location=0,0,0 look_at=0,0,0', 'orthographic', 'look_at=nan,0,0'],
    '--memory': ['1', '1M', '64M', '2G', '0', '1e30G', '-1M'],
    '--objective': ['near', 'occupancy', 'far', ''],
    '--zoom': ['1', '10', '1e10', '1e100', '2^330', '1e-5', '1e1000', '10^1000000', '0', '-3'],
    '--part': ['a', 'leaf', 'a,b', 'o0', '', '.', 'x' * 300],
    '--steps': ['0', '1', '5', '50', '1000', '4000000000', '7.5', '-1', '1e9'],
    '--set': ['a=1', 'steps=3', 'angle=1e99', 'x', '=', 'a=', 'step=0', 'width=-1', 'seed=5', 'a=1e309', 'n=1e-320'],
    '--after': ['drop_unreachable', 'merge_equivalent', 'none'], '--dump-after': ['all', 'drop_unreachable', 'x'],
    '--color': ['tint', 'map', 'density', 'x'], '--points': ['1', '1000', '1e5', '1e16', '0', '1.5'],
    '--ease': ['smooth', 'linear', 'x'], '--frames': ['1', '2', '0', '1e9'], '--threads': ['1', '2', '512', '0'],
    '--antialias': ['off', '1', '9', '10'], '--name': ['Far', 'far', 'A' * 25, 'A;B'], '--keep': ['kept', 'model.inst'],
    '--card': ['card.inst', 'card.rifs', '/x/card.inst'], '--root': ['.', '/', 'nowhere', '/tmp'],
    '--limit': ['1', '1K', '1M', '64M', '0'], '--unit': ['1mm', '1e-100m', '1e97m', '0mm', '3', 'in'], '--levels': ['1', '2', '4', '1000'],
    '--nodes': ['1', '3', '1000', '0'],
    '--work': ['0.01', '1', '1e9', '0', '1e-300'], '--error': ['0', '0.5', '2', '1000', '1e308', '-1'],
}
OUTPUTS = {'render': ['.png', '.exr'], 'compile': ['.pov', '.inc'], 'points': ['.png', '.exr', '.ply'],
           'export': ['.usda', '.gltf', '.glb', '.obj', '.ply', '.stl', '.svg', '.pbrt', '.xml', '.fbx'], 'animate': ['.gif', '.png'],
           'graph': ['.dot']}


def command(draw, model, others):
    """The words of a command line, and the name of the file that it writes, or ''."""
    name = draw.weighted({'check': 3, 'compile': 4, 'render': 4, 'stats': 2, 'print': 1, 'points': 2, 'graph': 1, 'collage': 1,
                          'compare': 1, 'animate': 0.3, 'export': 2, 'fit': 0.5})
    words = [name]
    if name == 'compare':
        words += [draw.pick(others), draw.pick(others)]
    elif name == 'collage':
        words += [draw.pick(others), model]
    elif name == 'fit':
        words += [draw.pick(others), '-o', draw.pick(['out.rifs', 'out.pifs']), '--work', '0.2']
    else:
        words.append(model)
    for _ in range(draw.pick([0, 1, 1, 2, 3, 5])):
        option = draw.pick(OPTIONS[name] * 2 + COMMON)
        words.append(option)
        if option not in FLAGS:
            values = VALUES.get(option, NUMBERS)
            words.append(draw.pick(values if draw.chance(0.9) else NUMBERS))
    if name in ('render', 'animate'):
        words += ['--engine', 'native']
    if name in ('render', 'animate', 'points', 'compile', 'export') and '--size' not in words and draw.chance(0.9):
        words += ['--size', draw.pick(SMALL)]
    if name == 'animate' and '--frames' not in words:
        words += ['--frames', '2']
    output = ''
    if name in OUTPUTS and (name in ('render', 'animate', 'export') or draw.chance(0.8)):
        output = 'out' + draw.pick(OUTPUTS[name])
        words += ['-o', output]
    elif name == 'points':
        output = model.rsplit('.', 1)[0] + '.png'
    if '--keep' in words:
        words = [word for word in words if word not in ('--keep', 'kept', 'model.inst') or word == model]
    if '--card' in words:
        words += ['--color', 'tint']
    if draw.chance(0.02):
        words.insert(draw.whole(0, len(words)), draw.pick(['--help', '--version', '--', '-', '\x1b[31m', 'ü', '--x', '=']))
    return words, output


def ending(path):
    """.inst, .rifs or .lsys: of a fuzzer's input, what its folder or its first line says."""
    for language in ('inst', 'rifs', 'lsys'):
        if path.suffix == '.' + language or path.parent.name.startswith(language):
            return '.' + language
    first = path.read_bytes()[:40].split(b'\n')[0]
    return '.rifs' if b'rifs' in first else '.lsys' if b'lsys' in first else '.inst'


def changed(draw, text, other):
    """Lines taken out, doubled, exchanged and taken from another model; numbers and words changed."""
    for _ in range(draw.pick([1, 1, 2, 4, 9])):
        lines = text.split('\n')
        at = draw.whole(0, len(lines) - 1)
        how = draw.pick(['out', 'double', 'move', 'take', 'number', 'number', 'number', 'word', 'bytes', 'many'])
        if how == 'out':
            del lines[at]
        elif how == 'double':
            lines.insert(at, lines[at])
        elif how == 'move':
            lines.insert(draw.whole(0, len(lines) - 1), lines.pop(at))
        elif how == 'take':
            lines.insert(at, draw.pick(other.split('\n')))
        elif how == 'many':
            lines[at:at] = [lines[at]] * draw.log_whole(2, 2000)
        text = '\n'.join(lines)
        if how in ('number', 'word'):
            found = list(re.finditer(r'[0-9][0-9.]*(e[+-]?\d+)?' if how == 'number' else r'[A-Za-z_]\w*', text))
            if found:
                one, two = draw.pick(found), draw.pick(found)
                by = draw.pick(NUMBERS) if how == 'number' and draw.chance(0.7) else two[0]
                text = text[:one.start()] + by + text[one.end():]
        elif how == 'bytes' and text:
            place = draw.whole(0, len(text) - 1)
            text = text[:place] + draw.pick(list('(){}[]<>,:;"#/*-+=.&|!%@~\0\n\xff')) + text[place + draw.whole(0, 1):]
    return text


class Trouble:
    """What is wrong with the environment of a process: words of the shell before it, and variables."""

    def __init__(self, words=(), environment=None, mute=False, status_3=False, after=''):
        self.words, self.environment, self.mute, self.status_3 = list(words), environment or {}, mute, status_3
        self.after = after

    def started(self, command):
        if not self.words and not self.after:
            return command
        return ['sh', '-c', ' '.join(self.words) + ' exec "$@" ' + self.after, 'sh', *command]


def trouble(draw):
    return draw.pick([
        lambda: Trouble(['exec 0<&-;']), lambda: Trouble(['exec 1>&-;'], status_3=True),
        lambda: Trouble(['exec 2>&-;'], mute=True, status_3=True), lambda: Trouble(after='>/dev/full', status_3=True),
        lambda: Trouble(after='2>/dev/full', mute=True, status_3=True),
        lambda: Trouble(environment={'TMPDIR': '/nowhere'}, status_3=True),
        lambda: Trouble(environment={'TMPDIR': '', 'HOME': '', 'PATH': ''}, status_3=True),
        lambda: Trouble(environment={'LC_ALL': 'tr_TR.UTF-8', 'LANG': 'C'}),
        lambda: Trouble([f'ulimit -f {draw.pick([0, 1, 8])};'], status_3=True, mute=True),
        lambda: Trouble([f'ulimit -v {draw.log_whole(20_000, 3_000_000)};'], status_3=True),
        lambda: Trouble([f'ulimit -d {draw.log_whole(2_000, 1_000_000)};'], status_3=True),
        lambda: Trouble([f'ulimit -s {draw.pick([256, 512, 1024])};'], status_3=True),
        lambda: Trouble([f'ulimit -n {draw.pick([3, 4, 5, 8, 12])};'], status_3=True, mute=True),
    ])()
