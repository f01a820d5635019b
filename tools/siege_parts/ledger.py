"""What a siege has come to, and the page with the running total: docs/benchmarks/siege.md, from siege.tsv beside it."""
import collections
import csv
import datetime
import subprocess
import sys

import commits

COLUMNS = ('day', 'commit', 'target', 'executions', 'cpu_s', 'peak_mib', 'slowest_s', 'findings')
PAGE = 'docs/benchmarks/siege.md'


class Count:
    def __init__(self):
        self.executions, self.cpu, self.peak, self.slowest, self.findings = 0, 0.0, 0, 0, 0


class Book:
    def __init__(self):
        self.counts = collections.OrderedDict()
        self.findings = {}   # (target, what) -> where its input is

    def count(self, target, executions, cpu, peak_mib, slowest_s):
        count = self.counts.setdefault(target, Count())
        count.executions += executions
        count.cpu += cpu
        count.peak = max(count.peak, peak_mib)
        count.slowest = max(count.slowest, slowest_s)

    def find(self, target, what, where):
        """Each once, however often it is met."""
        if (target, what) in self.findings:
            return
        self.findings[target, what] = where
        self.counts.setdefault(target, Count()).findings += 1
        print(f'{target}: {what}: {where}', file=sys.stderr, flush=True)

    def rows(self, root):
        day, commit = datetime.date.today().isoformat(), commits.name(root)
        return [(day, commit, target, count.executions, round(count.cpu), round(count.peak), round(count.slowest, 1),
                 count.findings) for target, count in self.counts.items()]

    def table(self):
        return table([dict(zip(COLUMNS, ('', '', target, count.executions, count.cpu, count.peak, count.slowest,
                                         count.findings))) for target, count in self.counts.items()])

    def write(self, root, command):
        """Adds this run to the running total, and makes the page anew."""
        path = (root / PAGE).with_suffix('.tsv')
        rows = []
        if path.exists():
            with open(path, newline='') as file:
                rows = list(csv.DictReader(file, delimiter='\t'))
        rows += [dict(zip(COLUMNS, row)) for row in self.rows(root)]
        with open(path, 'w', newline='') as file:
            writer = csv.DictWriter(file, COLUMNS, delimiter='\t', lineterminator='\n')
            writer.writeheader()
            writer.writerows(rows)
        for part, lines in (('run', self.table()), ('total', table(rows))):
            subprocess.run([root / 'tools/bench/page', PAGE, part, command], input='\n'.join(lines), text=True, check=True)


def table(rows):
    """One line a target, and one of all."""
    sums = {}
    for row in rows:
        for name in (row['target'], 'all'):
            count = sums.setdefault(name, Count())
            count.executions += int(row['executions'])
            count.cpu += float(row['cpu_s'])
            count.peak = max(count.peak, float(row['peak_mib']))
            count.slowest = max(count.slowest, float(row['slowest_s']))
            count.findings += int(row['findings'])
    lines = ['| target | executions | CPU hours | peak MiB | slowest s | findings |', '|---|---|---|---|---|---|']
    for name in [*sorted(set(sums) - {'all'}), *(['all'] if sums else [])]:
        count = sums[name]
        lines.append(f'| {name} | {count.executions:,} | {count.cpu / 3600:.3f} | {count.peak:.0f} | {count.slowest:.3g} | '
                     f'{count.findings} |')
    return lines
