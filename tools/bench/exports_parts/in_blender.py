"""In Blender's Python: imports a file, and says how large it is and how its outline differs from a picture's.

  blender -b --factory-startup --python in_blender.py -- FILE [--camera GLTF --picture ALPHA --draw PNG]

The outline is that of Cycles with one sample in the middle of each pixel; the picture's is its alpha channel, taken out as grey. Prints one
line of JSON behind 'MEASURED '."""
import argparse
import json
import math
import resource
import sys
import time
from pathlib import Path

import bmesh
import bpy
import mathutils
import numpy

# The glTF importer of Debian 12's Blender asks for a name that its numpy has no more.
numpy.bool = bool
TURN = mathutils.Matrix.Rotation(math.pi / 2, 4, 'X')  # y up -> z up


def imported(path):
    kind = Path(path).suffix
    if kind in ('.glb', '.gltf'):
        bpy.ops.import_scene.gltf(filepath=path)
    elif kind == '.obj':
        bpy.ops.wm.obj_import(filepath=path)
    elif kind == '.ply':
        bpy.ops.import_mesh.ply(filepath=path)
        for thing in bpy.context.selected_objects:
            thing.matrix_world = TURN @ thing.matrix_world
    elif kind == '.stl':
        bpy.ops.import_mesh.stl(filepath=path)
    else:
        sys.exit(f'{path}: no importer')


def measured():
    """Of all places: their triangles, area and volume."""
    triangles, area, volume, places = 0, 0.0, 0.0, 0
    known = {}
    for place in bpy.context.evaluated_depsgraph_get().object_instances:
        if place.object.type != 'MESH':
            continue
        places += 1
        linear = place.matrix_world.to_3x3()
        key = (place.object.data.name, tuple(tuple(row) for row in linear))
        if key not in known:
            mesh = bmesh.new()
            mesh.from_mesh(place.object.data)
            bmesh.ops.triangulate(mesh, faces=mesh.faces)
            mesh.transform(linear.to_4x4())
            known[key] = len(mesh.faces), sum(face.calc_area() for face in mesh.faces), mesh.calc_volume(signed=True)
            mesh.free()
        triangles, area, volume = (a + b for a, b in zip((triangles, area, volume), known[key]))
    return {'triangles': triangles, 'area': area, 'volume': volume, 'places': places}


def look(gltf, size):
    """Through the camera of a glTF text."""
    document = json.loads(Path(gltf).read_text())
    node = next(node for node in document['nodes'] if 'camera' in node)
    seen = document['cameras'][node['camera']]
    camera = bpy.data.objects.new('eye', bpy.data.cameras.new('eye'))
    x, y, z, w = node.get('rotation', [0, 0, 0, 1])
    camera.matrix_world = TURN @ (mathutils.Matrix.Translation(node.get('translation', [0, 0, 0])) @
                                  mathutils.Quaternion((w, x, y, z)).to_matrix().to_4x4())
    camera.data.sensor_fit = 'HORIZONTAL'
    if seen['type'] == 'perspective':
        lens = seen['perspective']
        camera.data.angle = 2 * math.atan(math.tan(lens['yfov'] / 2) * size[0] / size[1])
        camera.data.clip_start, camera.data.clip_end = lens['znear'] * 0.01, lens['zfar'] * 2
    else:
        camera.data.type = 'ORTHO'
        camera.data.ortho_scale = 2 * seen['orthographic']['xmag']
        camera.data.clip_start, camera.data.clip_end = 0, seen['orthographic']['zfar'] * 2
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera


def outline(options):
    """The share of pixels that differ."""
    picture = bpy.data.images.load(options.picture)
    size = tuple(picture.size)
    theirs = [grey >= 0.5 for grey in list(picture.pixels)[0::4]]  # the alpha, by itself
    look(options.camera, size)
    scene = bpy.context.scene
    scene.render.engine = 'CYCLES'
    scene.render.film_transparent = True
    scene.cycles.samples = 1
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = 'BOX', 0.01
    scene.cycles.max_bounces = 0
    scene.cycles.transparent_max_bounces = 8
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.render.threads_mode, scene.render.threads = 'FIXED', 1
    scene.render.image_settings.file_format = 'PNG'
    scene.render.image_settings.color_mode = 'RGBA'
    scene.render.filepath = options.draw
    bpy.ops.render.render(write_still=True)
    drawn = bpy.data.images.load(options.draw)
    ours = [alpha >= 0.5 for alpha in list(drawn.pixels)[3::4]]
    differ = sum(a != b for a, b in zip(ours, theirs))
    return {'pixels': len(ours), 'differ': differ, 'covered': sum(theirs), 'drawn': sum(ours)}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('file')
    parser.add_argument('--camera')
    parser.add_argument('--picture')
    parser.add_argument('--draw')
    parser.add_argument('--sizes', action='store_true')
    options = parser.parse_args(sys.argv[sys.argv.index('--') + 1:])
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    before = time.process_time()
    imported(options.file)
    said = {'seconds': time.process_time() - before}
    for thing in list(bpy.data.objects):
        if thing.type in ('LIGHT', 'CAMERA'):
            bpy.data.objects.remove(thing)
    said['objects'] = len(bpy.data.objects)
    if options.sizes:
        said.update(measured())
    if options.picture:
        said.update(outline(options))
    said['peak_MiB'] = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print('MEASURED ' + json.dumps(said))


main()
