"""tools/wheel packs the built Python module, without the libraries that it needs. GRAFTAL_BUILD and GRAFTAL_SOURCE name the
build and the project."""

import base64
import csv
import hashlib
import importlib.metadata
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile

SOURCE = pathlib.Path(os.environ["GRAFTAL_SOURCE"])
MODULE, = pathlib.Path(os.environ["GRAFTAL_BUILD"], "python/graftal").glob("_graftal.*.so")
NUMBER = re.search(r"cpython-(\d+)", MODULE.name)[1]


class Wheel(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.tree = self.folder / "tree"
        shutil.copytree(SOURCE / "runtime/python/graftal", self.tree / "graftal", ignore=shutil.ignore_patterns("__pycache__"))
        shutil.copy(MODULE, self.tree / "graftal")

    def packed(self, name, **environment):
        (self.folder / name).mkdir()
        environment = {**os.environ, "SOURCE_DATE_EPOCH": "1700000001", **environment}
        printed = subprocess.run([SOURCE / "tools/wheel", self.tree, "1.2.3", self.folder / name], check=True, text=True,
                                 capture_output=True, env=environment).stdout
        return pathlib.Path(printed.strip())

    def test_the_record_has_every_file_and_its_digest(self):
        with zipfile.ZipFile(self.packed("wheel")) as wheel:
            self.assertIsNone(wheel.testzip())
            rows = {name: (digest, size) for name, digest, size in
                    csv.reader(wheel.read("graftal-1.2.3.dist-info/RECORD").decode().splitlines())}
            self.assertEqual(list(rows), wheel.namelist())
            self.assertEqual(rows.popitem(), ("graftal-1.2.3.dist-info/RECORD", ("", "")))
            for name, (digest, size) in rows.items():
                data = wheel.read(name)
                self.assertEqual(int(size), len(data), name)
                sha256 = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).decode().rstrip("=")
                self.assertEqual(digest, f"sha256={sha256}", name)
            for file in ("__init__.py", "_graftal.pyi", "py.typed", MODULE.name):
                self.assertIn(f"graftal/{file}", rows)
            self.assertEqual(wheel.read("graftal-1.2.3.dist-info/licenses/LICENSE"), (SOURCE / "LICENSE").read_bytes())

    def test_the_bytes_depend_on_no_clock(self):
        first = self.packed("first")
        for path in self.tree.rglob("*"):
            os.utime(path, (2_000_000_000, 2_000_000_000))
        second = self.packed("second", TZ="Asia/Tokyo")
        self.assertEqual(first.read_bytes(), second.read_bytes())
        with zipfile.ZipFile(first) as wheel:
            self.assertEqual({entry.date_time for entry in wheel.infolist()}, {(2023, 11, 14, 22, 13, 20)})

    def test_the_tag_has_the_newest_glibc_of_the_module(self):
        said = subprocess.run(["readelf", "-VW", MODULE], check=True, capture_output=True, text=True).stdout
        glibc = max(int(minor) for minor in re.findall(r"Name: GLIBC_2\.(\d+)", said))
        tag = re.fullmatch(rf"graftal-1\.2\.3-cp{NUMBER}-cp{NUMBER}-manylinux_2_(\d+)_{os.uname().machine}\.whl",
                           self.packed("module").name)
        self.assertGreaterEqual(int(tag[1]), glibc)

    def test_the_tag_names_the_oldest_system_with_all_symbols(self):
        objdump = self.folder / "objdump"
        for case, (needs, minor) in enumerate((
                ("GLIBC_2.2.5 GLIBC_2.9 GLIBCXX_3.4 CXXABI_1.3.9 CXXABI_TM_1 GCC_3.3.1", 24), ("GLIBC_2.4", 17),
                ("GLIBC_2.34 GLIBCXX_3.4.30", 35), ("GLIBC_2.36 GLIBCXX_3.4.30", 36), ("GLIBC_2.17 GLIBC_ABI_DT_RELR", 36),
                ("GLIBC_2.2.5 GLIBCXX_3.4.31", 39), ("GLIBC_2.2.5 CXXABI_1.3.14", 39), ("GLIBC_2.2.5 GCC_12.0.0", 35),
                ("GLIBC_2.42", 42), ("GLIBC_2.2.5 GLIBC_PRIVATE", None), ("GLIBC_2.2.5 GLIBCXX_3.4.999", None))):
            lines = "".join(f"    0x0b792650 0x00 08 {need}\n" for need in needs.split())
            objdump.write_text(f"#!/bin/sh\ncat <<END\nVersion References:\n  required from libc.so.6:\n{lines}END\n")
            objdump.chmod(0o755)
            path = {"PATH": f"{self.folder}:{os.environ['PATH']}"}
            with self.subTest(needs):
                if minor:
                    self.assertIn(f"-manylinux_2_{minor}_", self.packed(f"case_{case}", **path).name)
                else:
                    with self.assertRaises(subprocess.CalledProcessError):
                        self.packed(f"case_{case}", **path)

    def test_pip_installs_it(self):
        if not importlib.util.find_spec("pip"):
            self.skipTest("this Python has no pip")
        there = self.folder / "there"
        subprocess.run([sys.executable, "-m", "pip", "install", "-q", "--no-deps", "--no-index", "--target", there,
                        self.packed("wheel")], check=True, capture_output=True)
        metadata, = (found.metadata for found in importlib.metadata.distributions(name="graftal", path=[str(there)]))
        self.assertEqual((metadata["Name"], metadata["Version"]), ("graftal", "1.2.3"))
        self.assertRegex(metadata["Requires-Dist"], "^numpy")
        self.assertEqual(metadata["Requires-Python"], f"=={NUMBER[0]}.{NUMBER[1:]}.*")
        self.assertEqual((there / "graftal" / MODULE.name).read_bytes(), MODULE.read_bytes())


if __name__ == "__main__":
    unittest.main()
