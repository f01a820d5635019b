"""Linear maps by their singular values, so that their norm, their dimension and their rank are known."""
import math


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(len(b))) for j in range(len(b[0]))] for i in range(len(a))]


def rotation_2d(angle_deg):
    c, s = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
    return [[c, -s], [s, c]]


def rotation_3d(draw):
    """About an axis by chance; often one of the coordinates', by an angle that people would write."""
    if draw.chance(0.4):
        turned = rotation_2d(angle_deg(draw))
        c, s = turned[0][0], turned[1][0]
        axis = draw.whole(0, 2)
        i, j = [k for k in range(3) if k != axis]
        m = [[float(r == k) for k in range(3)] for r in range(3)]
        m[i][i] = m[j][j] = c
        m[i][j], m[j][i] = -s, s
        return m
    w, x, y, z = (draw.normal() for _ in range(4))
    n = math.sqrt(w * w + x * x + y * y + z * z) or 1.0
    w, x, y, z = w / n, x / n, y / n, z / n
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]


def angle_deg(draw):
    """As often one that people would write as any other."""
    if draw.chance(0.5):
        return draw.uniform(-180, 180)
    return draw.sign() * draw.weighted({0: 3, 90: 2, 180: 1, 45: 1, 60: 1, 120: 1, 30: 1})


def singular_values(draw, kind, scale, dimensions):
    """The largest is `scale`."""
    if kind in ('similarity', 'reflection'):
        return [scale] * dimensions
    if kind == 'affine':
        return [scale] + [scale * draw.log_uniform(0.1, 1) for _ in range(dimensions - 1)]
    if kind == 'nearly singular':
        return [scale] * draw.whole(1, dimensions - 1) + [scale * draw.log_uniform(1e-9, 1e-2)] * dimensions
    rank = draw.whole(1, dimensions - 1)
    return [scale] * rank + [0.0] * (dimensions - rank)


KINDS = {'similarity': 8, 'reflection': 2, 'affine': 5, 'nearly singular': 1.5, 'singular': 1.5}


def linear(draw, kind, scale, dimensions):
    values = singular_values(draw, kind, scale, dimensions)[:dimensions]
    if kind == 'reflection':
        values[0] = -values[0]
    turn = (lambda: rotation_2d(angle_deg(draw))) if dimensions == 2 else (lambda: rotation_3d(draw))
    stretched = [[value * entry for entry in row] for value, row in zip(values, turn())]
    return product(turn(), stretched)


def scales(draw, count, dimension):
    """Unequal factors whose powers of this dimension sum to one, each at most 0.97."""
    if count == 1:
        return [draw.uniform(0.2, 0.97)]
    spread = draw.pick([0, 0, 0.1, 0.3, 0.6, 1, 2])
    raw = [math.exp(spread * draw.normal()) for _ in range(count)]
    low, high = 1e-9, 1.0 / min(raw)
    for _ in range(80):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if sum((middle * r) ** dimension for r in raw) < 1 else (low, middle)
    return [min(0.97, max(1e-4, low * r)) for r in raw]


def dimension(draw):
    return draw.uniform(*draw.weighted({(0.3, 6): 5, (0.9, 1.6): 1.5, (1.8, 2.3): 2, (2.7, 3.3): 1.5}))


def places(draw, scale_of, dimensions):
    """Translations: spread, on a lattice, near each other, or far apart; one for each scale."""
    how = draw.weighted({'spread': 5, 'lattice': 2, 'near': 1, 'normal': 1, 'wide': 1})
    size = draw.log_uniform(1e-3, 1e3) if draw.chance(0.1) else 1
    near = draw.log_uniform(1e-6, 0.1)
    result = []
    for scale in scale_of:
        if how == 'lattice':
            place = [draw.whole(-2, 2) * 0.5 for _ in range(dimensions)]
        elif how == 'near':
            place = [near * draw.normal() for _ in range(dimensions)]
        elif how == 'normal':
            place = [draw.normal() for _ in range(dimensions)]
        elif how == 'wide':
            place = [draw.sign() * draw.log_uniform(1e-3, 1e2) for _ in range(dimensions)]
        else:
            place = [draw.uniform(-1, 1) * (1 - 0.9 * scale) for _ in range(dimensions)]
        result.append([size * x for x in place])
    return result
