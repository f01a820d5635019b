#!/usr/bin/env python3
"""Writes autumn_bark.png, the bark of autumn.inst: 384 x 384, its edges fit on all sides.

Long plates with furrows between them: the cells of Worley's noise on a lattice of 19 x 4, bent by smooth noise. All
lattices close, so the picture does too. Python's own library is enough:  python3 autumn_bark.py
"""
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


SIZE = 384
NOISE = Noise(6)
lattice = NOISE.lattice

COLUMNS, ROWS = 19, 4
points = [[(NOISE.chance.random(), NOISE.chance.random(), NOISE.chance.random()) for _ in range(COLUMNS)] for _ in range(ROWS)]
bend_u, bend_v = lattice(5, 4), lattice(8, 3)
rag = lattice(30, 14)
streak, grain, patches = lattice(60, 12), lattice(128, 96), lattice(4, 4)


def plate(u, v):
    """How far from the furrow, and the plate's own number."""
    u += 0.10 * (noise(bend_u, u, v) - 0.5) + 0.034 * (noise(rag, u, v) - 0.5)
    v += 0.30 * (noise(bend_v, u, v) - 0.5)
    x, y = u * COLUMNS, v * ROWS
    i, j = math.floor(x), math.floor(y)
    first = second = 9.0
    mine = 0.0
    for dj in (-1, 0, 1):
        for di in (-1, 0, 1):
            px, py, number = points[(j + dj) % ROWS][(i + di) % COLUMNS]
            d = math.hypot(i + di + px - x, j + dj + py - y)
            if d < first:
                first, second, mine = d, first, number
            elif d < second:
                second = d
    return second - first, mine


# The palette: 64 shades from the furrow to the ridge, and the same with lichen.
def ramp(t, lichen):
    stops = [(0.0, (34, 25, 20)), (0.3, (78, 61, 49)), (0.65, (128, 107, 90)), (1.0, (178, 160, 140))]
    c = between(stops, t)
    if lichen:
        c = [0.6 * c[0] + 0.4 * 118, 0.6 * c[1] + 0.4 * 124, 0.6 * c[2] + 0.4 * 92]
    return bytes(round(x) for x in c)


palette = b"".join(ramp(i / 63, lichen) for lichen in (False, True) for i in range(64))
height = []
for row in range(SIZE):
    line = []
    for column in range(SIZE):
        u, v = column / SIZE, row / SIZE
        edge, number = plate(u, v)
        ridge = min(1.0, edge / 0.42)
        ridge = ridge * ridge * (3 - 2 * ridge)
        line.append(0.58 * ridge + 0.26 * ridge * noise(streak, u, v) + 0.14 * noise(grain, u, v) + 0.10 * (number - 0.5))
    height.append(line)

rows = []
for row in range(SIZE):
    line = []
    for column in range(SIZE):
        u, v = column / SIZE, row / SIZE
        h = height[row][column]
        slope = h - height[row][column - 2]                      # light from the left on the plates' edges
        shade = 0.10 + 0.72 * h + 0.35 * slope
        index = max(0, min(63, int(64 * shade)))
        mossy = 0.75 * noise(patches, u, v) + 0.25 * noise(grain, u, v) > 0.60 and h > 0.4
        line.append(index + (64 if mossy else 0))
    rows.append(line)

write_png("autumn_bark.png", palette, rows)
