"""The tables, the plots and the raw figures of tools/bench/instances."""
import datetime
import json
import os
import re
import shutil
import subprocess

STAGES = ('compile', 'parse', 'bound', 'trace')


def number(value):
    """Three digits, no exponents where they can be done without."""
    if value is None:
        return ''
    if value == 0:
        return '0'
    if value >= 1e6:
        return re.sub(r'e\+?0*', 'e', '%.2e' % value)
    return '%.0f' % value if value >= 100 else '%.3g' % value


def size(value):
    for unit in ('B', 'kB', 'MB', 'GB'):
        if value < 1000 or unit == 'GB':
            return f'{number(value)} {unit}'
        value /= 1000


COLUMNS = ['table', 'model', 'depth', 'leaves', 'contender', 'sdl', 'compile', 'parse', 'bound', 'trace', 'cpu',
           'wall', 'peak', 'compile_peak', 'pov_cpu', 'pov_peak', 'difference', 'placements', 'triangles', 'drawn',
           'shapes', 'died', 'commit']
WORDS = ('table', 'model', 'depth', 'contender', 'died', 'commit')


def flattened(row):
    used = row['usage']
    row = dict(row, cpu=used.cpu, wall=used.wall, peak=used.peak)
    return {name: row[name] for name in COLUMNS if row.get(name) is not None}


def line(row):
    used = row['usage']
    return '%-16s %9.2e %-9s %7.2f s CPU %7.2f s %6.0f MiB  %s %s' % (
        row['model'], row['leaves'], row.get('contender', row['table']), used.cpu, used.wall, used.peak,
        row.get('died', ''), row.get('difference') or '')


def save(path, machine, rows):
    lines = ['# ' + machine, '\t'.join(COLUMNS)]
    for row in rows:
        cells = (row.get(name) for name in COLUMNS)
        lines.append('\t'.join('' if c is None else '%.4g' % c if isinstance(c, float) else str(c) for c in cells))
    path.write_text('\n'.join(lines) + '\n')


def read(path):
    """What the machine is, and the rows."""
    if not path.exists():
        return '', []
    machine, head, *lines = path.read_text().splitlines()
    rows = [dict(zip(head.split('\t'), text.split('\t'))) for text in lines]
    return machine[2:], [{name: cell if name in WORDS else int(cell) if cell.isdigit() else float(cell)
                          for name, cell in row.items() if cell} for row in rows]


def table(head, lines):
    return '\n'.join(['| ' + ' | '.join(head) + ' |', '|' + '---|' * len(head)] +
                     ['| ' + ' | '.join(line) + ' |' for line in lines]) + '\n'


def by_place(rows, model):
    return {(row['leaves'], row['contender']): row for row in rows if row['model'] == model}


def pivot(contenders, rows, model, what):
    """Leaves downwards, contenders across: the figure, and how many times graftal's cut that is."""
    found = by_place(rows, model)
    alive = {contender for (_, contender), row in found.items() if 'died' not in row}
    shown = [contender for contender in contenders if contender in alive]
    shown.sort(key=lambda c: (c != 'cut', list(contenders).index(c)))
    lines = []
    for leaves in sorted({leaves for leaves, _ in found}):
        base = found.get((leaves, 'cut'))
        base = what(base) if base and 'died' not in base else None
        line = [number(leaves)]
        for contender in shown:
            row = found.get((leaves, contender))
            if not row:
                line.append('')
            elif 'died' in row:
                line.append('†')
            else:
                times = f' ({number(what(row) / base)}x)' if base and contender != 'cut' else ''
                line.append(number(what(row)) + times)
        lines.append(line)
    return table(['parts'] + [contenders[c] for c in shown], lines)


WHY = (('memory', 'over the limit of memory'), ('time', 'over the limit of time'),
       (r'a text of (.*)', r"a text of \1, over the benchmark's limit"),
       (r'\S+ leaves need (.*), more than .*', r'graftal declines: they need \1'))


def why(died):
    for pattern, words in WHY:
        if match := re.fullmatch(pattern, died):
            return match.expand(words)
    return died


def ends(contenders, rows, model):
    lines = []
    for row in rows:
        if row['model'] == model and 'died' in row:
            lines.append(f'- {contenders[row["contender"]]}: at {number(row["leaves"])} parts: {why(row["died"])}')
    return '\n'.join(lines) + '\n' if lines else 'All went on to the last depth.\n'


def stages(contenders, rows, model):
    """Each contender where it went farthest, but not beyond the absolute specification: its stages, its picture."""
    lines = []
    deepest = {}
    common = max((leaves for (leaves, c), row in by_place(rows, model).items()
                  if c == 'absolute' and 'died' not in row), default=None)
    for (leaves, contender), row in by_place(rows, model).items():
        if 'died' not in row and leaves <= (common or leaves):
            if contender not in deepest or leaves > deepest[contender]['leaves']:
                deepest[contender] = row
    for contender in contenders:
        if row := deepest.get(contender):
            lines.append([contenders[contender], number(row['leaves']), size(row['sdl']) if 'sdl' in row else ''] + [
                number(row.get(stage)) for stage in STAGES] + [number(row['cpu']), number(row['wall']),
                number(row.get('compile_peak')), number(row.get('pov_peak')),
                '' if row.get('difference') is None else '%.1e' % row['difference'] if row['difference'] else '0'])
    return table(['', 'parts', 'SDL', 'compile', 'parse', 'bounding', 'trace', 'CPU', 'wall', 'peak, compiling',
                  'peak, drawing', 'difference'], lines)


def beyond(rows):
    def with_unit(row, name, unit):
        return f'{number(row[name])} {unit}' if name in row else ''

    return table(['model', 'parts', 'compile', 'its peak', 'placements', 'triangles', 'SDL', 'POV-Ray', 'its peak'],
                 [[f'{row["model"]} `--steps {row["depth"]}`', number(row['leaves']), with_unit(row, 'compile', 's'),
                   with_unit(row, 'compile_peak', 'MiB'), str(row.get('placements', '')),
                   str(row.get('triangles', '')), size(row['sdl']) if 'sdl' in row else '',
                   why(row['died']) if 'died' in row else with_unit(row, 'pov_cpu', 's'),
                   with_unit(row, 'pov_peak', 'MiB')] for row in rows])


def plot(path, script, contenders, rows, models, value, title, unit, low, high):
    lines = []
    for model in models:
        lines.append(('chart', model, f'{model}: {title}', 'parts', 2.5, 15.6, 3, 'log', low, high, unit))
    # In one order for all charts, so that each contender keeps its colour.
    for contender, label in contenders.items():
        for model in models:
            last = None
            for row in rows:
                if row['model'] != model or row['contender'] != contender:
                    continue
                if 'died' not in row:
                    last = (row['leaves'], '%.4g' % value(row))
                    lines.append(('point', model, label, 'solid', *last))
                elif last:
                    lines.append(('point', model, label, 'end', *last))
    lines.append(('note', 'A cross: at the next depth it is over a limit of memory, time, or its own.'))
    text = '\n'.join('\t'.join(str(cell) for cell in line) for line in lines)
    svg = subprocess.run(['awk', '-v', 'columns=3', '-f', script], input=text, capture_output=True, text=True,
                         check=True).stdout
    path.write_text(svg)


def machine(options):
    def first(pattern, command):
        if not shutil.which(command[0]):
            return '-'
        found = subprocess.run(command, capture_output=True, text=True)
        match = re.search(pattern, found.stdout + found.stderr)
        return match[1] if match else '?'

    packaged = subprocess.run(['dpkg-query', '-W', '-f', '${Version}', 'structure-synth'], capture_output=True,
                              text=True).stdout
    memory = os.sysconf('SC_PAGE_SIZE') * os.sysconf('SC_PHYS_PAGES') / 2**30
    cores = {1: 'One core', 2: 'Two cores', 4: 'Four cores'}.get(os.cpu_count(), f'{os.cpu_count()} cores')
    return (f'{cores}, {memory:.0f} GB; load {os.getloadavg()[2]:.1f} (15 minutes\' average) at the end. '
            f'{options.note} graftal {first(r"([0-9.]+)", [options.graftal, "--version"])}, POV-Ray '
            f'{first(r"POV-Ray ([0-9.]+[0-9])", ["povray", "--version"])}, Context Free '
            f'{first(r"cfdg - ([0-9.]+[0-9])", ["cfdg", "--version"])}, Structure Synth {packaged}; pictures of '
            f'{options.size[0]}x{options.size[1]}.')


def measured(rows):
    """The line that tools/bench/page asks of each part with a table."""
    commits = sorted({row['commit'] for row in rows}, key=lambda commit: commit.split()[1])
    return '\n*Commit ' + ', and '.join(', '.join(commit.split()) for commit in commits) + ': `tools/bench/instances`*\n'


def put_between(text, mark, body):
    begin, end = f'<!-- {mark} -->', f'<!-- end of {mark} -->'
    if begin not in text:
        text += f'\n{begin}\n{end}\n'
    return text[:text.index(begin) + len(begin)] + '\n' + body.strip() + '\n' + text[text.index(end):]


def total(row):
    return row['cpu']


def peak(row):
    return row['peak']


def write(folder, contenders, script):
    described, all_rows = read(folder / 'instances.tsv')
    rows, flat, roots = ([row for row in all_rows if row['table'] == name] for name in ('models', 'flat', 'roots'))
    models = list(dict.fromkeys(row['model'] for row in rows))
    plot(folder / 'instances_time.svg', script, contenders, rows, models, total, 'CPU time', 's', -2, 3)
    plot(folder / 'instances_memory.svg', script, contenders, rows, models, peak, 'peak memory', 'MiB', 1, 4)
    body = ''
    for model in models:
        body += f'\n### {model}\n\nCPU seconds:\n\n' + pivot(contenders, rows, model, total)
        body += '\nPeak memory, MiB:\n\n' + pivot(contenders, rows, model, peak)
        body += '\nWhere they stop (†):\n\n' + ends(contenders, rows, model)
        body += '\nThe stages, of each as far as it goes, but not beyond the absolute specification:\n\n'
        body += stages(contenders, rows, model)
    page = folder / 'instances.md'
    text = page.read_text() if page.exists() else '# Instances\n'
    for mark, content in (('machine', described), ('flat', beyond(flat)), ('roots', beyond(roots)), ('models', body)):
        of_part = {'flat': flat, 'roots': roots, 'models': rows}.get(mark)
        text = put_between(text, mark, content + measured(of_part) if of_part else content)
    page.write_text(text)
