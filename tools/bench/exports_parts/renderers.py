"""Strict readers of the pbrt-v4 and Mitsuba 3 scenes that graftal writes.

  renderers.py FILE    prints one line of JSON: meshes, instances, and the triangles that all instances mean"""
import json
import re
import sys
import xml.etree.ElementTree as ElementTree
import zlib
from pathlib import Path

import numpy

PBRT_TOKEN = re.compile(r'\s*(?:#[^\n]*|("[^"\n]*")|([\[\]])|(-?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)(?=[\s\]])|([A-Za-z]+))')
# What follows each directive: s a string, n a number, p parameters.
PBRT_DIRECTIVES = {'Scale': 'nnn', 'LookAt': 'nnnnnnnnn', 'Camera': 'sp', 'Sampler': 'sp', 'Integrator': 'sp', 'Film': 'sp',
                   'WorldBegin': '', 'LightSource': 'sp', 'AttributeBegin': '', 'AttributeEnd': '',
                   'AreaLightSource': 'sp', 'Shape': 'sp', 'Texture': 'sssp', 'MakeNamedMaterial': 'sp',
                   'NamedMaterial': 's', 'ObjectBegin': 's', 'ObjectEnd': '', 'ObjectInstance': 's', 'ConcatTransform': 'm'}


class Fault(Exception):
    pass


def expect(holds, words):
    if not holds:
        raise Fault(words)


def pbrt_tokens(text):
    place, end = 0, len(text.rstrip())
    while place < end:
        match = PBRT_TOKEN.match(text, place)
        expect(match, f'line {text.count(chr(10), 0, place) + 1}: no token')
        place = match.end()
        for kind, token in zip(('string', 'sign', 'number', 'word'), match.groups()):
            if token is not None:
                yield kind, token


class Pbrt:
    def __init__(self, path):
        self.tokens = list(pbrt_tokens(Path(path).read_text())) + [('end', '')]
        self.next = 0
        self.materials, self.textures, self.objects = set(), set(), {}
        self.inside, self.depth, self.instances, self.triangles = None, 0, 0, 0
        while self.tokens[self.next][0] != 'end':
            self.directive()
        expect(self.inside is None and self.depth == 0, 'something is not ended')

    def take(self, kind):
        found, token = self.tokens[self.next]
        expect(found == kind, f'{kind} expected, not {token!r}')
        self.next += 1
        return token

    def values(self, kind):
        expect(self.take('sign') == '[', 'no list')
        found = []
        while self.tokens[self.next] != ('sign', ']'):
            found.append(self.take(kind))
        self.next += 1
        return found

    def parameters(self):
        found = {}
        while self.tokens[self.next][0] == 'string':
            kind, name = self.take('string')[1:-1].split()
            sizes = {'float': 1, 'integer': 1, 'string': 1, 'rgb': 3, 'point3': 3, 'point2': 2, 'normal': 3, 'texture': 1}
            expect(kind in sizes, f'no type: {kind}')
            values = self.values('string' if kind in ('string', 'texture') else 'number')
            expect(values and len(values) % sizes[kind] == 0, f'{name}: {len(values)} values')
            if kind == 'texture':
                expect(values[0][1:-1] in self.textures, f'no texture {values[0]}')
            found[name] = values
        return found

    def directive(self):
        name = self.take('word')
        expect(name in PBRT_DIRECTIVES, f'no directive: {name}')
        words, parameters = [], {}
        for what in PBRT_DIRECTIVES[name]:
            if what == 's':
                words.append(self.take('string')[1:-1])
            elif what == 'n':
                self.take('number')
            elif what == 'm':
                matrix = [float(number) for number in self.values('number')]
                expect(len(matrix) == 16 and matrix[3::4] == [0, 0, 0, 1], 'no affine matrix')
                expect(abs(numpy.linalg.det(numpy.reshape(matrix, (4, 4)))) > 0, 'a singular matrix')
            else:
                parameters = self.parameters()
        self.follow(name, words, parameters)

    def follow(self, name, words, parameters):
        if name == 'Texture':
            self.textures.add(words[0])
        elif name == 'MakeNamedMaterial':
            self.materials.add(words[0])
        elif name == 'NamedMaterial':
            expect(words[0] in self.materials, f'no material {words[0]}')
        elif name == 'ObjectBegin':
            expect(self.inside is None and words[0] not in self.objects, 'an object within another, or twice')
            self.inside = words[0]
            self.objects[self.inside] = 0
        elif name == 'ObjectEnd':
            self.inside = None
        elif name == 'ObjectInstance':
            expect(self.inside is None and words[0] in self.objects, f'no object {words[0]}')
            self.instances += 1
            self.triangles += self.objects[words[0]]
        elif name == 'AttributeBegin':
            self.depth += 1
        elif name == 'AttributeEnd':
            self.depth -= 1
        elif name == 'Shape' and words[0] == 'trianglemesh':
            corners = numpy.array([int(number) for number in parameters['indices']])
            expect(corners.min() >= 0 and 3 * corners.max() + 2 < len(parameters['P']), 'a corner that is not there')
            expect(len(parameters['P']) == len(parameters['N']), 'normals and points do not agree')
            self.objects[self.inside] += len(corners) // 3


class Mitsuba:
    TAGS = {'scene', 'integrator', 'sensor', 'film', 'sampler', 'emitter', 'bsdf', 'texture', 'shape', 'transform', 'integer',
            'float', 'string', 'rgb', 'vector', 'point', 'ref', 'lookat', 'scale', 'matrix'}

    def __init__(self, path):
        self.path = Path(path)
        root = ElementTree.parse(path).getroot()
        expect(root.tag == 'scene' and root.get('version') == '3.0.0', 'no scene')
        known, self.objects, self.instances, self.triangles = set(), {}, 0, 0
        for element in root.iter():
            expect(element.tag in self.TAGS, f'no element: {element.tag}')
            if element.get('id') and element.tag != 'ref':
                expect(element.get('id') not in known, f'{element.get("id")} is there twice')
                known.add(element.get('id'))
            if element.tag == 'ref':
                expect(element.get('id') in known, f'{element.get("id")} is not there')
            if element.tag == 'matrix':
                matrix = numpy.array([float(word) for word in element.get('value').split()]).reshape(4, 4)
                expect(matrix[3].tolist() == [0, 0, 0, 1] and abs(numpy.linalg.det(matrix)) > 0, 'no affine matrix')
        meshes = self.serialized()
        used = set()
        for group in root.findall('shape[@type="shapegroup"]'):
            numbers = [int(shape.find('integer').get('value')) for shape in group.findall('shape')]
            used.update(numbers)
            self.objects[group.get('id')] = sum(meshes[number] for number in numbers)
        expect(used == set(range(len(meshes))), 'a mesh that nobody uses')
        for instance in root.findall('shape[@type="instance"]'):
            self.instances += 1
            self.triangles += self.objects[instance.find('ref').get('id')]

    def serialized(self):
        """The triangles of each mesh."""
        data = self.path.with_suffix('.serialized').read_bytes()
        count = int.from_bytes(data[-4:], 'little')
        begins = numpy.frombuffer(data, '<u8', count, len(data) - 4 - 8 * count).tolist() + [len(data) - 4 - 8 * count]
        found = []
        for begin, end in zip(begins, begins[1:]):
            expect(data[begin:begin + 4] == b'\x1c\x04\x04\x00', 'no head of a mesh')
            mesh = zlib.decompress(data[begin + 4:end])
            flags = int.from_bytes(mesh[:4], 'little')
            place = mesh.index(b'\0', 4) + 1
            vertices, triangles = numpy.frombuffer(mesh, '<u8', 2, place).tolist()
            floats = vertices * (6 + (2 if flags & 2 else 0))
            expect(flags & 0x1001 == 0x1001, 'no normals in single precision')
            corners = numpy.frombuffer(mesh, '<u4', 3 * triangles, place + 16 + 4 * floats)
            expect(len(mesh) == place + 16 + 4 * floats + corners.nbytes, 'another length')
            expect(corners.max() < vertices, 'a corner that is not there')
            expect(numpy.isfinite(numpy.frombuffer(mesh, '<f4', floats, place + 16)).all(), 'no number')
            found.append(triangles)
        return found


def read(path):
    scene = (Pbrt if str(path).endswith('.pbrt') else Mitsuba)(path)
    return {'meshes': len(scene.objects), 'instances': scene.instances, 'triangles': scene.triangles}


if __name__ == '__main__':
    try:
        print(json.dumps(read(sys.argv[1])))
    except Fault as fault:
        sys.exit(f'{sys.argv[1]}: {fault}')
