"""The box that a turtle's lines reach: nothing of graftal is used here."""


class Box:
    def __init__(self):
        self.low, self.high, self.lines = None, None, 0
        self.has_polygons = False  # which are no lines, and may reach farther

    def add(self, start, end):
        self.lines += 1
        for point in (start, end):
            if self.low is None:
                self.low, self.high = list(point), list(point)
            for axis, value in enumerate(point):
                self.low[axis] = min(self.low[axis], value)
                self.high[axis] = max(self.high[axis], value)


class TooLong(Exception):
    """A word that plain rewriting cannot hold."""


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def along(point, direction, length):
    return tuple(p + length * d for p, d in zip(point, direction))


def unit(vector):
    length = dot(vector, vector) ** 0.5
    return tuple(x / length for x in vector)
