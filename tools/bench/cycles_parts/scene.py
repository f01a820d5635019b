"""Run by Blender: blender -b --python scene.py -- JOB.json. Builds the parts that `graftal print` has written, to a
depth, as one mesh or as instances of one, lights them, and renders them with Cycles at each number of samples. Prints a
line of JSON for the set-up and for each picture."""
import ctypes
import json
import math
import os
import re
import sys

import bpy
import mathutils
import numpy

JOB = json.load(open(sys.argv[sys.argv.index('--') + 1]))

# Of the cube [-1, 1]^3, of the tetrahedron in it, and of the triangle in the circle of radius 1: corners, and faces that
# look outwards.
PRIMITIVES = {
    'cube': ([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)],
             [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4),
              (1, 5, 7), (1, 7, 3)]),
    'tetrahedron': ([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)], [(0, 1, 2), (0, 2, 3), (0, 3, 1), (1, 3, 2)]),
    'triangle': ([(0, 1, 0), (-math.sqrt(3) / 2, -0.5, 0), (math.sqrt(3) / 2, -0.5, 0)], [(0, 1, 2)]),
}


def matrices(text):
    """Name -> ([(member, matrix)], (primitive, matrix) or None), and the last name, which is the root's."""
    objects = {}
    for name, body in re.findall(r'^(?:canonical )?object (\S+) \{\n(.*?)^\}', text, re.S | re.M):
        members, terminal = [], None
        for kind, names, rest in re.findall(r'^  (union|instance|terminal): ([^\n]+)\n((?:    [^\n]*\n)*)', body, re.M):
            found = re.search(r'matrix: ([^\n]+)', rest)
            matrix = numpy.identity(4)
            if found:
                matrix[:3] = numpy.array([float(x) for x in found[1].split(',')]).reshape(3, 4)
            pairs = [(member.strip(), matrix) for member in names.split(',')]
            if kind == 'terminal':
                terminal = pairs[0]
            else:
                members += pairs
        objects[name] = (members, terminal)
    return objects, name


def leaves(objects, name, depth, known):
    """Primitive -> matrices of all of its kind in an object so many levels down, (n, 4, 4)."""
    solid = name.rsplit('.', 1)[-1]  # tetra.tetrahedron is spelt out as four triangles, whose corners a mesh shares
    if solid in PRIMITIVES:
        return {solid: numpy.identity(4)[None]}
    if (name, depth) not in known:
        members, terminal = objects[name]
        found = {}
        for member, matrix in [terminal] if depth == 0 and terminal else members:
            for primitive, matrices_of_it in leaves(objects, member, depth - 1, known).items():
                found.setdefault(primitive, []).append(matrix @ matrices_of_it)
        known[name, depth] = {primitive: numpy.concatenate(lists) for primitive, lists in found.items()}
    return known[name, depth]


def places_of(objects, part, name):
    """Matrices of the instances of a part in an object."""
    if name == part:
        return [numpy.identity(4)]
    return [matrix @ place for member, matrix in objects[name][0] if member not in PRIMITIVES
            for place in places_of(objects, part, member)]


def mesh_of(transforms_of):
    points, triangles, begun = [], [], 0
    for primitive, transforms in transforms_of.items():
        corners, faces = (numpy.array(rows) for rows in PRIMITIVES[primitive])
        at = numpy.einsum('nij,kj->nki', transforms[:, :3, :3], corners) + transforms[:, None, :3, 3]
        points.append(at.astype(numpy.float32).reshape(-1, 3))
        numbers = begun + faces[None] + (len(corners) * numpy.arange(len(transforms)))[:, None, None]
        triangles.append(numbers.astype(numpy.int32).reshape(-1, 3))
        begun += len(points[-1])
    points, triangles = numpy.concatenate(points), numpy.concatenate(triangles)
    mesh = bpy.data.meshes.new('parts')
    mesh.vertices.add(len(points))
    mesh.vertices.foreach_set('co', points.ravel())
    mesh.loops.add(3 * len(triangles))
    mesh.loops.foreach_set('vertex_index', triangles.ravel())
    mesh.polygons.add(len(triangles))
    mesh.polygons.foreach_set('loop_start', 3 * numpy.arange(len(triangles), dtype=numpy.int32))
    mesh.polygons.foreach_set('loop_total', numpy.full(len(triangles), 3, dtype=numpy.int32))
    mesh.update()
    material = bpy.data.materials.new('matt')
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    diffuse, output = nodes.new('ShaderNodeBsdfDiffuse'), nodes.new('ShaderNodeOutputMaterial')
    diffuse.inputs['Color'].default_value = (*[JOB['albedo']] * 3, 1)
    material.node_tree.links.new(diffuse.outputs[0], output.inputs[0])
    mesh.materials.append(material)
    return mesh


def looking(location, target):
    back = (mathutils.Vector(location) - mathutils.Vector(target)).normalized()
    right = mathutils.Vector((0, 1, 0)).cross(back).normalized()
    up = back.cross(right)
    matrix = mathutils.Matrix((right, up, back)).transposed().to_4x4()
    matrix.translation = location
    return matrix


def place(name, data, matrix):
    thing = bpy.data.objects.new(name, data)
    thing.matrix_world = matrix
    bpy.context.collection.objects.link(thing)
    return thing


def build():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    objects, root = matrices(open(JOB['graph']).read())
    mesh = mesh_of(leaves(objects, JOB['part'], math.inf if JOB['depth'] is None else JOB['depth'], {}))
    places = places_of(objects, JOB['part'], root)
    for matrix in places:
        place('part', mesh, mathutils.Matrix(matrix.tolist()))
    scene = bpy.context.scene
    camera = bpy.data.cameras.new('camera')
    camera.sensor_fit, camera.angle = 'HORIZONTAL', math.radians(JOB['angle_deg'])
    camera.clip_end = 1e6
    scene.camera = place('camera', camera, looking(JOB['location'], JOB['look_at']))
    sun = bpy.data.lights.new('sun', 'SUN')
    sun.angle, sun.energy = math.radians(JOB['sun_angle_deg']), math.pi * JOB['sun_brightness']
    place('sun', sun, looking(JOB['sun'], (0, 0, 0)))
    world = bpy.data.worlds.new('sky')
    world.use_nodes = True
    world.node_tree.nodes['Background'].inputs['Color'].default_value = (*[JOB['sky']] * 3, 1)
    scene.world = world
    scene.render.engine = 'CYCLES'
    scene.render.resolution_x, scene.render.resolution_y = JOB['size']
    scene.render.image_settings.file_format = 'OPEN_EXR'
    scene.render.image_settings.color_depth = '32'
    scene.render.threads_mode, scene.render.threads = 'FIXED', 2
    cycles = scene.cycles
    cycles.device, cycles.use_denoising, cycles.use_adaptive_sampling = 'CPU', False, False
    cycles.max_bounces = cycles.diffuse_bounces = JOB['bounces']
    cycles.sample_clamp_indirect = cycles.sample_clamp_direct = 0
    cycles.light_sampling_threshold = 0
    scene.render.use_persistent_data = False
    return len(mesh.polygons), len(places)


def seconds():
    now = os.times()
    return now.user + now.system


def forget_peak():
    """The arrays of the set-up are no part of what Cycles needs."""
    ctypes.CDLL(None).malloc_trim(0)
    with open('/proc/self/clear_refs', 'w') as file:
        file.write('5')


def peak_mib():
    return int(re.search(r'VmHWM:\s+(\d+)', open('/proc/self/status').read())[1]) / 1024


triangles, instances = build()
forget_peak()
print('JSON', json.dumps({'triangles': triangles, 'instances': instances, 'seconds': seconds()}), flush=True)
for samples in JOB['samples']:
    scene = bpy.context.scene
    scene.cycles.samples = samples
    scene.render.filepath = f'{JOB["folder"]}/cycles_{samples}.exr'
    before = seconds()
    bpy.ops.render.render(write_still=True)
    print('JSON', json.dumps({'samples': samples, 'seconds': seconds() - before, 'mib': peak_mib()}), flush=True)
