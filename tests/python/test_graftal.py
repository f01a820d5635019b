"""The Python package against the program: GRAFTAL_PROGRAM and GRAFTAL_SOURCE name it and the project."""

import csv
import json
import math
import os
import pathlib
import resource
import struct
import subprocess
import sys
import tempfile
import threading
import unittest
import zlib

import numpy as np

import graftal

PROGRAM = os.environ["GRAFTAL_PROGRAM"]
SOURCE = os.environ["GRAFTAL_SOURCE"]


def scene(name):
    return os.path.join(SOURCE, "scenes", name)


def png(path):
    """An RGB PNG of 8 bits without interlacing."""
    data = pathlib.Path(path).read_bytes()
    at, packed, size = 8, b"", None
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + length]
        if kind == b"IHDR":
            size = struct.unpack(">II", body[:8])
            assert body[8:10] == b"\x08\x02"
        if kind == b"IDAT":
            packed += body
        at += 12 + length
    width, height = size
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + 3 * width)
    picture = np.zeros((height, 3 * width), np.uint8)
    for y, row in enumerate(rows):
        above = picture[y - 1].astype(int) if y else np.zeros(3 * width, int)
        if row[0] in (0, 2):
            picture[y] = row[1:] + (above if row[0] == 2 else 0)
            continue
        done = picture[y]
        for x in range(3 * width):
            left = int(done[x - 3]) if x >= 3 else 0
            corner = int(above[x - 3]) if x >= 3 else 0
            guess = left + int(above[x]) - corner
            nearest = min((left, int(above[x]), corner), key=lambda v: abs(guess - v))
            done[x] = (int(row[1 + x]) + {1: left, 3: (left + int(above[x])) // 2, 4: nearest}[int(row[0])]) & 255
    return picture.reshape(height, width, 3)


class Package(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def program(self, *words):
        return subprocess.run([PROGRAM, *words], check=True, capture_output=True, text=True).stdout

    def printed_stats(self, *words):
        """As the program prints them, with its counts as numbers, and under their newest names only."""
        printed = json.loads(self.program("stats", *words, "--json"))
        self.assertEqual(printed.pop("leaves"), printed["primitives"])
        for key in ("primitives", "modules", "segments"):
            if printed.get(key) is not None:
                printed[key] = int(printed[key])
        return printed

    def test_stats_are_those_of_the_program(self):
        for name in ("hart/pound_sign.rifs", "abop/fig1_25.lsys", "hart/elm.inst"):
            printed = self.printed_stats(scene(name), "--steps", "5")
            self.assertEqual(graftal.load(scene(name), steps=5).stats(), printed)

    def test_counts_are_integers_however_large(self):
        stats = graftal.load(scene("abop/fig1_24f.lsys"), steps=100).stats()
        for key in ("objects", "instances", "primitives", "modules", "segments"):
            self.assertIs(type(stats[key]), int, key)
        self.assertGreater(stats["segments"], 10**40)

    def test_steps_may_lie_between_two(self):
        herb = scene("plants/growing_herb.lsys")
        stats = graftal.load(herb, steps=7.5).stats()
        self.assertEqual(stats["time"], 7.5)
        self.assertEqual(stats, self.printed_stats(herb, "--steps", "7.5"))
        self.assertEqual(graftal.load(herb, steps=7.0).stats(), self.printed_stats(herb, "--steps", "7"))
        with self.assertRaises(ValueError):
            graftal.load(herb, steps=-1)

    def test_a_limit_that_is_not_given_stays(self):
        model = graftal.load(scene("hart/pound_sign.rifs")).limits(work_s=1e-3)
        for more in ({}, {"threads": 1}, {"memory_bytes": 1 << 30}):
            model.limits(**more)
            with self.assertWarnsRegex(graftal.ModelWarning, "work_s="):
                model.render((640, 360), "best")

    def test_messages_speak_of_python(self):
        said = []
        for model in (graftal.load(scene("hart/pound_sign.rifs"), bogus=1), graftal.load(scene("ifs/fern.rifs"), steps=2.5),
                      graftal.lsys("lsys a {\n axiom F\n F -> FF\n}\n")):
            with self.assertRaises(graftal.ModelError) as caught:
                model.stats()
            said.append(str(caught.exception))
            said += [part for message in caught.exception.messages for part in (repr(message), message.text, message.hint)]
        with self.assertRaises(graftal.ModelError) as caught:
            graftal.load(scene("ifs/fern.rifs")).limits(error_px=2).export(self.path("a.obj"), most_bytes=1000)
        said.append(str(caught.exception))
        for text in said:
            self.assertNotIn("--", text)
            self.assertNotIn("command", text)
        self.assertIn("give 'steps=5'", said[8])
        self.assertIn("most_bytes=", said[-1])
        self.assertIn("error_px=", said[-1])

    def test_a_file_that_would_be_too_large_is_written_coarser(self):
        with self.assertWarnsRegex(graftal.ModelWarning, "leaves out parts smaller than"):
            graftal.load(scene("ifs/fern.rifs")).export(self.path("a.obj"), most_bytes=1_000_000)
        self.assertLessEqual(os.path.getsize(self.path("a.obj")), 1_000_000)

    def test_a_model_and_the_package_say_what_they_are(self):
        self.assertEqual(f"graftal {graftal.__version__}\n", self.program("version"))
        self.assertEqual(repr(graftal.load("fern.rifs", steps=7.5, k=2).set(seed=3)),
                         "graftal.Model('fern.rifs', steps=7.5, k=2, seed=3)")
        self.assertEqual(repr(graftal.rifs("rifs x {}")), "graftal.Model('model.rifs')")

    def test_a_package_without_its_module_says_how_to_build_it(self):
        package = pathlib.Path(self.path("python/graftal"))
        package.mkdir(parents=True)
        (package / "__init__.py").write_bytes(pathlib.Path(graftal.__file__).read_bytes())
        command = f"cmake --build '{self.folder.name}' --target graftal_python"
        for cache, said in (("", "install the package python3-graftal"), ("CMakeCache.txt", command)):
            if cache:
                pathlib.Path(self.path(cache)).touch()
            run = subprocess.run([sys.executable, "-c", "import graftal"], capture_output=True, text=True,
                                 env={**os.environ, "PYTHONPATH": str(package.parent)})
            self.assertEqual(run.returncode, 1)
            self.assertIn(said, run.stderr)
            self.assertNotIn("circular", run.stderr)

    def test_the_lens_blurs(self):
        model = graftal.load(scene("hart/pound_sign.rifs"), steps=2)
        sharp = model.render((64, 36), "draft")
        blurred = model.camera(aperture=0.5, focus=(0, 0, 0)).render((64, 36), "draft")
        self.assertFalse(np.array_equal(sharp, blurred))
        np.testing.assert_array_equal(model.camera().render((64, 36), "draft"), sharp)

    def test_pictures_are_those_of_the_program_to_the_bit(self):
        for name in ("hart/pound_sign.rifs", "abop/fig1_24e.lsys"):
            self.program("render", scene(name), "--engine", "native", "--steps", "4", "--size", "96x54", "--quality", "draft",
                         "-q", "-o", self.path("a.png"))
            drawn = graftal.load(scene(name), steps=4).render((96, 54), "draft")
            np.testing.assert_array_equal(drawn, png(self.path("a.png")))
            self.assertGreater(len(np.unique(drawn)), 10)

    def test_aovs_show_what_is_met(self):
        model = graftal.inst("camera { location: 0,0,5 look_at: 0,0,0 orthographic width: 4 }\nlight { sun: 1,2,3 }\n"
                             "material red { color: 0.8, 0.2, 0.1 }\nobject m { instance: sphere material: red }\n")
        seen, names = model.aovs((64, 48), "draft")
        x, y = np.meshgrid((np.arange(64) + 0.5) / 16 - 2, 1.5 - (np.arange(48) + 0.5) / 16)
        inside, outside = x**2 + y**2 < 0.9, x**2 + y**2 > 1.1
        self.assertEqual(seen["Z"].dtype, np.float32)
        self.assertTrue((seen["coverage"][inside] == 1).all() and (seen["coverage"][outside] == 0).all())
        np.testing.assert_allclose(seen["Z"][inside], 5 - np.sqrt(1 - (x**2 + y**2)[inside]), atol=0.02)
        self.assertTrue(np.isinf(seen["Z"][outside]).all())
        self.assertEqual({names[int(number) - 1] for number in seen["id"][inside]}, {"m"})
        np.testing.assert_allclose(seen["CryptoMaterial00.G"], seen["coverage"], atol=1e-6)
        self.assertTrue((seen["R"][inside] > seen["G"][inside]).all())

    def test_plants_are_the_rows_of_the_program(self):
        path = scene("abop/fig2_6a.lsys")
        self.program("export", path, "--steps", "4", "-q", "-o", self.path("a.csv"))
        lines = [line.split(",") for line in pathlib.Path(self.path("a.csv")).read_text().splitlines()]
        header, rows = lines[0], lines[1:]
        model = graftal.load(path, steps=4)
        plant = model.plant()
        self.assertEqual(len(plant), len(rows))
        for key, column in (("order", "order"), ("rank", "rank"), ("width", "width"), ("length", "length"), ("area", "area"), ("age", "age")):
            np.testing.assert_allclose(plant[key], [float(row[header.index(column)]) for row in rows], atol=1e-12)
        self.assertEqual(list(plant["name"]), [row[header.index("name")] for row in rows])
        bears = plant["parent"] >= 0
        np.testing.assert_allclose(plant["start"][bears], plant["end"][plant["parent"][bears]], atol=1e-12)
        np.testing.assert_array_equal(
            plant["order"][bears], plant["order"][plant["parent"][bears]] + plant["branches"][bears]
        )
        self.assertEqual(model.word().count("F"), int((plant["name"] == "F").sum()))
        for ending in (".csv", ".json", ".mtg"):
            model.export(self.path("python" + ending))
            self.program("export", path, "--steps", "4", "-q", "-o", self.path("program" + ending))
            self.assertEqual(
                pathlib.Path(self.path("python" + ending)).read_bytes(), pathlib.Path(self.path("program" + ending)).read_bytes()
            )
        with self.assertRaises(graftal.ModelError):
            graftal.load(scene("ifs/fern.rifs")).plant()
        with self.assertRaisesRegex(Exception, "csv"):
            model.export(self.path("a.xyz"))

    def test_measures_are_those_of_the_program(self):
        path = scene("abop/fig2_6a.lsys")
        options = ("--steps", "4", "--samples", "16", "--irradiance")
        printed = json.loads(self.program("stats", path, *options, "--plant", "--ground-area", "2", "--json"))
        model = graftal.load(path, steps=4)
        measures = model.measures(ground_area=2, irradiance=True, samples=16)
        organs = measures["light"].pop("organs")
        self.assertEqual(measures, printed)
        self.assertEqual(measures["strahler"][0]["streams"], measures["tips"])
        self.program("export", path, *options, "-q", "-o", self.path("a.csv"))
        rows = list(csv.DictReader(pathlib.Path(self.path("a.csv")).read_text().splitlines()))
        self.assertEqual(len(organs), len(rows))
        for key in ("irradiance", "irradiance_error", "absorbed", "sunlit"):
            written = [float(row[key]) if row[key] else math.nan for row in rows]
            np.testing.assert_allclose(organs[key], written, atol=1e-6)
        plant = model.plant()
        lit = ~np.isnan(organs["irradiance"]) & (plant["organ"] != "")  # without the sums of their parts
        area = plant["area"][lit]
        np.testing.assert_allclose((area * organs["absorbed"][lit]).sum(), measures["light"]["absorbed"], rtol=1e-5)
        with self.assertRaises(graftal.ModelError):
            graftal.load(scene("ifs/fern.rifs")).measures()
        with self.assertRaises(graftal.ModelError):
            model.export(self.path("a.obj"), irradiance=True)

    def test_points_are_those_of_the_program_to_the_bit(self):
        self.program("points", scene("ifs/fern.rifs"), "--points", "300000", "--seed", "7", "-q", "-o", self.path("a.ply"))
        data = pathlib.Path(self.path("a.ply")).read_bytes()
        record = np.dtype([("place", "<f4", 3), ("rgb", "u1", 3)])
        written = np.frombuffer(data[data.index(b"end_header\n") + 11 :], record)
        places, colours = graftal.load(scene("ifs/fern.rifs"), seed=7).points(300_000)
        np.testing.assert_array_equal(places, written["place"])
        np.testing.assert_array_equal(colours, written["rgb"])

    def test_the_graph_unfolds_to_what_stats_count(self):
        for name, steps in (("ifs/menger_sponge.rifs", None), ("abop/fig1_25.lsys", 4), ("abop/fig1_27.lsys", 5)):
            model = graftal.load(scene(name), steps=steps)
            graph, stats = model.graph, model.stats()
            self.assertEqual(graph.parent_from_child.shape, (len(graph.parents), 3, 4))
            self.assertEqual(len(graph.objects), len(graph.primitives))
            if name.endswith(".lsys"):
                leaves = [None] * len(graph.objects)

                def count(o):
                    if leaves[o] is None:
                        below = graph.children[graph.parents == o]
                        leaves[o] = 1 if graph.primitives[o] else sum(count(int(c)) for c in below)
                    return leaves[o]

                self.assertEqual(count(graph.root), stats["primitives"])
            else:
                scales = np.abs(np.linalg.det(graph.parent_from_child[graph.parents == graph.children][:, :, :3]))
                np.testing.assert_allclose(scales, 1 / 27)
                self.assertEqual(len(scales), 20)

    def test_faults_carry_their_place(self):
        with self.assertRaises(graftal.ModelError) as caught:
            graftal.rifs("rifs x {\n  map a { scal 0.5 }\n}\n").stats()
        message = caught.exception.messages[0]
        self.assertEqual((message.severity, message.line, message.column), ("error", 2, 11))
        self.assertIn("scale", message.text + message.hint)
        with self.assertRaises(graftal.ModelError):
            graftal.load(self.path("none.rifs")).render()
        for wrong in (lambda m: m.render((0, 9)), lambda m: m.render(quality="fine"), lambda m: m.export("a.png", engine="x")):
            with self.assertRaises(ValueError):
                wrong(graftal.load(scene("ifs/fern.rifs")))

    def without_remarks(self, name):
        """A file without what names the command that has written it."""
        data = pathlib.Path(self.path(name)).read_bytes()
        if name.endswith(".glb"):
            text = 20 + int.from_bytes(data[12:16], "little")
            return {**json.loads(data[20:text]), "asset": None}, data[text:]
        if name.endswith(".stl"):
            return data[80:]
        return [line for line in data.split(b"\n") if not line.startswith(b"#")]

    def test_files_for_other_programs_are_those_of_the_program(self):
        for name, words, settings in (("a.glb", ["--nodes", "50"], {"nodes": 50}), ("a.usda", ["--levels", "4"], {"levels": 4}),
                                      ("a.stl", ["--unit", "2mm"], {"unit_mm": 2}), ("a.obj", [], {})):
            self.program("export", scene("abop/fig1_24f.lsys"), "--steps", "3", "--size", "1280x720", *words, "-q", "-o",
                         self.path(name))
            written = self.without_remarks(name)
            os.remove(self.path(name))
            graftal.load(scene("abop/fig1_24f.lsys"), steps=3).export(self.path(name), **settings)
            self.assertEqual(self.without_remarks(name), written, name)
        with self.assertRaisesRegex(graftal.ModelError, "levels is for .usda, not for .ply"):
            graftal.load(scene("ifs/fern.rifs")).export(self.path("a.ply"), levels=3)

    def test_models_of_other_programs_are_read(self):
        koch = pathlib.Path(self.path("curves.l"))
        koch.write_text("Koch { ; of Fractint\n  angle 6\n  axiom f\n  f=f+f--f+f\n}\n")
        printed = self.printed_stats(f"{koch}:Koch", "--steps", "4")
        self.assertEqual(graftal.load(f"{koch}:Koch", steps=4).stats(), printed)

    def test_a_let_a_depth_and_a_text_change_the_picture(self):
        text = "let k = 0.5\nrifs x { map a { scale k } map b { scale 0.4 translate <1, 0, 0> } terminal sphere }"
        model = graftal.rifs(text, steps=3)
        first = model.render((64, 36), "draft")
        self.assertFalse(np.array_equal(first, model.set(k=0.3).render((64, 36), "draft")))
        self.assertTrue(np.array_equal(first, model.set(k=0.5).render((64, 36), "draft")))
        model.edit(text.replace("sphere", "cube"))
        self.assertFalse(np.array_equal(first, model.render((64, 36), "draft")))

    def test_export_writes_pictures_and_scenes(self):
        model = graftal.load(scene("hart/pound_sign.rifs"), steps=2)
        for name in ("a.png", "a.exr", "a.pov", "a.inc"):
            model.export(self.path(name), (32, 18), "draft")
            self.assertGreater(os.path.getsize(self.path(name)), 100)
        with self.assertRaises(graftal.ModelError):
            model.export(self.path("a.txt"))
        self.assertTrue(model._repr_png_().startswith(b"\x89PNG"))

    def test_progress_is_told_cancelled_and_may_raise(self):
        seen = []
        model = graftal.load(scene("ifs/menger_sponge.rifs"))
        model.render((64, 36), "draft", progress=lambda stage, share: seen.append((stage, share)))
        self.assertIn("draw", {stage for stage, share in seen})

        def cancel(stage, share):
            model.cancel()

        with self.assertRaises(graftal.Cancelled):
            model.render((64, 36), "normal", progress=cancel)

        def fail(stage, share):
            raise KeyError("mine")

        with self.assertRaises(KeyError):
            model.render((64, 36), "best", progress=fail)
        model.render((32, 18), "draft")

    def test_threads_draw_side_by_side(self):
        alone = graftal.load(scene("ifs/fern.rifs")).render((64, 36), "draft")
        drawn = []
        threads = [
            threading.Thread(target=lambda: drawn.append(graftal.load(scene("ifs/fern.rifs")).render((64, 36), "draft")))
            for _ in range(4)
        ]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(drawn), 4)
        for picture in drawn:
            np.testing.assert_array_equal(picture, alone)

    def test_calls_leave_no_memory_behind(self):
        calls = int(os.environ.get("GRAFTAL_CALLS", "3000"))
        model = graftal.load(scene("hart/pound_sign.rifs"), steps=2)

        def call():
            model.camera((1, 2, 5), (0, 0, 0)).set(steps=2)
            model.stats()
            model.graph
            try:
                graftal.rifs("rifs").stats()
            except graftal.ModelError:
                pass

        for _ in range(500):
            call()
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        for _ in range(calls):
            call()
        grown_kib = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
        self.assertLess(grown_kib, 2048)


class Notebook(unittest.TestCase):
    def test_its_cells_run(self):
        notebook = json.loads(pathlib.Path(SOURCE, "docs", "python.ipynb").read_text())
        names = {}
        old = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.symlink(os.path.join(SOURCE, "scenes"), os.path.join(folder, "scenes"))
            os.chdir(folder)
            try:
                for cell in notebook["cells"]:
                    if cell["cell_type"] == "code":
                        exec("".join(cell["source"]), names)
            finally:
                os.chdir(old)
        self.assertGreater(sum(cell["cell_type"] == "code" for cell in notebook["cells"]), 4)


if __name__ == "__main__":
    unittest.main()
