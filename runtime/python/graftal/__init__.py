"""graftal: pictures of fractals and plants, from models of a few lines.

    import graftal
    fern = graftal.load("fern.rifs", steps=8)
    picture = fern.render((640, 360))         # NumPy array, shape (360, 640, 3), sRGB bytes
    places, colours = fern.points(1_000_000)  # arrays of shape (1000000, 3)
    fern.stats()["primitives"]

A model is loaded from a file, or from a string by lsys(), rifs() or inst(). Functions that work release Python's lock. Ctrl-C
ends them. One model is for one thread at a time; several models may run in several threads.
"""

from __future__ import annotations

import json
import math
import os
import tempfile
from dataclasses import dataclass
from typing import Any, Callable, Optional, Sequence, Tuple, Union

import numpy as np

try:
    from . import _graftal
except ImportError:
    _folder = os.path.dirname(os.path.abspath(__file__))
    if any(name.startswith("_graftal.") and name.endswith(".so") for name in os.listdir(_folder)):
        raise
    _build = os.path.dirname(os.path.dirname(_folder))
    raise ImportError(
        f"the module of graftal is not in '{_folder}'"
        + (
            f": build it with: cmake --build '{_build}' --target graftal_python"
            if os.path.exists(os.path.join(_build, "CMakeCache.txt"))
            else ": install the package python3-graftal again"
        )
    ) from None
from ._graftal import Message

__all__ = ["Cancelled", "Graph", "Message", "Model", "ModelError", "ModelWarning", "inst", "load", "lsys", "rifs"]
__version__: str = _graftal.version

Progress = Callable[[str, Optional[float]], None]
Vector = Tuple[float, float, float]


class ModelError(Exception):
    """A model, or the files that it needs, are at fault.

    `messages`: what graftal says, each with severity ("error", "warning", "note"), file, line, column (from 1; 0 without a
    file), text and hint.
    """

    def __init__(self, text: str, messages: Sequence[Message] = ()) -> None:
        super().__init__(text.rstrip("\n"))
        self.messages = list(messages)


class ModelWarning(UserWarning):
    """A model was drawn or written otherwise than it was asked for, such as coarser."""


class Cancelled(ModelError):
    """Model.cancel() ended the work."""


@dataclass(frozen=True)
class Graph:
    """The object-instance graph of a model, of N objects and M instances.

    An object is a primitive, or the union of its instances. The graph may have cycles.
    """

    root: int
    objects: "list[str]"
    """names of the N objects"""
    primitives: "list[str]"
    """of each object, such as "sphere"; "" of a union"""
    parents: np.ndarray
    """(M,) int64: the object that has the instance"""
    children: np.ndarray
    """(M,) int64: the object that is placed"""
    parent_from_child: np.ndarray
    """(M, 3, 4) float64: affine maps, x' = A[:, :3] @ x + A[:, 3]"""
    tints: np.ndarray
    """(M, 4) float64: linear red, green, blue and alpha, in front of what the child has"""


class Model:
    """A model, and what is asked of it. What has not changed is not made again: a new camera reads nothing."""

    def __init__(self, model: _graftal.Model, name: str) -> None:
        self._model = model
        self._name = name
        self._set: "dict[str, float]" = {}

    def __repr__(self) -> str:
        return f"graftal.Model({', '.join([repr(self._name), *(f'{name}={value!r}' for name, value in self._set.items())])})"

    def set(self, *, steps: Optional[float] = None, seed: Optional[int] = None, **lets: float) -> "Model":
        """Sets the depth, the seed of random models, and values of `let` in the model.

        `steps`: 7.5 shows a plant that reads the time between its steps 7 and 8.
        """
        if steps is not None:
            if not (math.isfinite(steps) and steps >= 0):
                raise ValueError(f"steps: {steps!r} is not a number, 0 or more")
            self._model.time(steps)
            self._set["steps"] = steps
        if seed is not None:
            self._model.seed(seed)
            self._set["seed"] = seed
        for name, value in lets.items():
            self._model.set(name, float(value))
            self._set[name] = value
        return self

    def camera(
        self,
        location: Optional[Vector] = None,
        look_at: Optional[Vector] = None,
        up: Optional[Vector] = None,
        angle_deg: Optional[float] = None,
        orthographic: bool = False,
        width: Optional[float] = None,
        aperture: Optional[float] = None,
        focus: Optional[Vector] = None,
    ) -> "Model":
        """Sets all of the camera: the model says, or graftal chooses, what you do not give.

        `angle_deg`: horizontal angle of view. `width`: of an orthographic view, in the model's units. `aperture`: radius of
        the lens. `focus`: a point that is sharp.
        """
        self._model.camera(location, look_at, up, angle_deg, orthographic, width)
        self._model.lens(aperture, focus)
        return self

    def zoom(self, factor: Optional[float]) -> "Model":
        """Enlarges so many times, about the point that the camera looks at."""
        self._model.zoom(factor)
        return self

    def limits(
        self,
        *,
        error_px: Optional[float] = None,
        memory_bytes: Optional[int] = None,
        work_s: Optional[float] = None,
        threads: Optional[int] = None,
    ) -> "Model":
        """Sets the limits that you give; the others stay as they are.

        `error_px`: graftal leaves out parts smaller than so many pixels (first 0.5). `memory_bytes`: of memory (first 2 GiB).
        `work_s`: seconds of one processor for a picture. `threads`: 0, as at first, is one for each processor.
        """
        if error_px is not None:
            self._model.error_px(error_px)
        if memory_bytes is not None:
            self._model.memory(memory_bytes)
        if work_s is not None:
            self._model.work(work_s)
        if threads is not None:
            self._model.threads(threads)
        return self

    def edit(self, text: str) -> "Model":
        """A new text in place of the model's own."""
        self._model.edit(text)
        return self

    def reload(self) -> "Model":
        """Reads the file, and those that it names, again."""
        self._model.reload()
        return self

    def cancel(self) -> None:
        """Ends, from another thread, what is under way: it raises Cancelled."""
        self._model.cancel()

    def stats(self, progress: Optional[Progress] = None) -> "dict[str, Any]":
        """What `graftal stats --json` prints, with its counts as integers. `graftal stats --help` explains the keys."""
        stats = json.loads(self._model.stats(progress))
        del stats["leaves"]  # the old name of primitives
        for key in ("primitives", "modules", "segments"):
            if stats.get(key) is not None:
                stats[key] = int(stats[key])
        return stats

    @property
    def graph(self) -> Graph:
        """The graph after the compiler's passes; at most 10^7 instances."""
        return Graph(**self._model.graph(None))

    def render(
        self, size: "tuple[int, int]" = (1280, 720), quality: str = "normal", progress: Optional[Progress] = None
    ) -> np.ndarray:
        """A picture by graftal's own ray tracer: (height, width, 3) uint8, sRGB, the top row first.

        `size`: width and height in pixels. `quality`: "draft", "normal" or "best". `progress`: is called with the name of a
        stage and a share from 0 to 1, or None.
        """
        self._ask(size, quality)
        return self._model.render(progress)

    def aovs(
        self, size: "tuple[int, int]" = (1280, 720), quality: str = "normal", progress: Optional[Progress] = None
    ) -> "tuple[dict[str, np.ndarray], list[str]]":
        """What the samples of a picture meet: what `graftal render --aovs -o FILE.exr` writes.

        Arrays (height, width) of float32 by the channel's name, such as "R" (linear light), "coverage", "Z", "normal.X" and
        "id"; and the names of objects, that of the id n at n - 1. The light is not denoised.
        """
        self._ask(size, quality)
        names, samples, objects = self._model.aovs(progress)
        return {name: samples[:, :, number] for number, name in enumerate(names)}, objects

    def word(self, progress: Optional[Progress] = None) -> str:
        """The string that an L-system derives, before interpretation, as an axiom would have it."""
        return self._model.word(progress)

    def plant(self, progress: Optional[Progress] = None) -> np.ndarray:
        """The modules of that string and what is drawn, a structured array: `graftal export -o FILE.csv` in memory.

        Fields: name, parent (row, -1 of the first), branches (or follows its parent), order, rank, part_of (the row of the
        module in whose place it is drawn, -1: none), organ, material, age (-1: not known), start, end, heading, left and up
        (3 each, in the model's units), length, width, area, volume (NaN: not known), parameters (NaN where it has fewer).
        """
        parts = self._model.plant(progress)
        columns = {
            key: np.array(value, dtype=bool if key == "branches" else str) if isinstance(value, list) else value
            for key, value in parts.items()
        }
        names = columns["name"]
        table = np.empty(len(names), dtype=[(key, value.dtype, value.shape[1:]) for key, value in columns.items()])
        for key, value in columns.items():
            table[key] = value
        return table

    def measures(
        self,
        ground_area: Optional[float] = None,
        irradiance: bool = False,
        samples: Optional[int] = None,
        progress: Optional[Progress] = None,
    ) -> "dict[str, Any]":
        """Measures of the plant: what `graftal stats --plant --json` prints; `graftal stats --help` explains the keys.

        `ground_area`: for the leaf area index and the share of light, in square units of the model; else the crown's convex
        hull from above. `irradiance`: traces the light on each organ, by so many `samples`, as far as limits(work_s=) allows;
        None goes on until the organs' light has a standard error of 1% of its mean. Then ["light"]["organs"] is a structured
        array with the rows of plant(): irradiance, where an open horizontal plane has 1, irradiance_error, absorbed, and
        sunlit, a share (NaN where nothing is known).
        """
        text, organs = self._model.measures(ground_area, irradiance, samples, progress)
        measures = json.loads(text)
        if irradiance:
            table = np.empty(len(organs["irradiance"]), dtype=[(key, value.dtype) for key, value in organs.items()])
            for key, value in organs.items():
                table[key] = value
            measures["light"]["organs"] = table
        return measures

    def points(self, count: int, progress: Optional[Progress] = None) -> "tuple[np.ndarray, np.ndarray]":
        """Points by random iteration: places (count, 3) float32 in the model's units, and colours (count, 3) uint8, sRGB.

        The same as `graftal points -o FILE.ply` writes.
        """
        return self._model.points(count, progress)

    def export(
        self,
        path: "Union[str, os.PathLike[str]]",
        size: "tuple[int, int]" = (1280, 720),
        quality: str = "normal",
        engine: str = "native",
        progress: Optional[Progress] = None,
        *,
        unit_mm: Optional[float] = None,
        levels: Optional[int] = None,
        nodes: Optional[int] = None,
        instancing: bool = False,
        plotter: bool = False,
        most_bytes: int = 1 << 30,
        irradiance: bool = False,
        parts: "Sequence[str]" = (),
    ) -> None:
        """Writes a picture (.png, .exr), a scene for POV-Ray (.pov, .inc), or a file for another program (.usda, .gltf, .glb,
        .obj, .ply, .stl, .svg, .pbrt, .xml), or the plant as data (.csv, .json, .mtg).

        `engine`, of pictures: "native" or "povray". What follows is for other programs, each for some formats only, as the
        options of `graftal export` are. `unit_mm`: what a unit of the model measures, in millimetres. `most_bytes`: of
        the file. If the whole model takes more, graftal leaves out small parts until the file has no more (by default 128
        MiB), with a ModelWarning; if limits() has set error_px, it refuses the model. `irradiance`: the light on each organ of
        a plant, as measures() has it. `parts`: names of objects that stay meshes of their own.
        """
        if engine not in ("native", "povray"):
            raise ValueError(f"engine: {engine!r} is neither 'native' nor 'povray'")
        self._ask(size, quality)
        name = os.fspath(path)
        if name.endswith((".pov", ".inc")):
            self._model.compile_to(name, progress)
        elif name.endswith((".png", ".exr")):
            self._model.render_to(name, engine, progress)
        else:
            self._model.export_to(name, unit_mm, levels, nodes, instancing, plotter, most_bytes, irradiance, list(parts), progress)

    def _repr_png_(self) -> bytes:
        """The picture that a notebook shows of a model."""
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "picture.png")
            self.export(path, (480, 270), "draft")
            with open(path, "rb") as file:
                return file.read()

    def _ask(self, size: "tuple[int, int]", quality: str) -> None:
        if quality not in ("draft", "normal", "best"):
            raise ValueError(f"quality: {quality!r} is none of 'draft', 'normal', 'best'")
        width, height = size
        if not (1 <= width <= 32768 and 1 <= height <= 32768):
            raise ValueError(f"size: {size!r} is not two numbers of pixels from 1 to 32768")
        self._model.size(width, height)
        self._model.quality(quality)


def load(path: "Union[str, os.PathLike[str]]", *, steps: Optional[float] = None, seed: Optional[int] = None, **lets: float) -> Model:
    """A model from a file: .lsys, .rifs, .inst, or one that `graftal import` knows. It is read when it is needed first."""
    return Model(_graftal.Model.from_file(os.fspath(path)), os.fspath(path)).set(steps=steps, seed=seed, **lets)


def _from_text(language: str, text: str, name: str, steps: Optional[float], seed: Optional[int], lets: "dict[str, float]") -> Model:
    return Model(_graftal.Model.from_text(f"{name}.{language}", text), f"{name}.{language}").set(steps=steps, seed=seed, **lets)


def lsys(text: str, *, name: str = "model", steps: Optional[float] = None, seed: Optional[int] = None, **lets: float) -> Model:
    """A parametric L-system from a string. Files that it names are looked up beside `name`."""
    return _from_text("lsys", text, name, steps, seed, lets)


def rifs(text: str, *, name: str = "model", steps: Optional[float] = None, seed: Optional[int] = None, **lets: float) -> Model:
    """A recurrent iterated function system from a string."""
    return _from_text("rifs", text, name, steps, seed, lets)


def inst(text: str, *, name: str = "model", steps: Optional[float] = None, seed: Optional[int] = None, **lets: float) -> Model:
    """Objects and instances from a string."""
    return _from_text("inst", text, name, steps, seed, lets)
