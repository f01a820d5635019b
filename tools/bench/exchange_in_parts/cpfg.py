"""cpfg's L-systems (vlab), derived module by module as its program does, for what needs neither chance nor an
environment program. Nothing of graftal is used here."""
import math

from exchange_in_parts.cpfg_language import Language, Refused
from exchange_in_parts.turtle import Box, TooLong, along, cross, dot, unit

__all__ = ['Refused', 'draw']


class Turtle:
    def __init__(self, view):
        self.place, self.ahead = (0.0, 0.0, 0.0), (0.0, 1.0, 0.0)
        self.left, self.up = (-1.0, 0.0, 0.0), (0.0, 0.0, -1.0)
        self.scale, self.elasticity = 1.0, view.elasticity
        self.strengths = [tropism[1] for tropism in view.tropisms]

    def state(self):
        return self.place, self.ahead, self.left, self.up, self.scale, self.elasticity, list(self.strengths)

    def restore(self, state):
        self.place, self.ahead, self.left, self.up, self.scale, self.elasticity, self.strengths = state

    def turn(self, first, second, radians):
        cosine, sine = math.cos(radians), math.sin(radians)
        a, b = getattr(self, first), getattr(self, second)
        setattr(self, first, tuple(cosine * x + sine * y for x, y in zip(a, b)))
        setattr(self, second, tuple(cosine * y - sine * x for x, y in zip(a, b)))


def rotated(vector, axis, radians):
    cosine, sine = math.cos(radians), math.sin(radians)
    across, share = cross(axis, vector), dot(axis, vector) * (1 - cosine)
    return tuple(cosine * v + sine * c + share * a for v, c, a in zip(vector, across, axis))


class Drawing:
    TURNS = {'+': ('ahead', 'left', 1), '-': ('ahead', 'left', -1), '&': ('ahead', 'up', 1),
             '^': ('ahead', 'up', -1), '/': ('left', 'up', 1), '\\': ('left', 'up', -1)}

    def __init__(self, view):
        self.view, self.turtle, self.box, self.saved, self.open = view, Turtle(view), Box(), [], 0
        self.cylinder = False

    def bend_old(self):
        """After each move: towards the direction, in the plane of heading and up, then of heading and left."""
        t = self.turtle
        if t.elasticity == 0:
            return
        for side in ('up', 'left'):
            sine = t.elasticity * dot(self.view.direction, getattr(t, side))
            if abs(sine) > 1:
                raise Refused('an elasticity that bends farther than a right angle')
            t.turn('ahead', side, math.asin(sine))

    def bend_new(self):
        """Before each move; rolls stay as they are."""
        t = self.turtle
        pull, twist = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
        for (direction, _, angle, twists), strength in zip(self.view.tropisms, t.strengths):
            if twists:
                twist = tuple(p + strength * d for p, d in zip(twist, direction))
                continue
            pull = tuple(p + strength * math.cos(angle) * d for p, d in zip(pull, direction))
            if strength and math.sin(angle):
                beside = cross(t.ahead, direction)
                size = dot(beside, beside) ** 0.5
                beside = t.left if size < 1e-7 else tuple(x / size for x in beside)
                pull = tuple(p + strength * math.sin(angle) * x for p, x in zip(pull, cross(direction, beside)))
        self.rotate_to(('ahead', 'left', 'up'), t.ahead, pull)
        size = dot(twist, twist) ** 0.5
        across = cross(t.ahead, tuple(x / size for x in twist)) if size else (0.0, 0.0, 0.0)
        if dot(across, across) > 1e-8:
            self.rotate_to(('left', 'up'), t.up, tuple(size * x for x in cross(across, t.ahead)))

    def rotate_to(self, names, vector, pull):
        axis = cross(vector, pull)
        size = dot(axis, axis) ** 0.5
        if size < 1e-7:
            return
        axis = tuple(a / size for a in axis)
        for name in names:
            setattr(self.turtle, name, rotated(getattr(self.turtle, name), axis, min(size, 1.0)))

    def move(self, length, draws):
        t = self.turtle
        if self.view.tropisms:
            self.bend_new()
        end = along(t.place, t.ahead, length * t.scale)
        if draws:
            if self.open or self.cylinder:
                self.box.lines += 1
            else:
                self.box.add(t.place, end)
        t.place = end
        self.bend_old()

    def run(self, symbol, parameters):
        t = self.turtle
        first = parameters[0] if parameters else None
        if symbol in self.TURNS:
            a, b, sign = self.TURNS[symbol]
            t.turn(a, b, sign * math.radians(self.view.angle if first is None else first))
        elif symbol == '|':
            t.turn('ahead', 'left', math.pi)
        elif symbol in 'FGfg':
            self.move(1.0 if first is None else first, symbol in 'FG')
        elif symbol == '[':
            self.saved.append(t.state())
        elif symbol == ']':
            if self.saved:
                t.restore(self.saved.pop())
        elif symbol == '{':
            self.open += 1
            self.box.has_polygons = True
        elif symbol == '}':
            self.open = max(0, self.open - 1)
        elif symbol == '_':
            t.elasticity = t.elasticity + self.view.elasticity_step if first is None else first
        elif symbol == '@v':
            if abs(t.ahead[1]) < 1:
                t.left = unit(cross((0.0, 1.0, 0.0), t.ahead))
                t.up = cross(t.left, t.ahead)
        elif symbol == '@M' and len(parameters) >= 2:
            t.place = tuple(float(p) for p in (list(parameters) + [0])[:3])
        elif symbol == '@R' and len(parameters) >= 2:
            self.head_to(parameters)
        elif symbol == '@Di':
            t.scale *= first
        elif symbol == '@Dd':
            t.scale /= first
        elif symbol == '@Gs':
            self.cylinder = True
        elif symbol == '@Ge':
            self.cylinder = False
        elif symbol == '@Ts' and parameters:
            number = int(first) - 1
            if 0 <= number < len(t.strengths):
                t.strengths[number] = parameters[1] if len(parameters) > 1 else 0.0
        elif symbol in ('@O', '@o', '@c') or symbol[0] == '~':
            self.box.has_polygons = True

    def head_to(self, parameters):
        t = self.turtle
        heading = unit(tuple(float(p) for p in (list(parameters) + [0])[:3]))
        axis = cross(t.ahead, heading)
        size = dot(axis, axis) ** 0.5
        if size > 1e-12:
            axis = tuple(a / size for a in axis)
            angle = math.atan2(size, dot(t.ahead, heading))
            t.left, t.up = rotated(t.left, axis, angle), rotated(t.up, axis, angle)
        elif dot(t.ahead, heading) < 0:
            t.left = tuple(-x for x in t.left)
        t.ahead = heading
        if len(parameters) >= 6:
            t.up = unit(tuple(parameters[3:6]))
            t.left = cross(t.ahead, t.up)


class Walker:
    """Carries out a word, with the homomorphism."""

    def __init__(self, language, most):
        self.language, self.most, self.count = language, most, 0

    def walk(self, word, drawing, answers=None):
        """`answers`: takes the places in the word of queries, with what they hear."""
        self.count = 0
        cylinders = []
        for place, (symbol, parameters) in enumerate(word):
            if symbol == '[':
                cylinders.append(drawing.cylinder)
            self.meet(symbol, parameters, drawing, 0)
            if symbol == ']' and cylinders:
                drawing.cylinder = cylinders.pop()
            if answers is not None and symbol in ('?P', '?H', '?L', '?U'):
                t = drawing.turtle
                heard = {'?P': t.place, '?H': t.ahead, '?L': t.left, '?U': t.up}[symbol]
                answers.append((place, tuple(heard)[:len(parameters)] + tuple(parameters)[3:]))
        return drawing

    def meet(self, symbol, parameters, drawing, depth):
        self.count += 1
        if self.count > self.most:
            raise TooLong
        homomorphism = self.language.homomorphism
        if depth < self.language.depths['homomorphism']:
            for production in homomorphism.get(symbol, ()):
                successor = self.language.try_alone(production, parameters)
                if successor is not None:
                    for inner, values in successor:
                        if inner != '%':
                            self.meet(inner, values, drawing, depth + 1)
                    return
        drawing.run(symbol, parameters)


def draw(path, text, steps, most):
    """The box of the segments after so many steps (None: the model's)."""
    language = Language(path, text, most)
    walker = Walker(language, most)
    word = language.axiom()
    steps = language.steps() if steps is None else steps
    for step in range(steps):
        if language.has_queries:
            answers = []
            walker.walk(word, Drawing(language.view), answers)
            for place, heard in answers:
                word[place] = (word[place][0], heard)
        word = language.derive(word, step == steps - 1)
    return walker.walk(word, Drawing(language.view)).box
