"""A strict reader of the USD text that graftal writes. It refuses whatever the grammar or graftal does not have.

  usd.py FILE    prints one line of JSON: the meshes that the file means, instances within instances counted, and more"""
import json
import re
import sys
from pathlib import Path

TOKEN = re.compile(r'''\s*(?:\#(?P<comment>[^\n]*)|(?P<string>"(?:[^"\\\n]|\\.)*")|(?P<path><[^<>\n]*>)|
                       (?P<numbers>\[[-+.,()eE\d\s]+\])|(?P<asset>@[^@\n]*@)|
                       (?P<number>-?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)(?![\w.])|(?P<word>[A-Za-z_][\w:.]*(?:\[\])?)|
                       (?P<sign>[()\[\]{}=,]))''', re.X)
SPECIFIERS = {'def', 'class', 'over'}
TYPES = {'matrix4d', 'token', 'token[]', 'float', 'float2', 'float3', 'float3[]', 'color3f', 'color3f[]', 'int[]', 'bool',
         'point3f[]', 'normal3f[]', 'texCoord2f[]', 'quath[]', 'quatf[]', 'string', 'asset', 'rel'}


class Fault(Exception):
    pass


def tokens_of(text):
    place, found = 0, []
    while place < len(text.rstrip()):
        match = TOKEN.match(text, place)
        if not match:
            raise Fault(f'line {text.count(chr(10), 0, place) + 1}: no token: {text[place:place + 40]!r}')
        place = match.end()
        if match.lastgroup != 'comment':
            found.append((match.lastgroup, match[match.lastgroup], match.start()))
    return found


class Prim:
    def __init__(self, path, specifier, kind, metadata):
        self.path, self.specifier, self.kind, self.metadata = path, specifier, kind, metadata
        self.values, self.children = {}, []


class Reader:
    def __init__(self, text):
        if not text.startswith('#usda 1.0\n'):
            raise Fault('the first line is not #usda 1.0')
        self.text, self.tokens, self.next = text, tokens_of(text), 0
        self.prims = {}
        self.layer = self.metadata()
        self.roots = []
        while self.next < len(self.tokens):
            self.roots.append(self.prim(''))
        if self.layer.get('defaultPrim') not in [prim.path[1:] for prim in self.roots]:
            raise Fault('no prim is the defaultPrim')

    def fault(self, words):
        place = self.tokens[min(self.next, len(self.tokens) - 1)][2]
        raise Fault(f'line {self.text.count(chr(10), 0, place) + 2}: {words}')

    def peek(self):
        return self.tokens[self.next][1] if self.next < len(self.tokens) else None

    def take(self, what=None, group=None):
        if self.next >= len(self.tokens):
            self.fault('ends too early')
        kind, text, _ = self.tokens[self.next]
        if (what is not None and text != what) or (group and kind != group):
            self.fault(f'{what or group} expected, not {text!r}')
        self.next += 1
        return text

    def value(self):
        kind, text, _ = self.tokens[self.next]
        if kind == 'numbers':
            self.next += 1
            try:
                return json.loads(text.replace('(', '[').replace(')', ']'))
            except ValueError:
                self.next -= 1
                self.fault('no list of numbers')
        if text in ('(', '['):
            end = {'(': ')', '[': ']'}[text]
            self.next += 1
            values = []
            while self.peek() != end:
                values.append(self.value())
                if self.peek() != end:
                    self.take(',')
            self.take(end)
            return values
        self.next += 1
        if kind == 'number':
            return float(text)
        if kind in ('string', 'path', 'asset'):
            return text[1:-1]
        return self.fault(f'no value: {text!r}')

    def metadata(self):
        values = {}
        if self.peek() != '(':
            return values
        self.take('(')
        while self.peek() != ')':
            name = self.take(group='word')
            if name == 'prepend':
                name = self.take(group='word')
            self.take('=')
            if self.peek() in ('true', 'false'):
                values[name] = self.take() == 'true'
            else:
                values[name] = self.value()
        self.take(')')
        return values

    def prim(self, parent):
        specifier = self.take(group='word')
        if specifier not in SPECIFIERS:
            self.fault(f'no specifier: {specifier}')
        kind = self.take(group='word') if self.tokens[self.next][0] == 'word' else ''
        name = self.take(group='string')[1:-1]
        if not re.fullmatch(r'[A-Za-z_]\w*', name):
            self.fault(f'no name of a prim: {name}')
        path = f'{parent}/{name}'
        if path in self.prims:
            self.fault(f'{path} is there twice')
        prim = self.prims[path] = Prim(path, specifier, kind, self.metadata())
        self.take('{')
        while self.peek() != '}':
            if self.peek() in SPECIFIERS:
                prim.children.append(self.prim(path))
            else:
                self.property(prim)
        self.take('}')
        return prim

    def property(self, prim):
        kind = self.take(group='word')
        if kind == 'uniform':
            kind = self.take(group='word')
        if kind not in TYPES:
            self.fault(f'no type: {kind}')
        name = self.take(group='word')
        if name in prim.values:
            self.fault(f'{name} is there twice')
        prim.values[name] = None
        if self.peek() == '=':
            self.take('=')
            prim.values[name] = self.value()
        self.metadata()


class Stage:
    """What the prims mean: references followed, points counted."""

    def __init__(self, text):
        self.reader = Reader(text)
        self.prims = self.reader.prims
        self.known = {}
        for prim in self.prims.values():
            self.check(prim)

    def check(self, prim):
        values = prim.values
        for name, target in values.items():
            if name.endswith('.connect') or name == 'material:binding':
                if target.split('.')[0] not in self.prims:
                    raise Fault(f'{prim.path}: {name} leads nowhere')
        if 'points' in values and prim.kind == 'Mesh':
            counts, corners = values['faceVertexCounts'], values['faceVertexIndices']
            if sum(counts) != len(corners) or max(corners) >= len(values['points']) or min(corners) < 0:
                raise Fault(f'{prim.path}: faces and points do not agree')
            if len(values['normals']) != len(values['points']):
                raise Fault(f'{prim.path}: normals and points do not agree')
        if 'xformOp:transform' in values:
            rows = values['xformOp:transform']
            if [len(row) for row in rows] != [4] * 4 or [row[3] for row in rows] != [0, 0, 0, 1]:
                raise Fault(f'{prim.path}: no affine matrix')
        if prim.kind == 'PointInstancer':
            count = len(values['protoIndices'])
            if any(len(values[name]) != count for name in ('positions', 'orientations', 'orientationsf', 'scales')):
                raise Fault(f'{prim.path}: lists of points differ in length')
            if any(target not in self.prims for target in self.listed(values['prototypes'])):
                raise Fault(f'{prim.path}: a prototype is missing')

    @staticmethod
    def listed(value):
        return value if isinstance(value, list) else [value]

    def composed(self, path):
        """The prim and what it references, strongest first."""
        prim, found = self.prims[path], []
        while prim:
            if prim in found:
                raise Fault(f'{path} references itself')
            found.append(prim)
            target = prim.metadata.get('references')
            if target is not None and target not in self.prims:
                raise Fault(f'{prim.path} references {target}, which is not there')
            prim = self.prims[target] if target else None
        return found

    def meshes(self, root):
        """How many meshes a prim means, and how deep instances lie in each other. Prototypes first, without recursion."""
        waiting, opened = [root], set()
        while waiting:
            path = waiting[-1]
            if path in self.known:
                waiting.pop()
                continue
            parts = self.parts(path)
            missing = [part for part, _, _ in parts if part not in self.known]
            if missing:
                if path in opened:
                    raise Fault(f'{path} holds itself')
                opened.add(path)
                waiting.extend(missing)
                continue
            own = any(prim.kind == 'Mesh' for prim in self.composed(path))
            self.known[path] = (own + sum(times * self.known[part][0] for part, times, _ in parts),
                                max([level + self.known[part][1] for part, _, level in parts], default=0))
            waiting.pop()
        return self.known[root]

    def parts(self, path):
        """What lies below: the path, how often, and how many instances further."""
        parts = []
        for prim in self.composed(path):
            if prim.kind == 'PointInstancer':
                targets = self.listed(prim.values['prototypes'])
                times = [0] * len(targets)
                for index in prim.values['protoIndices']:
                    times[int(index)] += 1
                parts += [(target, count, 1) for target, count in zip(targets, times)]
                continue
            for child in prim.children:
                if child.specifier == 'class':
                    continue
                # An instance is its prototype, which all share.
                target = child.metadata.get('references')
                if child.metadata.get('instanceable'):
                    if target not in self.prims:
                        raise Fault(f'{child.path} references {target}, which is not there')
                    parts.append((target, 1, 1))
                else:
                    parts.append((child.path, 1, 0))
        return parts


def main():
    path = Path(sys.argv[1])
    stage = Stage(path.read_text())
    root = '/' + stage.reader.layer['defaultPrim']
    meshes, levels = stage.meshes(root)
    print(json.dumps({'meshes': str(meshes), 'levels': levels, 'prims': len(stage.prims), 'bytes': path.stat().st_size}))


if __name__ == '__main__':
    try:
        main()
    except Fault as fault:
        sys.exit(f'{sys.argv[1]}: {fault}')
