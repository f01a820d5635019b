"""OBJ, PLY and STL files as triangles, by readers of their own."""
import re
from pathlib import Path

import numpy


def triangles_of(path):
    """An array of triangles by corners by coordinates."""
    return {'.obj': of_obj, '.ply': of_ply, '.stl': of_stl}[Path(path).suffix](path)


def of_obj(path):
    points, faces = [], []
    with open(path) as lines:
        for line in lines:
            if line.startswith('v '):
                points.append([float(word) for word in line.split()[1:4]])
            elif line.startswith('f '):
                faces.append([int(word.split('/')[0]) - 1 for word in line.split()[1:]])
    return numpy.array(points)[numpy.array(faces)]


def of_ply(path):
    data = Path(path).read_bytes()
    end = data.index(b'end_header\n') + len(b'end_header\n')
    head = data[:end].decode()
    counts = {name: int(number) for name, number in re.findall(r'element (\w+) (\d+)', head)}
    of_vertex = head[head.index('element vertex'):head.index('element face')]
    kinds = [(name, {'float': '<f4', 'uchar': 'u1'}[kind])
             for kind, name in re.findall(r'property (float|uchar) (\w+)', of_vertex)]
    vertices = numpy.frombuffer(data, kinds, counts['vertex'], end)
    faces = numpy.frombuffer(data, [('count', 'u1'), ('corners', '<u4', 3)], counts['face'], end + vertices.nbytes)
    assert len(data) == end + vertices.nbytes + faces.nbytes, 'bytes behind the end'
    assert (faces['count'] == 3).all()
    points = numpy.stack([vertices['x'], vertices['y'], vertices['z']], 1).astype(float)
    return points[faces['corners']]


def of_stl(path):
    data = Path(path).read_bytes()
    count = int.from_bytes(data[80:84], 'little')
    assert len(data) == 84 + 50 * count, 'not as long as its head says'
    rows = numpy.frombuffer(data, [('normal', '<f4', 3), ('corners', '<f4', (3, 3)), ('more', '<u2')], count, 84)
    return rows['corners'].astype(float)


def area(triangles):
    across = numpy.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    return float(numpy.linalg.norm(across, axis=1).sum() / 2)


def volume(triangles):
    return float(numpy.einsum('ij,ij->i', triangles[:, 0], numpy.cross(triangles[:, 1], triangles[:, 2])).sum() / 6)


def open_edges(triangles):
    """The edges that have not as many triangles on the one side as on the other, by the bits of their ends."""
    flat = numpy.ascontiguousarray(triangles.reshape(-1, 3) + 0.0)
    _, number = numpy.unique(flat, axis=0, return_inverse=True)
    corners = number.reshape(-1, 3)
    edges = numpy.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    sense = numpy.where(edges[:, 0] < edges[:, 1], 1, -1)
    _, which = numpy.unique(numpy.sort(edges, axis=1), axis=0, return_inverse=True)
    return int(numpy.count_nonzero(numpy.bincount(which.reshape(-1), weights=sense)))
