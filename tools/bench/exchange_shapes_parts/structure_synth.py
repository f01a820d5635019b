"""EisenScript as Structure Synth 1.5 derives it, from its sources' behaviour: states generation by generation, each with the
counts of rules that have a depth. Counts primitives; shares nothing with graftal."""
import math
import re

PRIMITIVES = {'box', 'sphere', 'line', 'dot', 'point', 'cylinder', 'tube'}
NUMBERS = {'x': (1, 1), 'y': (1, 1), 'z': (1, 1), 'rx': (1, 1), 'ry': (1, 1), 'rz': (1, 1), 's': (1, 3), 'fx': (0, 0),
           'fy': (0, 0), 'fz': (0, 0), 'matrix': (9, 9), 'reflect': (3, 3), 'h': (1, 1), 'hue': (1, 1), 'sat': (1, 1),
           'b': (1, 1), 'brightness': (1, 1), 'v': (1, 1), 'a': (1, 1), 'alpha': (1, 1)}


class Unknown(Exception):
    """The script has chance, sizes that end it, or what this derivation does not know."""


def preprocess(text):
    defines, lines = {}, []
    for line in re.split(r'\r\n|\r|\n', text):
        if line.startswith('#'):
            found = re.match(r'#define\s+(\S+)\s+(.*?)\s*(\((float|int):.*)?$', line.split('//')[0])
            if found:
                defines[found[1]] = found[2]
            continue
        for _ in range(100):
            name = next((n for n in sorted(defines) if n in line), None)
            if name is None:
                break
            line = line.replace(name, defines[name])
        lines.append(line)
    text = re.sub(r'/\*.*?\*/', ' ', '\n'.join(lines), flags=re.S)
    return re.sub(r'//[^\n]*', ' ', text)


def tokens(text):
    return re.findall(r'\S*?\[[^\]]*\]|[{}*>]|[^\s{}*>]+', preprocess(text).lower())


class Script:
    def __init__(self, text):
        self.tokens, self.at = tokens(text), 0
        self.rules = {'': [{'md': None, 'next': None, 'actions': [], 'weight': 1}]}
        self.generations, self.objects = 1000, 100_000
        top = self.rules[''][0]
        while self.at < len(self.tokens):
            if self.peek() == 'rule':
                self.rule()
            else:
                self.line(top)

    def peek(self):
        return self.tokens[self.at] if self.at < len(self.tokens) else ''

    def next(self):
        self.at += 1
        return self.tokens[self.at - 1]

    def rule(self):
        self.next()
        name, rule = self.next(), {'md': None, 'next': None, 'actions': [], 'weight': 1}
        while self.peek() != '{':
            word = self.next()
            if word in ('md', 'maxdepth'):
                rule['md'] = int(self.next())
                if self.peek() == '>':
                    self.next()
                    rule['next'] = self.next()
            elif word in ('w', 'weight'):
                rule['weight'] = float(self.next())
            else:
                raise Unknown(f'word {word}')
        self.next()
        while self.peek() != '}':
            self.line(rule)
        self.next()
        self.rules.setdefault(name, []).append(rule)

    def line(self, rule):
        if self.peek() == 'set':
            self.next()
            key, value = self.next(), self.next()
            if key in ('maxdepth', 'md'):
                self.generations = int(value)
            elif key == 'maxobjects':
                self.objects = int(value)
            elif key in ('minsize', 'maxsize', 'recursion'):
                raise Unknown(f'set {key}')
            return
        copies = 1
        while re.match(r'[-+.\d{]', self.peek()):
            if self.peek() != '{':
                copies *= max(1, int(self.next()))
                if self.next() != '*':
                    raise Unknown('count')
            self.next()
            while self.peek() != '}':
                self.operator()
            self.next()
        rule['actions'].append((copies, self.next()))

    def operator(self):
        word = self.next()
        if word in ('c', 'color', 'blend'):
            self.next()
            if word == 'blend':
                self.next()
            return
        if word not in NUMBERS:
            raise Unknown(f'operator {word}')
        least, most = NUMBERS[word]
        taken = 0
        while taken < most and re.match(r'[-+.\d]', self.peek()) and (taken < least or word == 's'):
            self.next()
            taken += 1

    def count(self):
        """Primitives that Structure Synth draws."""
        if any(len(rules) > 1 for rules in self.rules.values()):
            raise Unknown('chance')
        now, objects, generation = {('', ()): 1}, 0, 0
        while now and generation < self.generations and objects < self.objects and sum(now.values()) < self.objects:
            generation += 1
            following = {}
            for (name, counts), number in now.items():
                objects += self.apply(name, dict(counts), number, following)
            now = following
            if len(now) > 20_000:
                raise Unknown('too many states')
        return objects

    def apply(self, name, counts, number, following, deep=0):
        """The primitives drawn; calls go to the next generation."""
        if name not in self.rules:
            plain = name.split('::')[0]
            if plain == 'grid':
                return 12 * number  # graftal draws its edges
            if plain in PRIMITIVES or name.startswith('triangle['):
                return number
            if plain == 'template':
                return 0
            raise Unknown(f'primitive {name}')
        rule, below = self.rules[name][0], dict(counts)
        if rule['md'] is not None:
            left = counts.get(name)
            if left is not None and left <= 0:
                below[name] = rule['md']
                if rule['next'] is None or deep > 50:
                    return 0
                return self.apply(rule['next'], below, number, following, deep + 1)
            below[name] = (rule['md'] if left is None else left) - 1
        for copies, target in rule['actions']:
            key = (target, tuple(sorted(below.items())) if target in self.rules else ())
            following[key] = following.get(key, 0) + number * copies
        return 0


def boxes(text):
    try:
        return Script(text).count()
    except (IndexError, ValueError, RecursionError) as error:
        raise Unknown(str(error)) from error


def close(a, b):
    return math.isclose(a, b, rel_tol=1e-9, abs_tol=0.5)
