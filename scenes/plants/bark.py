#!/usr/bin/env python3
"""Writes bark.png, the bark of most trees here: 256 x 256, its edges fit on all sides.

Upright ridges that part and meet, with furrows between them and cracks across: sums of smooth noise on lattices that
close, so the picture does too. Python's own library is enough:  python3 bark.py
"""
from bark_noise import Noise, between, noise, write_png

SIZE = 256
NOISE = Noise(8)
lattice = NOISE.lattice

wave, small_wave = lattice(4, 3), lattice(11, 9)
ridges, fine_ridges = lattice(21, 5), lattice(40, 12)
across = lattice(9, 17)
grain, patches = lattice(96, 48), lattice(3, 4)


def height(u, v):
    u += 0.16 * (noise(wave, u, v) - 0.5) + 0.035 * (noise(small_wave, u, v) - 0.5)
    furrow = abs(2 * noise(ridges, u, v) - 1)                    # 0 along the furrows, which are closed curves
    furrow = min(1.0, furrow / 0.34)
    fine = abs(2 * noise(fine_ridges, u, v) - 1)
    crack = min(1.0, abs(2 * noise(across, u, v) - 1) / 0.16)
    return 0.58 * furrow + 0.20 * min(1.0, fine / 0.5) + 0.08 * crack + 0.14 * noise(grain, u, v)


STOPS = [(0.0, (38, 29, 23)), (0.35, (88, 71, 57)), (0.7, (138, 118, 98)), (1.0, (182, 164, 142))]


def colour(t, grey):
    t = max(0.0, min(1.0, t))
    c = between(STOPS, t)
    mean = sum(c) / 3
    return [a + grey * (mean - a) for a in c]


palette = b"".join(bytes(round(x) for x in colour(i / 63, grey)) for grey in (0, 0.2, 0.4, 0.6) for i in range(64))
heights = [[height(column / SIZE, row / SIZE) for column in range(SIZE)] for row in range(SIZE)]
rows = []
for row in range(SIZE):
    line = []
    for column in range(SIZE):
        h = heights[row][column]
        slope = h - heights[row][column - 2]                     # light from the left on the ridges
        shade = max(0, min(63, int(64 * (0.04 + 0.82 * h + 0.30 * slope))))
        grey = max(0, min(3, int(5 * noise(patches, column / SIZE, row / SIZE) - 0.5)))
        line.append(shade + 64 * grey)
    rows.append(line)

write_png("bark.png", palette, rows)
