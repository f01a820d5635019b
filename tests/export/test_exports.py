"""What readers of our own find in exported files: strict ones of USD, pbrt and Mitsuba (tools/bench/exports_parts), and
small ones of glTF and SVG. A file must mean every leaf, or every triangle, and no more."""
import json
import os
import struct
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

SOURCE = Path(os.environ['GRAFTAL_SOURCE'])
PROGRAM = os.environ['GRAFTAL_PROGRAM']
sys.dont_write_bytecode = True
sys.path.insert(0, str(SOURCE / 'tools/bench/exports_parts'))
import meshes  # noqa: E402
import renderers  # noqa: E402
import usd  # noqa: E402

# Deep, bracketed, tinted and textured ones, cards and files of triangles.
MODELS = [('hart/sierpinski.inst', ['--steps', '5']), ('abop/fig1_24f.lsys', []), ('abop/fig1_25.lsys', []),
          ('hart/pound_sign.rifs', ['--steps', '3']), ('shapes/shapes.inst', []),
          ('ifs/fern.rifs', ['--steps', '4']), ('plants/maple_leaf_card.inst', [])]
# In USD 1284 leaves of 4 triangles are a mesh each.
UNITED = {'abop/fig1_25.lsys': 1284 * 3}
# Those whose files are texts that Python reads slowly, or whose edges it counts, are young.
RENDERED = [('hart/sierpinski.inst', ['--steps', '3']), ('abop/fig1_24f.lsys', ['--steps', '3']), ('hart/pound_sign.rifs', ['--steps', '2'])]
SOLIDS = [('ifs/menger_sponge.rifs', ['--steps', '2']), ('abop/fig1_24f.lsys', ['--steps', '4']), ('hart/pound_sign.rifs', ['--steps', '3']),
          ('hart/ternary_tree.inst', ['--error', '24']), ('hart/elm.inst', ['--error', '96'])]


def glb_parts(path):
    data = Path(path).read_bytes()
    magic, version, length = struct.unpack_from('<4sII', data)
    assert (magic, version, length) == (b'glTF', 2, len(data))
    size, kind = struct.unpack_from('<I4s', data, 12)
    assert kind == b'JSON'
    rest = data[20 + size:]
    return json.loads(data[20:20 + size]), rest[8:8 + struct.unpack_from('<I', rest)[0]] if rest else b''


class Exports(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def graftal(self, *words):
        return subprocess.run([PROGRAM, *map(str, words)], cwd=self.folder, capture_output=True, text=True, timeout=120)

    def export(self, model, words, name, *more):
        done = self.graftal('export', SOURCE / 'scenes' / model, '-o', name, '--size', '240x180', *words, *more)
        self.assertEqual(done.returncode, 0, done.stderr)
        return self.folder / name

    known = {}  # of all tests: several ask the same

    def leaves(self, model, words):
        key = ('leaves', model, *words)
        if key not in self.known:
            self.known[key] = json.loads(self.graftal('stats', SOURCE / 'scenes' / model, *words, '--json').stdout)['primitives']
        return self.known[key]

    def triangles(self, model, words):
        """What the head of a flat file says; test_flat_files_agree reads such files whole."""
        key = ('triangles', model, *words)
        if key not in self.known:
            head = self.export(model, words, 'all.ply').read_bytes().split(b'end_header')[0]
            self.known[key] = int(head.split(b'element face ')[1].split()[0])
        return self.known[key]

    def test_usd_means_every_leaf(self):
        for model, words in MODELS + [('hart/pound_sign.rifs', ['--steps', '36'])]:
            with self.subTest(model):
                path = self.export(model, words, 'm.usda')
                found, _ = usd.Stage(path.read_text()).meshes('/model')
                self.assertEqual(str(found), str(int(self.leaves(model, words)) - UNITED.get(model, 0)))
        # 3e30 leaves.
        self.assertEqual(len(str(found)), 31)
        self.assertLess(path.stat().st_size, 1_000_000)

    def test_usd_keeps_to_its_levels(self):
        for model, words in MODELS[:2]:
            for levels in (2, 4, 7):
                with self.subTest(model, levels=levels):
                    stage = usd.Stage(self.export(model, words, 'm.usda', '--levels', levels).read_text())
                    found, deep = stage.meshes('/model')
                    self.assertEqual(str(found), str(self.leaves(model, words)))
                    self.assertLessEqual(deep, levels)

    def test_the_strict_reader_is_strict(self):
        text = self.export('abop/fig1_24f.lsys', [], 'm.usda').read_text()
        usd.Stage(text)
        for before, after in (('#usda 1.0', '#usda 2.0'), ('instanceable = true', 'instanceable = maybe'),
                              ('references = </prototypes/', 'references = </prototype/'), ('matrix4d', 'matrix5d'),
                              ('int[] faceVertexCounts = [3, ', 'int[] faceVertexCounts = [4, '), ('}\n', '\n')):
            self.assertIn(before, text)
            with self.assertRaises(usd.Fault, msg=after):
                stage = usd.Stage(text.replace(before, after, 1))
                stage.meshes('/model')

    def test_renderers_get_every_triangle(self):
        for model, words in RENDERED:
            for name in ('m.pbrt', 'm.xml'):
                with self.subTest(model, name=name):
                    found = renderers.read(self.export(model, words, name))
                    flat = self.triangles(model, words)
                    # Triangles that are nothing in 32 bits are left out of shared meshes.
                    self.assertLessEqual(found['triangles'], flat)
                    self.assertGreaterEqual(found['triangles'], 0.99 * flat)

    def test_gltf_nodes_mean_every_triangle(self):
        for model, words in MODELS:
            for more in ([], ['--nodes', '3'], ['--instancing']):
                with self.subTest(model, more=more):
                    document, data = glb_parts(self.export(model, words, 'm.glb', *more))
                    found = self.gltf_triangles(document, data)
                    flat = self.triangles(model, words)
                    self.assertLessEqual(found, flat)
                    self.assertGreaterEqual(found, 0.99 * flat)

    def gltf_triangles(self, document, data):
        sizes = {5121: 1, 5123: 2, 5125: 4, 5126: 4}
        width = {'SCALAR': 1, 'VEC2': 2, 'VEC3': 3, 'VEC4': 4}
        for accessor in document['accessors']:
            view = document['bufferViews'][accessor['bufferView']]
            bytes_of = accessor['count'] * sizes[accessor['componentType']] * width[accessor['type']]
            self.assertLessEqual(view.get('byteOffset', 0) + bytes_of, len(data))
            self.assertEqual(view['byteLength'], bytes_of)
        of_mesh = [sum(document['accessors'][part['indices']]['count'] // 3 for part in mesh['primitives'])
                   for mesh in document['meshes']]
        parents = {}
        for number, node in enumerate(document['nodes']):
            for child in node.get('children', []):
                self.assertNotIn(child, parents)
                parents[child] = number
        total = 0
        waiting = list(document['scenes'][0]['nodes'])
        while waiting:
            node = document['nodes'][waiting.pop()]
            waiting += node.get('children', [])
            if 'mesh' in node:
                table = node.get('extensions', {}).get('EXT_mesh_gpu_instancing')
                times = document['accessors'][table['attributes']['TRANSLATION']]['count'] if table else 1
                total += times * of_mesh[node['mesh']]
        return total

    def test_svg_uses_every_leaf(self):
        for model, words in [('abop/fig1_24a.lsys', []), ('hart/pound_sign_2d.rifs', ['--steps', '3']),
                             ('ifs/koch_curve.rifs', ['--steps', '4']), ('hart/sierpinski.inst', ['--steps', '5'])]:
            with self.subTest(model):
                root = ElementTree.parse(self.export(model, words, 'm.svg')).getroot()
                by_id = {element.get('id'): element for element in root.iter() if element.get('id')}
                known = {}

                def drawn(element):
                    """Shapes that it draws. Symbols stand after what uses them, so that this goes no deeper than they."""
                    tag = element.tag.split('}')[1]
                    if tag in ('path', 'circle', 'polygon'):
                        return 1
                    if tag == 'use':
                        name = element.get('href')[1:]
                        if name not in known:
                            known[name] = drawn(by_id[name])
                        return known[name]
                    return sum(drawn(child) for child in element) if tag != 'defs' else 0

                self.assertEqual(str(drawn(root)), str(self.leaves(model, words)))

    def test_a_plotter_draws_each_line_once(self):
        path = self.export('abop/fig1_24a.lsys', [], 'm.svg', '--plotter', '--unit', '3mm')
        root = ElementTree.parse(path).getroot()
        self.assertTrue(root.get('width').endswith('mm'))
        segments = set()
        for line in root.iter('{http://www.w3.org/2000/svg}path'):
            points = [tuple(round(float(number), 3) for number in point.split(',')) for point in line.get('d')[1:].split()]
            for a, b in zip(points, points[1:]):
                self.assertNotIn((min(a, b), max(a, b)), segments)
                segments.add((min(a, b), max(a, b)))
        self.assertGreater(len(segments), 1000)

    def test_solids_for_printers_are_watertight(self):
        for model, words in SOLIDS:
            with self.subTest(model):
                triangles = meshes.triangles_of(self.export(model, words, 'm.stl'))
                self.assertGreater(len(triangles), 100)
                self.assertEqual(meshes.open_edges(triangles), 0)
                self.assertGreater(meshes.volume(triangles), 0)

    def test_flat_files_agree(self):
        for model, words in MODELS:
            with self.subTest(model):
                found = [meshes.triangles_of(self.export(model, words, f'm.{kind}')) for kind in ('ply', 'obj', 'stl')]
                areas, volumes = [meshes.area(each) for each in found], [meshes.volume(each) for each in found]
                for area, volume in zip(areas, volumes):
                    self.assertAlmostEqual(area / areas[0], 1, 4)
                    self.assertLess(abs(volume - volumes[0]), 1e-4 * areas[0] ** 1.5)

    def test_threads_do_not_tell(self):
        for name in ('m.usda', 'm.glb', 'm.xml'):
            first = self.export('hart/elm.inst', ['--error', '16'], name, '--threads', '1').read_bytes()
            self.assertTrue(first == self.export('hart/elm.inst', ['--error', '16'], name, '--threads', '3').read_bytes())


if __name__ == '__main__':
    unittest.main()
