"""The counts as tables."""
import collections


class Row:
    def __init__(self, command, kind, calls, points, ends, findings):
        self.command, self.kind, self.calls, self.points = command, kind, calls, points
        self.ends, self.findings = ends, findings


def sums(rows):
    ends = sum((row.ends for row in rows), collections.Counter())
    missed = ends.pop('not reached', 0)
    runs = sum(ends.values())
    others = runs - sum(ends[status] for status in (0, 1, 3))
    return [sum(row.points for row in rows), runs, ends[0], ends[1], ends[3], others, missed, sum(row.findings for row in rows)]


HEAD = 'points tried | faults | status 0 | 1 | 3 | others | not reached | findings |'


def line(words):
    return '| ' + ' | '.join(map(str, words)) + ' |'


def by_command(rows):
    lines = ['| command | allocations tried, of | other calls tried, of | ' + HEAD, '|---' * 11 + '|']
    for command in dict.fromkeys(row.command for row in rows):
        mine = [row for row in rows if row.command == command]
        shares = [f'{sum(row.points for row in part):,} of {sum(row.calls for row in part):,}'
                  for part in ([row for row in mine if row.kind == 'alloc'], [row for row in mine if row.kind != 'alloc'])]
        lines.append(line([f'`{command}`', *shares, *sums(mine)]))
    lines.append(line(['all', '', '', *sums(rows)]))
    return '\n'.join(lines)


def by_kind(rows):
    lines = ['| calls | calls of all good runs | ' + HEAD, '|---' * 10 + '|']
    for kind in dict.fromkeys(row.kind for row in rows):
        mine = [row for row in rows if row.kind == kind]
        lines.append(line([kind, f'{sum(row.calls for row in mine):,}', *sums(mine)]))
    return '\n'.join(lines)
