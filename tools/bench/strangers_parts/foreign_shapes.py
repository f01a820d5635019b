"""Random grammars of shapes: Context Free, of both its versions, and EisenScript."""
from draw import number


def changes(draw, depth, most, words):
    """Adjustments of a shape; `most` is the largest size of one that calls a rule again."""
    parts = [f's {number(draw.pick([most, most, draw.uniform(0.3, 1) * most]))}'] if draw.chance(0.8) else []
    for _ in range(draw.whole(0, 3)):
        parts.append(draw.pick(words)(draw))
    return ' '.join(draw.shuffled(parts))


CFDG_WORDS = [lambda draw: f'x {number(draw.uniform(-2, 2))}', lambda draw: f'y {number(draw.uniform(-2, 2))}',
              lambda draw: f'r {number(draw.pick([90, 60, 1, draw.uniform(-180, 180)]))}', lambda draw: f'flip {draw.whole(0, 180)}',
              lambda draw: f'hue {draw.whole(-360, 360)}', lambda draw: f'sat {number(draw.uniform(-1, 1))}',
              lambda draw: f'b {number(draw.uniform(-1, 1))}', lambda draw: f'a {number(draw.uniform(-1, 0))}',
              lambda draw: f's {number(draw.uniform(0.2, 1.2))} {number(draw.uniform(0.2, 1.2))}',
              lambda draw: f'skew {draw.whole(-40, 40)} 0', lambda draw: f'z {number(draw.uniform(-1, 1))}']
CFDG_SHAPES = ['SQUARE', 'CIRCLE', 'TRIANGLE']


def cfdg(draw):
    return cfdg_2(draw) if draw.chance(0.35) else cfdg_3(draw)


def cfdg_2(draw):
    """Rules with weights, as the first version has them."""
    names = [f'S{i}' for i in range(draw.log_whole(1, 12))]
    most = draw.pick([0.5, 0.9, 0.99, 0.991, 0.999])
    lines = [f'startshape {names[0]}']
    if draw.chance(0.3):
        lines.append('background { hue 83 sat 0.46 b -0.12 }')
    if draw.chance(0.1):
        lines.append(f'tile {{ s {draw.whole(1, 200)} }}')
    for name in names:
        for _ in range(draw.pick([1, 1, 2, 5])):
            weight = f' {number(draw.pick([1, 10, 0.01, draw.uniform(0, 2)]))}' if draw.chance(0.6) else ''
            body = []
            for _ in range(draw.whole(0, 4)):
                shape = draw.pick(names) if draw.chance(0.5) else draw.pick(CFDG_SHAPES)
                loop = f'{draw.log_whole(1, 60)}* {{ {changes(draw, 0, 1, CFDG_WORDS[:3])} }} ' if draw.chance(0.15) else ''
                size = most if draw.chance(0.9) else 1
                body.append(f'  {loop}{shape} {{ {changes(draw, 0, size, CFDG_WORDS[:10])} }}')
            lines += [f'rule {name}{weight} {{', *body, '}']
    return '\n'.join(lines) + '\n'


def cfdg_3(draw):
    names = [f'part{i}' for i in range(draw.log_whole(1, 12))]
    counts = {name: draw.chance(0.35) for name in names}   # those that count down
    most, size = draw.pick([0.5, 0.9, 0.99, 0.995, 1]), draw.uniform(0.1, 0.99)
    chain = draw.log_whole(2, 2000)
    lines = [f'startshape {names[0]}' + (f'({draw.log_whole(1, 300)})' if counts[names[0]] else '') + ' [x 0]',
             'CF::Background = [b -0.2]' if draw.chance(0.5) else '',
             'CF::Symmetry = CF::Dihedral, 5' if draw.chance(0.05) else '', f'size = {number(size)}', 'f(number n) = n * 2 + 1']
    if draw.chance(0.3):
        lines += ['path blob {', '  MOVETO(0, 0)', f'  loop {draw.whole(1, 30)} [r 12] LINETO(1, f(0.1))' if draw.chance(0.3) else
                  '  LINETO(1, 0)\n  CURVETO(0, 1, 1, 1)', '  CLOSEPOLY()', draw.pick(['  FILL[]', '  STROKE(0.1)[]']), '}']
    blob = ['blob'] * any('path blob' in line for line in lines)

    def call(own):
        name = draw.pick(names) if draw.chance(0.5) else draw.pick(CFDG_SHAPES + blob)
        argument = ''
        if counts.get(name):
            argument = '(n - 1)' if own else f'({draw.whole(0, 30)})'
        scale = most if name in counts else 1
        text = changes(draw, 0, scale, CFDG_WORDS) + (draw.pick([' r (rand(-9, 9))', ' s (size)', f' x (f({draw.whole(0, 4)}))']) * draw.chance(0.2))
        return f'{name}{argument} [{text}]'

    def statement(own, depth):
        kind = draw.weighted({'call': 6, 'loop': 1.5, 'if': 1 if own else 0.3, 'switch': 0.3, 'block': 0.4, 'let': 0.3})
        inner = ' '.join(statement(own, depth + 1) for _ in range(draw.whole(1, 2))) if depth < 3 else call(own)
        if kind == 'loop':
            count = draw.pick([str(draw.log_whole(1, 100)), 'n' if own else '7', f'i{depth} = {draw.whole(1, 9)}', f'{draw.log_whole(1, 3000)}'])
            return f'loop {count} [{changes(draw, 0, 1, CFDG_WORDS[:3])}] {{ {inner} }}'
        if kind == 'if':
            return f'if ({"mod(n, 3) == 0" if own else draw.pick(["rand() < 0.5", "size > 0.5"])}) {{ {inner} }}' + \
                (f' else {{ {call(own)} }}' if draw.chance(0.5) else '')
        if kind == 'switch':
            return f'switch ({"n" if own else "randint(3)"}) {{ case 0: {{ {inner} }} case 1, 2: {{ {call(own)} }} else: {{ }} }}'
        if kind == 'block':
            return f'transform [{changes(draw, 0, 1, CFDG_WORDS[:3])}] {{ {inner} }}'
        if kind == 'let':
            return f'w{depth} = f(size) {call(own)}'
        return call(own)

    for name in names:
        alternatives = draw.pick([1, 1, 1, 2, 4])
        parameter = '(number n)' if counts[name] else ''
        bodies = ['\n'.join('  ' + statement(counts[name], 0) for _ in range(draw.whole(1, 4))) for _ in range(alternatives)]
        if counts[name]:
            bodies = [f'  if (n > 0) {{\n{body}\n  }}' for body in bodies]
        if alternatives == 1:
            lines.append(f'shape {name}{parameter} {{\n{bodies[0]}\n}}')
        else:
            lines.append(f'shape {name}{parameter}')
            lines += [f'rule {number(draw.log_uniform(0.01, 10)) if draw.chance(0.7) else ""} {{\n{body}\n}}' for body in bodies]
    if draw.chance(0.1):  # a long chain of shapes, each with the next
        lines += [f'shape link{i} {{ SQUARE [] link{i + 1} [x 1 s 0.99] }}' for i in range(chain)]
        lines += [f'shape link{chain} {{ CIRCLE [] }}', f'shape all {{ link0 [] {names[0]}{"(1)" if counts[names[0]] else ""} [] }}']
        lines[0] = 'startshape all'
    return '\n'.join(lines) + '\n'


EISEN_WORDS = [lambda draw: f'{draw.pick("xyz")} {number(draw.uniform(-2, 2))}',
               lambda draw: f'r{draw.pick("xyz")} {number(draw.pick([90, 6, draw.uniform(-180, 180)]))}',
               lambda draw: f'hue {draw.whole(-90, 90)}', lambda draw: f'sat {number(draw.uniform(0.5, 1))}',
               lambda draw: f'b {number(draw.uniform(0.5, 1))}', lambda draw: f'a {number(draw.uniform(0.5, 1))}',
               lambda draw: f's {number(draw.uniform(0.1, 1))} {number(draw.uniform(0.1, 1))} 1', lambda draw: 'fx',
               lambda draw: 'color #ff8000', lambda draw: 'blend red 0.1']


def eisenscript(draw):
    names = [f'r{i}' for i in range(draw.log_whole(1, 10))]
    most = draw.pick([0.5, 0.9, 0.99, 1, 1])
    lines = [f'set maxdepth {draw.log_whole(1, 1000)}', f'set maxobjects {draw.log_whole(10, 10**6)}']
    lines += [line for line in ('set seed 7', 'set background #333', 'set minsize 0.01', 'set colorpool randomhue', 'set recursion depth',
                                f'#define many {draw.whole(1, 40)}') if draw.chance(0.25)]
    many = 'many' if '#define many' in lines[-1] else '12'

    def call(top):
        name = draw.pick(names) if draw.chance(0.5) or top else draw.pick(['box', 'sphere', 'grid', 'line', 'dot', 'cylinder', 'box::shiny'])
        text = ''
        for _ in range(draw.pick([0, 1, 1, 1, 2, 3])):
            count = f'{draw.pick([many, str(draw.log_whole(1, 100))])} * ' if draw.chance(0.4) else ''
            text += f'{count}{{ {changes(draw, 0, most, EISEN_WORDS)} }} '
        return f'  {text}{name}'

    lines += [call(True)[2:] for _ in range(draw.pick([1, 1, 2]))]
    for name in names:
        for _ in range(draw.pick([1, 1, 2, 4])):
            limits = (f' md {draw.log_whole(1, 300)}' + (f' > {draw.pick(names)}' if draw.chance(0.4) else '')) if draw.chance(0.5) else ''
            limits += f' w {number(draw.log_uniform(0.1, 20))}' if draw.chance(0.4) else ''
            lines += [f'rule {name}{limits} {{', *(call(False) for _ in range(draw.whole(1, 4))), *(['  box'] if draw.chance(0.7) else []), '}']
    return '\n'.join(lines) + ('\n/* the end */\n' if draw.chance(0.3) else '\n')
