"""The page that a campaign leaves: docs/benchmarks/strangers.md."""
import collections
import datetime
import json
import os
import commits


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
    lines = ['| language | command | models | done | refused | findings | CPU s: median, 95 %, most | '
             'peak MiB: median, 95 %, most |', '|---|---|---|---|---|---|---|---|']
    for (language, command), group in sorted(cells.items(), key=lambda cell: cell[0][0]):
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


def page(rows, campaign, root, limits, most=60):
    found = [row for row in rows if row['findings']]
    refused = [row for row in rows if row['code'] == 1 and row['command'] != 'check']
    blank = [row for row in rows if row.get('blank')]
    models = len({row['model'] for row in rows})
    accepted = sum(row['command'] == 'check' and row['code'] == 0 for row in rows)
    hours = sum(row['cpu'] for row in rows) / 3600
    lines = ["# Strangers' models", '',
             '`tools/bench/strangers` draws models by chance from wide distributions, and runs every command on them under',
             'limits. It writes this page.', '',
             f'Seed {campaign["seed"]}: {models} models, of which `check` accepts {accepted}; {len(rows)} commands, '
             f'{hours:.2f} CPU hours.',
             f'Limits: {limits.cpu_s} s of CPU and {limits.report_mib} MiB a command; pictures of '
             f'{campaign["size"] or "1280x720"}.', '',
             '<!-- table -->', *table(rows), '',
             f'*Commit {commits.name(root)}, {datetime.date.today().isoformat()}, {os.cpu_count()} processors: '
             f'`tools/bench/strangers --seed {campaign["seed"]}`*', '<!-- end of table -->', '',
             f'"Refused" is status 1, with a message. {len(refused)} commands refused a model that `check` accepts; '
             f'{len(blank)} pictures of whole models show nothing.', '',
             f'## Findings: {len(found)}', '']
    if found:
        lines += [f'`tools/bench/strangers --seed {campaign["seed"]} --only MODEL --out FOLDER` makes one again. A finding is '
                  'a command over a limit, one that ends by a signal or with a status other than 0 and 1, and one that '
                  'leaves files behind.', '', *listed(sorted(found, key=lambda row: row['model']), most)]
    for title, group in (('Accepted by `check`, refused by others', refused), ('Nothing to see', blank)):
        if group:
            lines += ['', f'## {title}', '']
            kinds = collections.Counter((row['command'], row['said'].split(' error: ')[-1][:100]) for row in group)
            examples = {}
            for row in group:
                examples.setdefault((row['command'], row['said'].split(' error: ')[-1][:100]), row['model'])
            lines += ['| command | models | it says | such as |', '|---|---|---|---|']
            lines += [f'| {command} | {count} | {said} | {examples[command, said]} |'
                      for (command, said), count in kinds.most_common(25)]
    return '\n'.join(lines) + '\n'
