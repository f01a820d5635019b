"""Random L-systems whose words grow long: 10^5 to 10^7 modules, deep brackets, large polygons, chance and contexts."""
import math

import scene
from draw import number


def write(draw, model, small):
    scene.materials(draw, model)
    wanted = draw.log_uniform(1e5, 1e7)
    model.say('lsys long {', f'  angle {number(draw.pick([90, 60, 25, draw.uniform(1, 179)]))}')
    if draw.chance(0.3):
        model.say(f'  width {number(draw.log_uniform(0.005, 0.6))}')
    if draw.chance(0.3):
        model.say(f'  seed {draw.whole(0, 1000)}')
    axiom, steps, rules = draw.pick([doubling, by_chance, contexts, ages, nested, polygons, written_out, asking])(draw, wanted)
    model.say(f'  steps {max(1, steps)}', f'  axiom {axiom}', *('  ' + rule for rule in rules), '}')
    if draw.chance(0.5):
        model.options.append('--exact')
    return '.'.join('#1' for _ in range(draw.whole(1, 4)))


def steps_for(wanted, growth):
    return int(math.log(wanted) / math.log(growth))


def drawn(draw, items):
    """Segments, turns and other words of the turtle, which no production replaces."""
    choices = ['F', 'F', 'f', '+', '-', '&', '^', '/', '[+F]', '[-(30)F@O(0.1)]', '!(0.05)', ';', '@o(0.2)', '|',
               '~sphere(0.1)', '@Gs F@Gc F@Ge', '{.f+f+f}']
    return ' '.join(draw.pick(choices) for _ in range(items))


def successor(draw, symbol, copies):
    return ' '.join(drawn(draw, draw.whole(0, 3)) + f' {symbol} ' + (f'[+{symbol}] ' if draw.chance(0.2) else '')
                    for _ in range(copies))


def doubling(draw, wanted):
    copies = draw.whole(2, 9)
    rules = ['F -> ' + ' '.join(draw.pick(['F', 'F+', 'F-', '[+F]', 'f F']) for _ in range(copies))]
    return draw.pick(['F', 'F+F+F+F', '{F}', '[F][+F]']), steps_for(wanted, copies), rules


def by_chance(draw, wanted):
    copies = [draw.whole(1, 4) for _ in range(draw.whole(2, 4))]
    share = 1 / len(copies)
    rules = [f'A -> {successor(draw, "A", count)} : {number(share, 12)}' for count in copies]
    rules[-1] = rules[-1].rsplit(':', 1)[0] + f': {1 - (len(copies) - 1) * float(number(share, 12)):.14f}'
    return 'A', steps_for(wanted, max(1.3, sum(copies) * share)), rules


def contexts(draw, wanted):
    """A row of cells that grows, and signals that run along it."""
    last = steps_for(wanted, 2)
    rules = [f'A : step < {last} -> {draw.pick(["A A", "A F A", "[+A] A A"])}', f'B < A -> {draw.pick(["B", "B F"])}',
             f'B -> {draw.pick(["A", "A+", "C"])}']
    if draw.chance(0.5):
        rules.append(f'A < C > A -> {draw.pick(["B", "[-F]B", "A"])}')
    if draw.chance(0.4):
        rules.insert(0, f'B < A > A A : {number(draw.uniform(0.1, 1))} > 0.5 -> B F')
    return 'B A', last + draw.log_whole(1, 60), rules


def ages(draw, wanted):
    """Parameters that no other module has."""
    first, second = draw.uniform(0.3, 1), draw.uniform(0.3, 1)
    rules = [f'A(s, n) : n > 0 -> F(s) A(s*{number(first)}, n-1) [+(60*s) A(s*{number(second)}, n-{draw.whole(1, 3)})]']
    if draw.chance(0.3):
        rules.append(f'A(s, n) : n <= 0 -> F(s + random(0, {number(draw.random())}))')
    steps = steps_for(wanted, 1.6)
    return f'A({draw.whole(1, 5)}, {steps})', steps + 1, rules


def nested(draw, wanted):
    """Brackets as deep as the steps."""
    steps = draw.log_whole(100, 10_000)
    inner = draw.pick(['[+F A]', '[A]F', 'F[+A][-F]', '[[A]]', '[F[-(1)F A]]'])
    return 'A', steps, [f'A -> {inner}', *([f'F -> {draw.pick(["F", "f F"])}'] if draw.chance(0.1) else [])]


def polygons(draw, wanted):
    count = min(wanted, draw.log_uniform(100, 1e6))
    inner = draw.pick(['A -> A f+(0.01) A', 'A -> A f+(0.01)&(0.02) A', 'A -> f [+(90)f A] f A', 'A -> {.f+f A}A'])
    return draw.pick(['{.A}', '{.A}{.A}', '[{.A}]+{.f A}', 'A']), steps_for(count, 2), [inner]


def written_out(draw, wanted):
    """An axiom, or a successor, of a text as long."""
    text = drawn(draw, int(min(wanted, draw.log_uniform(1e4, 2e5)) / 2))
    if draw.chance(0.5):
        return text, 1, ['F -> F+F'] if draw.chance(0.5) else []
    return 'A', draw.whole(1, 3), [f'A -> {text} A']


def asking(draw, wanted):
    """Modules that ask where they are, and variables that every module changes."""
    if draw.chance(0.5):
        rules = ['A -> F [+A] ?P(0, 0, 0) A', f'A > ?P(x, y, z) : x > {number(draw.uniform(0, 50))} -> F']
    else:
        rules = ['A : { local = random(0, 1); while (local < 3) { local = local + 0.5 } } -> F +(local) A [-A]']
    return 'A', steps_for(wanted, 2), rules
