"""Draws docs/pictures/lightmaps.png in Blender: lightmaps.py LEFT.glb RIGHT.glb OUT.png, side by side."""
import math
import sys

import bpy
import mathutils
import numpy

numpy.bool = bool  # Debian's Blender asks its numpy for a name that is gone
SIZE = 360


def draw(glb, out):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=glb)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"  # needs no screen; unlit materials are seen as they are
    scene.cycles.samples, scene.cycles.max_bounces, scene.cycles.use_denoising = 64, 0, False
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.view_settings.view_transform = "Standard"
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.angle = math.radians(39)
    scene.collection.objects.link(camera)
    scene.camera = camera
    points = [o.matrix_world @ mathutils.Vector(c) for o in bpy.data.objects if o.type == "MESH" for c in o.bound_box]
    low, high = (mathutils.Vector(f(p[k] for p in points) for k in range(3)) for f in (min, max))
    middle = (low + high) / 2
    eye = mathutils.Vector((middle.x, high.y + 1.46 * (high.y - low.y), middle.z))
    camera.location, camera.rotation_euler = eye, (middle - eye).to_track_quat("-Z", "Y").to_euler()
    camera.data.clip_end = 1e6
    scene.render.filepath = out
    bpy.ops.render.render(write_still=True)


def pixels(file):
    image = bpy.data.images.load(file)
    return numpy.array(image.pixels[:]).reshape(SIZE, SIZE, 4)


left, right, out = sys.argv[-3:]
for k, glb in enumerate((left, right)):
    draw(glb, f"{out}.{k}.png")
both = numpy.concatenate([pixels(f"{out}.0.png"), numpy.ones((SIZE, 8, 4)), pixels(f"{out}.1.png")], axis=1)
picture = bpy.data.images.new("both", both.shape[1], SIZE)
picture.pixels = numpy.round(both * 63).ravel() / 63  # fewer colours, a smaller file
picture.filepath_raw, picture.file_format = out, "PNG"
picture.save()
