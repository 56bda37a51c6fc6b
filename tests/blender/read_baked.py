"""Reads baked files in Blender: read_baked.py FOLDER, with NAME.glb and NAME.ply each.

GLB: objects named like surfaces, z up again, colours within half a step of 8 bits, which is all that Blender 3.4 keeps.
PLY, by data/blender/import_light.py: illuminance and irradiance within 1e-4.
"""
import glob
import json
import os
import struct
import sys

import bpy
import numpy

numpy.bool = bool  # Debian's Blender asks its numpy for a name that is gone
sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "..", "data", "blender"))
from import_light import import_light


def read_glb(file):
    """By node that has a mesh: positions, colours and illuminance of its primitives in turn, z up."""
    data = open(file, "rb").read()
    size = struct.unpack_from("<I", data, 12)[0]
    tree = json.loads(data[20:20 + size])
    binary = data[28 + size:]

    def numbers(index):
        accessor = tree["accessors"][index]
        view = tree["bufferViews"][accessor["bufferView"]]
        n = {"SCALAR": 1, "VEC3": 3}[accessor["type"]]
        return numpy.frombuffer(binary, "<f4", accessor["count"] * n, view["byteOffset"]).reshape(-1, n)

    nodes = {}
    for node in tree["nodes"]:
        if "mesh" in node:
            primitives = [p["attributes"] for p in tree["meshes"][node["mesh"]]["primitives"]]
            nodes[node["name"]] = [numpy.concatenate([numbers(p[a]) for p in primitives])
                                   for a in ("POSITION", "COLOR_0")]
    return nodes


def srgb(linear):
    return numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * numpy.power(linear, 1 / 2.4) - 0.055)


def check_glb(file):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=file)
    nodes = read_glb(file)
    meshes = {o.name: o.data for o in bpy.data.objects if o.type == "MESH"}
    assert set(meshes) == set(nodes), (set(meshes), set(nodes))
    for name, (position, colour) in nodes.items():
        mesh = meshes[name]
        n = len(mesh.vertices)
        assert n == len(position), (name, n, len(position))
        x = numpy.empty(3 * n, "f4")
        mesh.vertices.foreach_get("co", x)
        x = x.reshape(-1, 3)
        assert abs(x - numpy.stack([position[:, 0], -position[:, 2], position[:, 1]], axis=1)).max() < 1e-4, name
        corners = numpy.empty(len(mesh.loops), "i4")
        mesh.loops.foreach_get("vertex_index", corners)
        shown = numpy.empty(4 * len(mesh.loops), "f4")
        mesh.color_attributes[0].data.foreach_get("color", shown)  # linear, of 8 bits sRGB
        off = abs(srgb(shown.reshape(-1, 4)[:, :3]) - srgb(colour[corners]))
        assert off.max() < 0.55 / 255, (name, off.max() * 255)  # half a step, and what its table of sRGB errs
        assert "exposure" in mesh, name
    return sum(len(m.vertices) for m in meshes.values())


def check_ply(file):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    mesh = import_light(file).data
    data = open(file, "rb").read()
    head, _, body = data.partition(b"end_header\n")
    names = [w[2] for w in (line.split() for line in head.decode().split("\n")) if w[:2] == ["property", "float"]]
    n = len(mesh.vertices)
    row = 4 * len(names) + 3
    floats = [x for x in names if x.startswith("illuminance") or x.startswith("irradiance")]
    for name in floats:
        read = numpy.empty(n, "f4")
        mesh.attributes[name].data.foreach_get("value", read)
        at = 24 + 3 + 4 * (names.index(name) - 6)
        wanted = numpy.array([struct.unpack_from("<f", body, i * row + at)[0] for i in range(n)])
        assert abs(read - wanted).max() <= 1e-4 * abs(wanted).max(), name
    assert floats
    return n


files = sorted(glob.glob(os.path.join(sys.argv[-1], "*.glb")))
assert files, "nothing to read"
for glb in files:
    print(f"{os.path.basename(glb)}: Blender reads {check_glb(glb)} vertices, and "
          f"{check_ply(glb[:-4] + '.ply')} of the .ply")
