"""Imports the .ply of `clerestory bake` into Blender with all its numbers, as attributes of points: illuminance [lx],
irradiance_0.. [W/m2] (float) and light (linear colour). Blender 3.4 itself keeps the colours alone.

In Blender: Scripting, open this file, set FILE, run it. From a shell: blender --python import_light.py -- room.ply
"""
import os
import sys

import bpy
import numpy

FILE = ""


def import_light(file):
    with open(file, "rb") as ply:
        fields, count, origin, line = [], {}, None, b""
        while line != b"end_header\n":
            line = ply.readline()
            words = line.decode().split()
            if words[:1] == ["element"]:
                count[words[1]] = int(words[2])
            elif words[:2] in (["property", "float"], ["property", "uchar"]):
                fields.append((words[2], "<f4" if words[1] == "float" else "u1"))
            elif words[:2] == ["comment", "origin"]:
                origin = [float(x) for x in words[2:]]
        points = numpy.frombuffer(ply.read(count["vertex"] * numpy.dtype(fields).itemsize), fields)
        faces = numpy.frombuffer(ply.read(), [("n", "u1"), ("corners", "<i4", 3)])["corners"]

    name = os.path.splitext(os.path.basename(file))[0]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(numpy.stack([points[k] for k in "xyz"], axis=1).tolist(), [], faces.tolist())
    for field, kind in fields:
        if field == "illuminance" or field.startswith("irradiance_"):
            mesh.attributes.new(field, "FLOAT", "POINT").data.foreach_set("value", points[field].copy())
    srgb = numpy.stack([points[k] for k in ("red", "green", "blue")], axis=1) / 255
    linear = numpy.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    colour = numpy.column_stack([linear, numpy.ones(len(linear))]).astype("<f4")
    mesh.color_attributes.new("light", "FLOAT_COLOR", "POINT").data.foreach_set("color", colour.ravel())
    thing = bpy.data.objects.new(name, mesh)
    if origin:
        thing["origin"] = origin
    bpy.context.collection.objects.link(thing)
    return thing


if __name__ == "__main__":
    arguments = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    for ply_file in arguments or [FILE]:
        import_light(ply_file)
