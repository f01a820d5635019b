"""Random L-systems: 1 to 12 rules, and a turtle of every state."""
import math
import re

import scene
from draw import number, numbers

NAMES = 'ABCXYZPQRSUVWLJKNM'

# What a parameter is: how it changes from step to step, and what conditions ask of it.
PARAMETERS = {'length': 5, 'counter': 2, 'age': 1.5, 'code': 0.7, 'angle': 1}
FIRST = {'length': lambda draw: number(draw.pick([1, 1, 2, draw.uniform(0.2, 5)])),
         'counter': lambda draw: str(draw.whole(1, 14)), 'age': lambda draw: '0', 'code': lambda draw: '1',
         'angle': lambda draw: number(draw.uniform(5, 120))}


class Grammar:
    """The symbols of one block and what may be written with them."""

    def __init__(self, draw, model, small):
        self.draw, self.model = draw, model
        count = draw.whole(1, 3) if small else draw.ranged({(1, 3): 4, (3, 6): 3, (6, 12): 2})
        self.parametric = draw.chance(0.45)
        # Factors of one model are few, as people write them, or all different.
        self.factors = [draw.uniform(0.4, 1) if draw.chance(0.85) else draw.uniform(1, 1.3)
                        for _ in range(draw.pick([1, 2, 3, 8]))]
        self.rules_for_f = draw.chance(0.25)
        symbols = draw.some(NAMES, count)
        if self.rules_for_f:
            symbols[0] = 'F'
        self.kinds = {symbol: [draw.weighted(PARAMETERS) for _ in range(draw.weighted({0: 1, 1: 4, 2: 3, 3: 1}))]
                      if self.parametric else [] for symbol in symbols}
        if self.rules_for_f and self.kinds['F']:
            self.kinds['F'][0] = 'length'
        self.flat = draw.chance(0.35)
        self.weights = {'segment': 8, 'symbol': draw.uniform(4, 10), 'turn': 8, 'branch': draw.pick([0, 3, 3, 6]),
                        'move': 0.5}
        for state, weight in {'width': 2, 'colour': 2, 'sphere': 0.7, 'disc': 0.4, 'polygon': 0.8, 'cylinder': 0.6,
                              'upright': 1, 'elasticity': 1, 'cut': 0.2, 'model': 1, 'about': 0.4, 'factor': 0.5,
                              'world': 0.3}.items():
            if draw.chance(0.22):
                self.weights[state] = weight
        self.growth = 0.0

    def parameters(self, symbol, own):
        """Of a symbol in a successor, from those of the predecessor."""
        draw, values = self.draw, []
        for kind in self.kinds[symbol]:
            like = [name for name, other in own.items() if other == kind]
            if not like:
                values.append(FIRST[kind](draw))
            elif kind == 'length':
                factor = draw.pick(self.factors)
                values.append(draw.pick(like) + (f'*{number(factor)}' if draw.chance(0.85) else ''))
            elif kind == 'counter':
                values.append(draw.pick(like) + '-1')
            elif kind == 'age':
                values.append(draw.pick(like) + '+1')
            elif kind == 'code':
                values.append(f'2*{draw.pick(like)}' + draw.pick(['', '+1']))
            else:
                values.append(draw.pick([f'{like[0]}*0.9', like[0], f'180-{like[0]}']))
        return f'({",".join(values)})' if values else ''

    def length(self, own):
        lengths = [name for name, kind in own.items() if kind == 'length']
        return self.draw.pick(lengths) if lengths and self.draw.chance(0.8) else None

    def item(self, own, depth, drawn_only):
        draw = self.draw
        weights = dict(self.weights)
        if drawn_only:
            weights['symbol'] = 0
        if depth > 2:
            weights['branch'] = 0
        kind = draw.weighted(weights)
        length = self.length(own)
        if kind == 'symbol':
            self.growth += 1
            symbol = draw.pick(list(self.kinds))
            return symbol + self.parameters(symbol, own)
        if kind == 'segment':
            if length:
                return f'F({length})' if 'F' not in self.kinds or len(self.kinds['F']) != 1 else f'G({length})'
            return 'F' if draw.chance(0.8) else f'F({number(draw.uniform(0.1, 2))})'
        if kind == 'move':
            return draw.pick(['f', 'g', 'G'])
        if kind == 'turn':
            sign = draw.pick('+-' if self.flat else '+-&^\\/')
            angles = [name for name, other in own.items() if other == 'angle']
            if angles and draw.chance(0.5):
                return f'{sign}({draw.pick(angles)})'
            return sign if draw.chance(0.6) else f'{sign}({number(draw.pick([30, 45, 90, 137.5, draw.uniform(-180, 180)]))})'
        if kind == 'branch':
            return '[' + self.string(own, draw.whole(1, 4), depth + 1, drawn_only) + ']'
        if kind == 'width':
            return draw.pick(['!', '!', f'!({length}*{number(draw.uniform(0.02, 0.2))})' if length else '!',
                              f'!({number(draw.log_uniform(0.01, 1))})'])
        if kind == 'colour':
            return draw.pick([';', "'", ',', f';({draw.whole(0, 9)})'])
        if kind == 'sphere':
            return '@O' if draw.chance(0.3) else f'@O({length or number(draw.uniform(0.05, 1))})'
        if kind == 'disc':
            return f'{draw.pick(["@o", "@c"])}({length or number(draw.uniform(0.05, 1))})'
        if kind == 'polygon':
            step = f'({length})' if length else ''
            corners = ''.join(f'f{step}+({number(draw.uniform(30, 120))})' for _ in range(draw.whole(2, 5)))
            return '{.' + corners + '}' if draw.chance(0.8) else '[{.' + corners + self.string(own, 2, 3, drawn_only) + '}]'
        if kind == 'cylinder':
            return '@Gs' + self.string(own, 2, 3, True) + draw.pick(['', '@Gc', '!@Gc']) + 'F@Ge'
        if kind == 'upright':
            return '$'
        if kind == 'elasticity':
            return f'T({number(draw.uniform(-0.5, 0.5))})'
        if kind == 'query':
            return draw.pick(['?P(0, 0)', '?P(0, 0, 0)', '?H(0, 0, 0)', '?U(0, 0)', '?L(0)', '?E(1)',
                              '?E(1, 0, 0, 0)'])
        if kind == 'world':
            place = numbers([draw.uniform(-3, 3) for _ in range(3)])
            return draw.pick([f'@M({place})', f'@R({place})', f'@R({place}, 0, 1, 0)',
                              f'@I({number(draw.uniform(-0.1, 0.1))})', f'@K({number(draw.uniform(-0.2, 0.2))})'])
        if kind == 'cut':
            return '%'
        if kind == 'about':
            return '|'
        if kind == 'factor':
            return draw.pick([f'@Di({number(draw.uniform(0.4, 1.2))})', f'@Dd({number(draw.uniform(0.8, 2))})',
                              f'@S({number(draw.uniform(0.4, 1.2))})', f'@W({number(draw.uniform(0.4, 1.2))})',
                              f'@A({number(draw.uniform(0.5, 1.5))})', f'@B({number(draw.uniform(-0.5, 0.5))})',
                              '@X', '@F', '@N', '@N(1)', '@E'])
        size = length or number(draw.uniform(0.05, 1))
        return f'~{draw.pick(self.model.used + ["sphere", "cube", "cone", "petal"][:3 + self.has_petal])}({size})'

    has_petal = False

    def string(self, own, items, depth=0, drawn_only=False):
        return ''.join(self.item(own, depth, drawn_only) for _ in range(items))


def write(draw, model, small):
    scene.materials(draw, model)
    grammar = Grammar(draw, model, small)
    if not small and draw.chance(0.15):
        model.say('lsys petal {', '  steps 0', '  axiom ;{.+(30)f-(60)f-(120)f}', '}')
        grammar.has_petal = True
    stochastic, conditional, contexts = draw.chance(0.25), grammar.parametric and draw.chance(0.6), draw.chance(0.15)
    timed = draw.chance(0.08)
    variables, several, blocks = draw.chance(0.1), draw.chance(0.06), draw.chance(0.08)
    name = 'system' if small else 'main_system'
    model.say(f'{"main " if grammar.has_petal else ""}lsys {name} {{')
    if draw.chance(0.85):
        model.say(f'  angle {number(draw.pick([90, 60, 45, 36, 30, 25, 22.5, 18, draw.uniform(1, 179)]))}')
    if draw.chance(0.15):
        model.say(f'  step {number(draw.log_uniform(0.01, 100))}')
    if draw.chance(0.45):
        model.say(f'  width {number(draw.log_uniform(0.005, 0.6))}')
    if 'elasticity' in grammar.weights and draw.chance(0.6):
        for _ in range(draw.pick([1, 1, 2, 3])):
            model.say(f'  tropism {numbers([draw.uniform(-1, 1) for _ in range(3)])}')
        if draw.chance(0.2):
            model.say(f'  bending {draw.pick(["after segments", "after moves", "before moves"])}')
        if draw.chance(0.2):
            model.say('  torque 0, 1, 0.2')
    queries = draw.chance(0.07)
    if queries:
        environment(draw, model)
        grammar.weights['query'] = 2
    if contexts and draw.chance(0.5):
        model.say('  ignore + - & ^ / F')
    if (stochastic or contexts) and draw.chance(0.5):
        model.say(f'  seed {draw.whole(0, 1000)}')
    if (contexts or several) and draw.chance(0.3):
        model.say(f'  precedence {draw.pick(["text", "contexts"])}')
    if variables:
        declare(draw, model)
    rules, depth_free = [], not (stochastic or contexts or timed or variables or several or blocks or queries)
    for symbol, kinds in grammar.kinds.items():
        lines = productions(draw, grammar, symbol, kinds, stochastic, conditional, contexts, timed)
        if several and draw.chance(0.5):
            lines.insert(0, several_modules(draw, grammar, symbol))
        if queries and draw.chance(0.5):
            lines.insert(0, asking(draw, grammar, symbol))
        if blocks:
            lines = [with_block(draw, line, 's' in dict(zip('stuv', kinds)), variables) if draw.chance(0.6) else line
                     for line in lines]
        if variables:
            lines = [re.sub(r'\+(?=[A-Z\[])', '+(turn[n])', line, count=1) if draw.chance(0.5) else line
                     for line in lines]
        rules += lines
    axiom = draw.pick(list(grammar.kinds))
    axioms = ''.join(first(draw, grammar, draw.pick(list(grammar.kinds)) if k else axiom) + draw.pick(['', '', '+', 'F'])
                     for k in range(draw.pick([1, 1, 1, 2, 4])))
    steps(draw, model, grammar, len(rules), small, depth_free and not conditional)
    model.say(f'  axiom {axioms}', *('  ' + rule for rule in rules))
    if draw.chance(0.2):
        extra(draw, model, grammar)
    model.say('}')
    if not small:
        if draw.chance(0.15):
            model.options.append('--exact')
        if stochastic and draw.chance(0.4):
            model.options += ['--seed', str(draw.whole(0, 99))]
    return address(draw)


def environment(draw, model):
    place, size = numbers([draw.uniform(-3, 3) for _ in range(3)]), number(draw.uniform(0.5, 5))
    for region in draw.pick([[f'sphere {place}, {size}'], ['box -2, -1, -2, 2, 6, 2'], ['plane 0, 1, 0, 4'], []]):
        model.say(f'  environment {region}')
        if draw.chance(0.3) and not region.startswith('plane'):
            model.say(f'  environment points {draw.whole(1, 300)}, {size}, {number(draw.uniform(0, 1))}')
        return
    model.say('  environment ' + draw.pick([f'crowd {size}', f'crowd {size}, 0, 1, 0', 'rivals', 'rivals 0, 0, 1',
                                            f'shade {number(draw.uniform(0, 1))}', 'shade 0.3, 0, 1, 0, 2, 1, 1, 0, 1',
                                            f'shadows {size}, 0.3, 1.5, {draw.whole(0, 5)}']))


def asking(draw, grammar, symbol):
    """A production that looks at a query beside it."""
    own = dict(zip('stuv', grammar.kinds[symbol]))
    formal = symbol + (f'({",".join(own)})' if own else '')
    query = draw.pick(['?P(x, y)', '?P(x, y, z)', '?E(x)', '?H(x, z, y)'])
    told = query.replace('x', '1').replace('y', '0').replace('z', '0')
    sides = f'{query} < {formal}' if draw.chance(0.5) else f'{formal} > {query}'
    return f'{sides} : x < {number(draw.uniform(0, 4))} -> {grammar.string(own, 2, 1)}{told}'


def first(draw, grammar, symbol):
    values = [FIRST[kind](draw) for kind in grammar.kinds[symbol]]
    return symbol + (f'({",".join(values)})' if values else '')


def productions(draw, grammar, symbol, kinds, stochastic, conditional, contexts, timed):
    own = dict(zip('stuv', kinds))
    formal = symbol + (f'({",".join(own)})' if own else '')

    def successor():
        before = grammar.growth
        text = grammar.string(own, draw.ranged({(1, 4): 3, (3, 9): 5, (8, 20): 1}))
        if grammar.growth == before and draw.chance(0.6):
            text += symbol + grammar.parameters(symbol, own)
            grammar.growth += 1
        return text or '*'

    if conditional and own and draw.chance(0.7):
        name = draw.pick(list(own))
        test = {'length': f'{name} > {number(draw.log_uniform(0.005, 0.5))}', 'counter': f'{name} > 0',
                'age': f'{name} < {draw.whole(2, 20)}', 'code': f'{name} % {draw.whole(2, 5)} == 0',
                'angle': f'{name} < 90'}[own[name]]
        lines = [f'{formal} : {test} -> {successor()}']
        if draw.chance(0.4):
            lines.append(f'{formal} : * -> {grammar.string(own, 2, 0, True)}')
        return lines
    if stochastic and draw.chance(0.7):
        parts = [draw.uniform(0.1, 1) for _ in range(draw.whole(2, 4))]
        shares = [round(part / sum(parts), 3) for part in parts]
        shares[-1] = 1 - sum(shares[:-1])
        return [f'{formal} -> {successor()} : {number(share)}' for share in shares]
    if contexts and draw.chance(0.6):
        def neighbour():
            other = draw.pick(list(grammar.kinds))
            names = [f'{letter}{k}' for k, letter in zip(range(len(grammar.kinds[other])), 'xyz')]
            return other + (f'({",".join(names)})' if names else '')
        side = neighbour()
        line = f'{side} < {formal}' if draw.chance(0.6) else f'{formal} > {side}'
        return [f'{line} -> {successor()}'] + ([f'{formal} -> {successor()}'] if draw.chance(0.7) else [])
    if timed and draw.chance(0.6):
        return [f'{formal} : step < {draw.whole(2, 12)} -> {successor()}', f'{formal} : age >= 2 -> {successor()}']
    return [f'{formal} -> {successor()}']


def several_modules(draw, grammar, symbol):
    """A production for two or three modules side by side, with or without the brackets around one of them."""
    names = iter('abcdefghijkl')

    def formal(other):
        own = [next(names) for _ in grammar.kinds[other]]
        return other + (f'({",".join(own)})' if own else '')
    others = [formal(draw.pick(list(grammar.kinds))) for _ in range(draw.whole(1, 2))]
    between = draw.pick([' ', ' ', ' [ ', ' ] '])
    head = formal(symbol) + between + ' '.join(others)
    body = first(draw, grammar, draw.pick(list(grammar.kinds))) + draw.pick(['F', '', '+F'])
    return f'{head} -> {body}{between}' if between != ' ' else f'{head} -> {body}'


def declare(draw, model):
    """Variables, and the blocks of steps that change them."""
    model.say(f'  variable n = {draw.whole(0, 2)}, m = {number(draw.uniform(0.5, 2))}',
              f'  array turn[3] = {numbers([draw.uniform(-90, 90) for _ in range(3)])}')
    if draw.chance(0.3):
        model.say(f'  start {{ m = {number(draw.uniform(0.5, 2))}; turn[n] = {number(draw.uniform(5, 60))} }}')
    model.say('  start each { n = (n + 1) % 3 }' if draw.chance(0.6) else
              '  start each {\n    if (step % 2 == 0) { n = 0 } else { n = 2 }\n  }')
    if draw.chance(0.4):
        model.say(draw.pick(['  end each { m = 0.9*m }', '  end each { m = random(0.5, 1) }',
                             '  end each { turn[2] = step }']))
    if draw.chance(0.2):
        model.say('  end { n = 1 }')


def with_block(draw, line, has_parameter, variables):
    """A production with a block, behind its condition or in place of one."""
    head, tail = line.split(' -> ', 1)
    value = 's' if has_parameter else '1'
    statements = draw.pick([f'local = 0.5*{value}', f'local = {value}; while (local > 10) {{ local = local/2 }}',
                            f'if ({value} > 0.5) {{ local = 1 }} else {{ local = 2 }}',
                            'do { local = local + random(0, 1) } while (local < 2)'])
    if variables and draw.chance(0.4):
        statements += draw.pick(['; m = 0.99*m', '; turn[n] = turn[n] + 1', f'; m = min(m, {value})'])
    return f'{head}{" " if " : " in head else " : "}{{ {statements} }} -> {tail}+(5*local)'.replace('*+(', '+(') \
        if ' : ' not in tail else line


def steps(draw, model, grammar, rules, small, repeats):
    """From one to thirty, or without end; now and then as many as lead to a number of modules."""
    if repeats and draw.chance(0.12):
        model.say('  steps infinite')
        return
    growth = max(1.05, grammar.growth / max(1, rules))
    if small:
        count = max(1, min(8, int(math.log(300) / math.log(growth))))
    elif draw.chance(0.5):
        count = draw.whole(1, 30)
    else:
        count = max(1, min(30, int(draw.uniform(1, 9) * math.log(10) / math.log(growth))))
    if not small and draw.chance(0.1):
        model.options += ['--steps', f'{count}.3' if draw.chance(0.3) else str(count)]
        return
    model.say(f'  steps {count}')


def extra(draw, model, grammar):
    """How modules are drawn: productions that only the drawing sees."""
    symbol = draw.pick(list(grammar.kinds))
    own = dict(zip('stuv', grammar.kinds[symbol]))
    formal = symbol + (f'({",".join(own)})' if own else '')
    if symbol == 'F':
        return
    text = grammar.string(own, draw.whole(1, 4), 0, True)
    if draw.chance(0.3):
        text += f'+(random(-20, 20))F({number(draw.uniform(0.1, 1))})'
    model.say(f'  interpret {formal} -> {text}')


def address(draw):
    return '.'.join(f'#{draw.weighted({1: 6, 2: 1})}' for _ in range(draw.whole(1, 4)))
