"""Random iterated function systems with a control digraph."""
import math

import geometry
import scene
from draw import number, numbers

STYLES = {'codes 2d': 4, 'codes polar': 2, 'codes 3d': 4, 'flat maps': 2, 'maps': 4, 'matrices': 2}


def write(draw, model, small):
    """Returns an address that leads into the model, or None."""
    paints = scene.materials(draw, model)
    several = not small and draw.chance(0.1)
    if several:
        block(draw, model, 'other', paints, small=True, beside='main_set')
    names, edges, starts = block(draw, model, 'main_set', paints, small, 'other' if several else None)
    if draw.chance(0.15):
        model.options += ['--steps', str(draw.log_whole(1, 60))]
    return address(draw, names, edges, starts)


def address(draw, names, edges, starts):
    """A walk against the edges from the root; for ever, if it meets itself again."""
    walk, length = [], draw.whole(1, 12)
    ahead = starts
    while ahead and len(walk) < length:
        at = draw.pick(ahead)
        if at in walk and draw.chance(0.6):
            first = walk.index(at)
            return '.'.join(['#' + str(k) if k is None else names[k] for k in walk[:first]] +
                            ['(' + '.'.join(names[k] for k in walk[first:]) + ')*'])
        walk.append(at)
        ahead = [i for i in range(len(names)) if (i, at) in edges]
    return '.'.join(names[k] for k in walk) or None


def block(draw, model, name, paints, small, beside):
    count = draw.whole(1, 4) if small else draw.ranged({(1, 1): 0.3, (2, 5): 5, (4, 12): 3, (10, 24): 2})
    style = draw.weighted(STYLES)
    flat = style in ('codes 2d', 'codes polar', 'flat maps')
    dimensions = 2 if flat else 3
    wanted = min(geometry.dimension(draw), 2.2) if small else geometry.dimension(draw)
    factors = geometry.scales(draw, count, wanted)
    if draw.chance(0.02):
        factors[0] = draw.uniform(0.97, 1.2)
    where = geometry.places(draw, factors, dimensions)
    usual = draw.weighted(geometry.KINDS)
    kinds = [draw.weighted(geometry.KINDS) if draw.chance(0.15) else usual for _ in range(count)]
    tinted, painted = draw.chance(0.4), draw.chance(0.4)
    chances = draw.chance(0.15)

    names = [f'w{i + 1}' for i in range(count)] if style.startswith('codes') else [f'm{i + 1}' for i in range(count)]
    lines = []
    for i in range(count):
        look = ''
        if tinted and draw.chance(0.8):
            look += ' ' + scene.tint(draw)
        if painted and paints and draw.chance(0.6):
            look += ' material ' + draw.pick(paints)
        if style == 'codes polar':
            turn, ratio = geometry.angle_deg(draw), 1.0
            if kinds[i] != 'similarity':
                ratio = {'reflection': -1.0, 'singular': 0.0, 'affine': draw.log_uniform(0.1, 1),
                         'nearly singular': draw.log_uniform(1e-9, 1e-2)}[kinds[i]]
            lean = draw.uniform(-40, 40) if kinds[i] == 'affine' and draw.chance(0.5) else 0
            row = [factors[i], factors[i] * ratio, turn, turn + lean] + where[i]
        else:
            m = geometry.linear(draw, kinds[i], factors[i], dimensions)
            row = [x for r in m for x in r] + where[i]
        if style.startswith('codes'):
            probability = [factors[i] ** wanted] if chances else []
            lines.append('  ' + numbers(row, '  ', digits(kinds[i])) + '  ' + numbers(probability) + look)
            continue
        source = f' from {beside}' if beside and (i == 0 or draw.chance(0.3)) else ''
        if style == 'matrices' or kinds[i] in ('singular', 'nearly singular'):
            m = full(m)
            t = (where[i] + [0.0])[:3]
            word = 'projection' if kinds[i] == 'singular' else 'matrix'
            body = f'{word} ' + numbers([x for r, y in zip(m, t) for x in r + [y]], digits=digits(kinds[i]))
        else:
            body = named(draw, kinds[i], factors[i], where[i], flat)
        lines.append(f'map {names[i]}{source} {{ {body}{look} }}')
    model.say(f'rifs {name} {{')
    if style.startswith('codes'):
        model.say(f'  {style} {{', *('  ' + line for line in lines), '  }')
    else:
        model.say(*('  ' + line for line in lines))
    edges = digraph(draw, model, names)
    starts = list(range(count))
    if draw.chance(0.1):
        starts = sorted(draw.some(starts, draw.whole(1, count)))
        model.say('  start ' + ', '.join(names[i] for i in starts))
    condense_and_terminal(draw, model, flat, paints)
    model.say('}')
    return names, edges, starts


def digits(kind):
    """Rounded, a map that flattens would be a thick one."""
    return 17 if 'singular' in kind else 5


def full(m):
    """A flat map in space: z is scaled as the plane is on average, as the rows of codes have it."""
    if len(m) == 3:
        return m
    z = math.sqrt(abs(m[0][0] * m[1][1] - m[0][1] * m[1][0]))
    return [m[0] + [0.0], m[1] + [0.0], [0.0, 0.0, z]]


def named(draw, kind, factor, place, flat):
    """Transforms in words."""
    if kind == 'affine':
        several = [factor] + [factor * draw.log_uniform(0.1, 1) for _ in range(1 if flat else 2)]
    elif kind == 'reflection':
        several = [-factor, factor] + ([] if flat else [factor])
    else:
        several = [factor]
    words = ['scale ' + (number(factor) if len(several) == 1 else f'<{numbers(several)}>')]
    for _ in range(1 if flat else draw.whole(0, 3)):
        if draw.chance(0.6):
            words.append(f'rotate {"z" if flat else draw.pick("xyz")} {number(geometry.angle_deg(draw))}')
    if kind == 'affine' and draw.chance(0.3):
        words.append(f'shear {"xy" if flat else draw.pick(["xy", "yz", "zx"])} {number(draw.uniform(-0.4, 0.4))}')
    words.append(f'translate <{numbers(place)}>')
    return '  '.join(words)


def digraph(draw, model, names):
    """Says which map may follow which, and returns the pairs."""
    count = len(names)
    everything = {(i, j) for i in range(count) for j in range(count)}
    how = draw.weighted({'left out': 5, 'all': 1, 'except self': 2, 'except some': 1, 'lists': 2, 'matrix': 1.5})
    if how == 'left out' or count == 1:
        return everything
    if how == 'all':
        model.say('  follow all')
        return everything
    if how == 'except self':
        model.say('  follow all except self')
        return {(i, j) for i, j in everything if i != j}
    if how == 'except some':
        gone = {(draw.whole(0, count - 1), draw.whole(0, count - 1)) for _ in range(draw.whole(1, count))}
        model.say('  follow all except { ' + ' '.join(f'{names[i]} -> {names[j]}' for i, j in sorted(gone)) + ' }')
        return everything - gone
    density = draw.uniform(0.1, 0.9)
    edges = {pair for pair in sorted(everything) if draw.chance(density)} | {(i, (i + 1) % count) for i in range(count)}
    if how == 'lists':
        for i in range(count):
            ahead = [names[j] for j in range(count) if (i, j) in edges]
            model.say(f'  follow {names[i]} -> {", ".join(ahead)}')
    else:
        model.say('  follow matrix {', *('    ' + ' '.join(str(int((i, j) in edges)) for j in range(count))
                                         for i in range(count)), '  }')
    return edges


def condense_and_terminal(draw, model, flat, paints):
    def master():
        if model.used and draw.chance(0.7):
            return draw.pick(model.used)
        return scene.primitive(draw)

    def look():
        return (' ' + scene.tint(draw) if draw.chance(0.2) else '') + \
            (' material ' + draw.pick(paints) if paints and draw.chance(0.3) else '')

    def placed():
        lines = scene.transforms(draw)
        if flat and draw.chance(0.5):
            lines.append(f'scale <1, 1, {number(draw.log_uniform(0.001, 1))}>')
        return ' '.join(lines)

    while draw.chance(0.3):
        model.say(f'  condense {master()} {placed()}{look()}')
    if draw.chance(0.35):
        below = f' below {draw.whole(1, 40)}' if draw.chance(0.3) else ''
        model.say(f'  terminal {master()} {placed()}{look()}{below}')
