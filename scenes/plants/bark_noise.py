"""What bark.py and autumn_bark.py share: smooth noise on lattices that close, and pictures with a palette."""
import math
import os
import random
import struct
import zlib


class Noise:
    def __init__(self, seed):
        self.chance = random.Random(seed)

    def lattice(self, columns, rows):
        return columns, rows, [[self.chance.random() for _ in range(columns)] for _ in range(rows)]


def noise(grid, u, v):
    """Smooth noise in [0, 1], of period 1 in u and v."""
    columns, rows, values = grid
    x, y = u * columns, v * rows
    i, j = math.floor(x), math.floor(y)
    s, t = x - i, y - j
    s, t = s * s * (3 - 2 * s), t * t * (3 - 2 * t)
    low, high = values[j % rows], values[(j + 1) % rows]
    a, b = i % columns, (i + 1) % columns
    return (low[a] * (1 - s) + low[b] * s) * (1 - t) + (high[a] * (1 - s) + high[b] * s) * t


def between(stops, t):
    """The colour at t of stops (t, rgb) in rising order."""
    for (t0, c0), (t1, c1) in zip(stops, stops[1:]):
        if t <= t1:
            k = (t - t0) / (t1 - t0)
            return [a + k * (b - a) for a, b in zip(c0, c1)]
    return list(stops[-1][1])


def write_png(name, palette, rows):
    """A square picture beside this file: rows of indices into the palette, three bytes a colour."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    lines = b"".join(b"\0" + bytes(row) for row in rows)
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), name), "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows), len(rows), 8, 3, 0, 0, 0))
                   + chunk(b"PLTE", palette) + chunk(b"IDAT", zlib.compress(lines, 9)) + chunk(b"IEND", b""))
