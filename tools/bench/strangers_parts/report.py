"""The page that a campaign leaves: docs/benchmarks/strangers.md."""
import collections
import datetime
import json
import os
import re

import commits

KINDS = ('inst', 'lsys', 'rifs', 'mesh', 'foreign', 'words')


def quantile(sorted_values, share):
    return sorted_values[min(len(sorted_values) - 1, int(share * len(sorted_values)))]


def three(values, form):
    values = sorted(values)
    return ', '.join(form % value for value in (quantile(values, 0.5), quantile(values, 0.95), values[-1]))


def load(folder):
    with open(folder / 'results.jsonl') as file:
        return [json.loads(line) for line in file]


def table(rows):
    cells = collections.OrderedDict()
    for row in rows:
        cells.setdefault((row['model'].split('-')[0], row['command']), []).append(row)
    lines = ['| kind | command | models | done | refused | findings | CPU s: median, 95 %, most | '
             'peak MiB: median, 95 %, most |', '|---|---|---|---|---|---|---|---|']
    for (language, command), group in sorted(cells.items(), key=lambda cell: KINDS.index(cell[0][0])):
        lines.append(f'| {language} | {command} | {len(group)} | {sum(row["code"] == 0 for row in group)} | '
                     f'{sum(row["code"] == 1 for row in group)} | {sum(bool(row["findings"]) for row in group)} | '
                     f'{three([row["cpu"] for row in group], "%.2f")} | {three([row["peak"] for row in group], "%d")} |')
    return lines


def listed(rows, most):
    lines = ['| model | finding | CPU s | peak MiB | command | it says |', '|---|---|---|---|---|---|']
    for row in rows[:most]:
        said = row['said'].replace('|', '\\|')[:120]
        lines.append(f'| {row["model"]} | {", ".join(row["findings"])} | {row["cpu"]} | {row["peak"]} | '
                     f'`{row["line"]}` | {said} |')
    if len(rows) > most:
        lines.append(f'\n... and {len(rows) - most} more.')
    return lines


def kind(row):
    """What a refusal says, of whichever part."""
    said = row['said'].split(' error: ')[-1]
    return re.sub(r"'[^']*'", "'...'", re.sub(r'\b\d[\d.]*(e[+-]?\d+)?\b', 'N', said))[:100]


def grouped(rows):
    """One line for all models that are told the same."""
    models = {}
    for row in rows:
        models.setdefault(kind(row), {})[row['model']] = row['line']
    lines = ['| models | it says | such as |', '|---|---|---|']
    for said, lines_of in sorted(models.items(), key=lambda item: -len(item[1])):
        first = next(iter(lines_of))
        lines.append(f'| {len(lines_of)} | {said} | {first}: `{lines_of[first]}` |')
    return lines


def page(rows, campaign, root, limits, most=60):
    found = sorted((row for row in rows if row['findings']), key=lambda row: row['model'])
    refused = [row for row in rows if row['code'] == 1 and row['command'] != 'check']
    foretold = [row for row in rows if row.get('foretold')]
    slowed = [row for row in rows if row.get('slowness') and not row['findings']]
    blank = [row for row in rows if row.get('blank')]
    models = len({row['model'] for row in rows})
    accepted = sum(row['command'] == 'check' and row['code'] == 0 for row in rows)
    hours = sum(row['cpu'] for row in rows) / 3600
    command = f'tools/bench/strangers --seed {campaign["seed"]} --models {models // len(KINDS)}'
    lines = ["# Strangers' models", '',
             '`tools/bench/strangers` draws models by chance from wide distributions, and runs every command on them under',
             'limits. It writes this page.', '',
             '<!-- campaign -->',
             f'Seed {campaign["seed"]}: {models} models, of which `check` accepts {accepted}; {len(rows)} commands, '
             f'{hours:.2f} CPU hours.',
             f'Limits: {limits.report_s} s of CPU and {limits.report_mib} MiB a command; pictures of '
             f'{campaign["size"] or "1280x720"}. Each model has a `--work` of 1 to 30 seconds.', '',
             '`mesh` are meshes in files, `foreign` files of other programs, and `words` L-systems with long words.', '',
             *table(rows), '',
             '"Refused" is status 1, with a message.', '',
             f'## Findings: {len(found)}', '',
             'A command over a limit, one that takes over 1.5 times its work and 2 s besides, one that ends by a signal or with a',
             'status other than 0 and 1, and one that leaves files behind.']
    if found:
        lines += [f'`tools/bench/strangers --seed {campaign["seed"]} --only MODEL --out FOLDER` makes one again.', '',
                  *listed(found, most)]
    if slowed:
        said = ', '.join(f'{row["model"]} ({row["cpu"]:.1f} s, {row["slowness"]})' for row in slowed)
        lines += ['', 'Over by the clock alone, while a reference picture took so many times its work, too: ' + said + '.']
    if foretold:
        said = ', '.join(f'{row["model"]} ({row["foretold"]} s)' for row in foretold)
        lines += ['', f'{len(foretold)} renders were stopped that graftal had said beforehand would take longer: {said}.']
    if refused:
        lines += ['', '## Accepted by `check`, refused by others', '', *grouped(refused)]
    if blank:
        lines += ['', '## Nothing to see', '', 'No pixel of the whole model differs from its neighbours: points, fine dust, or a fault.',
                  '', *grouped(blank)]
    return '\n'.join(lines + ['', measured(root, command), '<!-- end of campaign -->']) + '\n'


def measured(root, command):
    """The line that tools/bench/page asks of each part with a table."""
    return f'*Commit {commits.name(root)}, {datetime.date.today().isoformat()}, {os.cpu_count()} processors: `{command}`*'
