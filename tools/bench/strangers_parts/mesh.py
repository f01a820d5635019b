"""Random meshes in files, used by a model of objects or given alone: coincident triangles, fans, rows, sheets of large
triangles over each other, spikes, tilings without gaps, faces without an area or a number, indices that lead nowhere."""
import math
import struct

import scene
from draw import number


def write(draw, model, small):
    vertices, faces = draw.weighted(SHAPES)(draw, draw.log_whole(1, 100_000) if draw.chance(0.97) else 1_000_000)
    if draw.chance(0.15):
        spoil(draw, vertices, faces)
    kind = draw.weighted({'obj': 5, 'ply': 4, 'stl': 1})
    content = {'obj': obj, 'ply': ply, 'stl': stl}[kind](draw, vertices, faces)
    if draw.chance(0.05):
        content = content[:int(draw.random() * len(content))]
    if draw.chance(0.1):
        model.main, model.content = f'model.{kind}', content
        return None
    model.files[f'shape.{kind}'] = content
    paints = scene.materials(draw, model)
    paint = f'  material: {draw.pick(paints)}' if paints else ''
    model.say('canonical object shape {', f'  mesh "shape.{kind}"{paint}', '}', 'object top {')
    for _ in range(draw.pick([1, 1, 2, 5])):
        if draw.chance(0.2):
            model.say(f'  repeat {draw.log_whole(2, 40)} {{ rotate: y, {number(draw.uniform(1, 180))}  '
                      f'scale: {number(draw.uniform(0.7, 1))} }}')
        model.say('  union: shape', *('    ' + line for line in scene.transforms(draw)))
    if draw.chance(0.2):
        model.say('  union: top', f'    scale: {number(draw.uniform(0.3, 0.8))}', '    translate: 1, 1, 0.5')
    model.say('}')
    return 'shape#1'


def point(draw, size=1.0):
    return tuple(size * draw.uniform(-1, 1) for _ in range(3))


def loose(triangles):
    """Triangles that share no corner."""
    return [corner for triangle in triangles for corner in triangle], [[3 * i, 3 * i + 1, 3 * i + 2] for i in range(len(triangles))]


def coincident(draw, count):
    corners, apart = [point(draw) for _ in range(3)], draw.pick([0, 0, 1e-15, 1e-9])
    return loose([[tuple(x + apart * draw.uniform(-1, 1) for x in corner) for corner in draw.shuffled(corners)]
                  for _ in range(count)])


def fan(draw, count):
    rise, whole = draw.pick([0, 0, 1, draw.uniform(-3, 3)]), draw.pick([1, 1, 0.5, 1e-3])
    rough = draw.pick([0, 0, 0.1, 1])
    rim = [(math.cos(a), rise + rough * draw.normal(), math.sin(a))
           for a in (2 * math.pi * whole * i / count for i in range(count + 1))]
    return [(0, 0, 0), *rim], [[0, i + 1, i + 2] for i in range(count)]


def row(draw, count):
    wide, gap = draw.log_uniform(1e-6, 10), draw.pick([0, 0, 0.5])
    return loose([[(i + gap, 0, 0), (i + 1, 0, 0), (i + 0.5, wide, 0)] for i in range(count)])


def sheets(draw, count):
    """Large ones over each other, in one plane or in as many as there are triangles."""
    turn, thick = draw.chance(0.5), draw.pick([0, 0, 1e-9, 0.01, 1])
    triangles = [[(x, y, thick * z if z0 is None else z0) for x, y, z in (point(draw) for _ in range(3))]
                 for z0 in (thick * draw.random() if draw.chance(0.7) else None for _ in range(count))]
    if turn:
        triangles = [[(0.6 * x - 0.8 * z, y, 0.8 * x + 0.6 * z) for x, y, z in triangle] for triangle in triangles]
    return loose(triangles)


def spikes(draw, count):
    thin, from_one = draw.log_uniform(1e-9, 0.1), draw.chance(0.4)
    near = lambda at: tuple(x + thin * draw.uniform(-1, 1) for x in at)
    return loose([[a, near(a), point(draw)] for a in ((0, 0, 0) if from_one else point(draw) for _ in range(count))])


def cloud(draw, count):
    size = draw.log_uniform(1e-6, 1)
    return loose([[tuple(x + size * y for x, y in zip(at, point(draw))) for _ in range(3)]
                  for at in (point(draw) for _ in range(count))])


def tiling(draw, count):
    """A net without gaps, flat, wavy or closed around a ball."""
    side = max(1, int(math.sqrt(count / 2)))
    shift, form = draw.pick([0, 0.2, 0.45]), draw.pick(['flat', 'wavy', 'ball'])
    wave = draw.log_uniform(0.01, 3)

    def place(i, j):
        inside = 0 < i < side and 0 < j < side
        u, v = ((k + (shift * draw.uniform(-1, 1) if inside else 0)) / side for k in (i, j))
        if form == 'ball':
            return math.sin(math.pi * v) * math.cos(2 * math.pi * u), math.cos(math.pi * v), math.sin(math.pi * v) * math.sin(2 * math.pi * u)
        return u, wave * math.sin(9 * u) * math.cos(7 * v) if form == 'wavy' else 0, v

    vertices = [place(i, j) for i in range(side + 1) for j in range(side + 1)]
    faces = []
    for i in range(side):
        for j in range(side):
            a, b, c, d = i * (side + 1) + j, (i + 1) * (side + 1) + j, (i + 1) * (side + 1) + j + 1, i * (side + 1) + j + 1
            faces += [[a, b, c, d]] if draw.chance(0.3) else [[a, b, c], [a, c, d]]
    return vertices, faces


def ring(draw, count):
    """One face of as many corners."""
    corners = [(math.cos(6.283185 * i / count), math.sin(6.283185 * i / count), 0.1 * draw.normal() * draw.chance(0.1))
               for i in range(max(3, count))]
    return corners, [list(range(len(corners)))]


SHAPES = {coincident: 1, fan: 2, row: 1, sheets: 2, spikes: 2, cloud: 1.5, tiling: 2, ring: 0.5}


def spoil(draw, vertices, faces):
    """Some corners that are no numbers or far away, some faces without an area, some indices that lead nowhere."""
    how = draw.pick(['numbers', 'far', 'areas', 'indices', 'few corners'])
    for _ in range(draw.log_whole(1, max(1, len(faces) // 2))):
        face, vertex = draw.whole(0, len(faces) - 1), draw.whole(0, len(vertices) - 1)
        if how == 'numbers':
            vertices[vertex] = (math.nan, draw.pick([math.inf, -math.inf, 0]), 1)
        elif how == 'far':
            vertices[vertex] = (draw.pick([1e6, 9e5, 1e7, 1e30, 1e300, 1e-300]), 0, 0)
        elif how == 'areas':
            faces[face] = [faces[face][0]] * 3
        elif how == 'indices':
            faces[face][0] = draw.pick([len(vertices), -1, 10**9, 10**19])
        else:
            faces[face] = faces[face][:draw.whole(0, 2)]


def obj(draw, vertices, faces):
    normals, relative = draw.chance(0.3), draw.chance(0.1)
    lines = [draw.pick(['# a mesh', 'mtllib none.mtl', 'o thing', 'g one two'])]
    lines += ['v %.9g %.9g %.9g' % vertex for vertex in vertices]
    if normals:
        lines += ['vn %.6g %.6g %.6g' % vertex for vertex in vertices]
    base = -len(vertices) if relative else 1
    form = '{0}//{0}' if normals else '{0}'
    lines += ['f ' + ' '.join(form.format(i + base) for i in face) for face in faces]
    return draw.pick(['\n', '\n', '\r\n']).join(lines) + '\n'


def ply(draw, vertices, faces):
    form = draw.pick(['ascii', 'binary_little_endian', 'binary_big_endian'])
    count = draw.pick([len(faces)] * 20 + [len(faces) + 1, 10**9, 10**19])
    real, index, how_many = draw.pick(['float', 'double']), draw.pick(['int', 'uint']), draw.pick(['uchar', 'uchar', 'int'])
    if max(map(len, faces)) > 255:
        how_many = 'int'
    header = '\n'.join(['ply', f'format {form} 1.0', f'element vertex {len(vertices)}',
                        *(f'property {real} {axis}' for axis in 'xyz'), f'element face {count}',
                        f'property list {how_many} {index} vertex_indices', 'end_header']) + '\n'
    if form == 'ascii':
        lines = ['%.9g %.9g %.9g' % vertex for vertex in vertices]
        lines += [' '.join(map(str, [len(face), *face])) for face in faces]
        return header + '\n'.join(lines) + '\n'
    order, code = '<' if 'little' in form else '>', {'float': 'f', 'double': 'd'}[real]
    most = 2**31 - 1
    clamped = [vertex if code == 'd' or all(abs(x) < 1e38 or x != x or math.isinf(x) for x in vertex) else (1e30, 0, 0)
               for vertex in vertices]
    body = b''.join(struct.pack(f'{order}3{code}', *vertex) for vertex in clamped)
    number_code = {'uchar': 'B', 'int': 'i'}[how_many]
    body += b''.join(struct.pack(f'{order}{number_code}{len(face)}{"i" if index == "int" else "I"}', len(face),
                                 *(min(most, i if index == 'int' else abs(i)) for i in face)) for face in faces)
    return header.encode() + body


def stl(draw, vertices, faces):
    at = [vertex if all(abs(x) < 1e38 or x != x for x in vertex) else (1e30, 0, 0) for vertex in vertices]
    triangles = [[at[i % len(at)] for i in face[:3]] for face in faces if len(face) >= 3]
    if draw.chance(0.4):
        return 'solid one\n' + ''.join(
            'facet normal 0 0 0\nouter loop\n' + ''.join('vertex %.7g %.7g %.7g\n' % corner for corner in triangle) +
            'endloop\nendfacet\n' for triangle in triangles) + 'endsolid one\n'
    return bytes(80) + struct.pack('<I', len(triangles)) + b''.join(
        struct.pack('<12fH', 0, 0, 0, *triangle[0], *triangle[1], *triangle[2], 0) for triangle in triangles)
