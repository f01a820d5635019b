"""The view file of a cpfg model: what it says of angles, tropisms and functions."""
import math
import re


def numbers(text):
    return [float(n) for n in re.findall(r'[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?', text)]


class View:
    def __init__(self, path):
        self.angle, self.elasticity, self.elasticity_step, self.direction = 45.0, 0.0, 0.0, (0.0, 1.0, 0.0)
        self.tropisms, self.functions, self.named = [], [], {}
        name = self.file_of(path)
        text = (path.parent / name).read_bytes().decode('latin-1') if name else ''
        for line in text.replace('\r', '').split('\n'):
            word, _, value = re.split(r'//|/\*', line)[0].partition(':')
            word, found = word.strip(), numbers(value)
            if word == 'angle increment' and found:
                self.angle = found[0]
            elif word == 'angle factor' and found:
                self.angle = 360 / found[0]
            elif word == 'tropism direction' and len(found) == 3:
                size = sum(x * x for x in found) ** 0.5
                self.direction = tuple(x / size for x in found)
            elif word == 'initial elasticity' and found:
                self.elasticity = found[0]
            elif word == 'elasticity increment' and found:
                self.elasticity_step = found[0]
            elif word in ('tropism', 'torque'):
                self.add_tropism(word, value)
            elif word in ('function', 'function set'):
                words = value.split()
                self.add_functions(path.parent / words[0], word == 'function set',
                                   int(words[1]) if len(words) > 1 and words[1].isdigit() else 100)

    @staticmethod
    def file_of(path):
        specifications = path.parent / 'specifications'
        if specifications.exists():
            for line in specifications.read_bytes().decode('latin-1').split('\n'):
                words = line.split()
                if words and words[0].startswith('cpfg') and path.name in words:
                    names = [w for w in words if w.endswith(('.v', '.view')) and (path.parent / w).exists()]
                    return names[0] if names else None
        for ending in ('.v', '.view'):
            if path.with_suffix(ending).exists():
                return path.with_suffix(ending).name
        return None

    def add_tropism(self, word, text):
        parts = {m[0]: numbers(m[1]) for m in re.findall(r'([TAIES])\s*:([^TAIES]*)', text)}
        direction = parts.get('T', [0.0, 1.0, 0.0])
        size = sum(x * x for x in direction) ** 0.5
        strength = max(-1.0, min(1.0, parts.get('I', [1.0])[0]))
        self.tropisms.append((tuple(strength * x / size for x in direction), parts.get('E', [0.0])[0],
                              math.radians(parts.get('A', [0.0])[0]), word == 'torque'))

    def add_functions(self, path, gallery, samples):
        if not path.exists():
            return
        name, wanted, points = path.stem, 0, []
        for line in path.read_bytes().decode('latin-1').replace('\r', '').split('\n'):
            if line.startswith('name:'):
                name = line[5:].strip()
            elif line.startswith('samples:'):
                samples = int(line[8:])
            elif line.startswith('points:'):
                wanted, points = int(line[7:]), []
            elif len(points) < wanted and len(numbers(line)) >= 2:
                x, y, *rest = numbers(line)
                times = int(rest[0]) if rest else 1
                points += [(x, y)] * times
                wanted += times - 1
                if len(points) >= wanted:
                    self.functions.append([spline(points, i / (samples - 1)) for i in range(samples)])
                    if gallery:
                        self.named[name] = len(self.functions)

    def function(self, number, x):
        values = self.functions[int(number) - 1]
        place = min(1.0, max(0.0, x)) * (len(values) - 1)
        before = min(int(place), len(values) - 2)
        return values[before] + (place - before) * (values[before + 1] - values[before])


def spline(points, share):
    """An open cubic B-spline through its first and last points: the height where it reaches the place."""
    order = min(4, len(points))
    pieces = len(points) - order + 1

    def knot(j):
        return 0 if j < order else min(j - order + 1, pieces)

    def at(u):
        piece = min(int(u), pieces - 1)
        d = [points[piece + j] for j in range(order)]
        for r in range(1, order):
            for j in range(order - 1, r - 1, -1):
                begin, end = knot(piece + j), knot(piece + j + order - r)
                a = (u - begin) / (end - begin) if end > begin else 0
                d[j] = tuple((1 - a) * p + a * q for p, q in zip(d[j - 1], d[j]))
        return d[order - 1]

    low, high = 0.0, float(pieces)
    place = points[0][0] + share * (points[-1][0] - points[0][0])
    for _ in range(50):
        middle = (low + high) / 2
        if at(middle)[0] < place:
            low = middle
        else:
            high = middle
    return at((low + high) / 2)[1]
