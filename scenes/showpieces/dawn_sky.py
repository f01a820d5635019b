#!/usr/bin/env python3
"""Writes dawn_sky.exr, the sky of a clear dawn for `sky { environment: "dawn_sky.exr" }`, by NumPy and ffmpeg.

The sun stands 6 degrees above the horizon, towards the middle of the picture. The colours are ours: a blue zenith, a
rosy band about the horizon, and a glow that falls off around the sun by two exponentials. The picture has no disc.
"""
import os
import subprocess
import numpy

WIDTH, HEIGHT, SUN_DEG = 768, 384, 6.0


def rgb(*numbers):
    return numpy.array(numbers)[None, None, :]


up, around = numpy.mgrid[0:HEIGHT, 0:WIDTH]
elevation = 90 - 180*(up + 0.5)/HEIGHT
azimuth = 360*(around + 0.5)/WIDTH - 180
sun, e, a = numpy.radians(SUN_DEG), numpy.radians(elevation), numpy.radians(azimuth)
from_sun = numpy.degrees(numpy.arccos(numpy.clip(
    numpy.sin(e)*numpy.sin(sun) + numpy.cos(e)*numpy.cos(sun)*numpy.cos(a), -1, 1)))[..., None]
high = numpy.clip(elevation, 0, None)[..., None]
to_sun = (0.5 + 0.5*numpy.cos(a))[..., None]

sky = rgb(0.07, 0.16, 0.46)*(1 - 0.6*numpy.exp(-high/15)) + numpy.exp(-high/24)*rgb(0.28, 0.30, 0.24)
sky = sky + numpy.exp(-high/9)*(0.25 + 0.75*to_sun**2)*rgb(0.82, 0.32, 0.05)
sky = sky + numpy.exp(-from_sun/16)*rgb(0.80, 0.34, 0.06) + numpy.exp(-from_sun/3.2)*rgb(3.2, 1.9, 0.8)
ground = rgb(0.16, 0.15, 0.15) + numpy.zeros_like(sky)
below = numpy.clip(-elevation/4, 0, 1)[..., None]
sky = (1 - below)*sky + below*ground

planes = numpy.stack([sky[..., 1], sky[..., 2], sky[..., 0]]).astype("<f4")      # ffmpeg's gbrpf32 has green first
subprocess.run(["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", "gbrpf32le", "-s", f"{WIDTH}x{HEIGHT}", "-i", "-",
                "-frames:v", "1", "-compression", "zip16", "-format", "half",
                os.path.join(os.path.dirname(os.path.abspath(__file__)), "dawn_sky.exr")],
               input=planes.tobytes(), check=True)
