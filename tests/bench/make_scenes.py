#!/usr/bin/env python3
"""Writes the scenes of hierarchy_bench.sh: OBJ and scene JSON, and random points on their lit surfaces.

  make_scenes.py FOLDER [SCENE ...]     all scenes that fit in seconds when none is named; --list names them

SCENE.json   the scene; lengths in metres but for room_cornell_mm
SCENE.csv    x,y,z,nx,ny,nz: 2,000 points, uniform over the area that light can reach, lifted by 4e-5 of the room's size
SCENE.info   JSON: what compare.py and path_reference need to know besides

Standard library only; the same files on every run.
"""
import bisect
import json
import math
import os
import random
import sys

POINTS = 2000


# ---- small vectors ---------------------------------------------------------------------------------------------------
def add(a, b): return (a[0] + b[0], a[1] + b[1], a[2] + b[2])
def sub(a, b): return (a[0] - b[0], a[1] - b[1], a[2] - b[2])
def mul(a, s): return (a[0] * s, a[1] * s, a[2] * s)
def dot(a, b): return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
def cross(a, b): return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
def unit(a): return mul(a, 1 / math.sqrt(dot(a, a)))


class Model:
    """Parallelograms and triangles with materials; solids to keep sample points out of what is covered."""

    def __init__(self, size):
        self.size = size        # of a room [m]
        self.faces = []         # (material, corners, sampled)
        self.solids = []        # (origin, u, v, w): boxes that light cannot enter

    def quad(self, material, o, u, v, sampled=True):
        """Front is where u x v points."""
        self.faces.append((material, (o, add(o, u), add(add(o, u), v), add(o, v)), sampled))

    def triangle(self, material, a, b, c, sampled=True):
        self.faces.append((material, (a, b, c), sampled))

    def room(self, lower, upper, floor="floor", wall="wall", ceiling="ceiling", sampled=True):
        """Seen from inside."""
        (x, y, z), (X, Y, Z) = lower, upper
        a, b, h = (X - x, 0, 0), (0, Y - y, 0), (0, 0, Z - z)
        self.quad(floor, lower, a, b, sampled)
        self.quad(ceiling, (x, y, Z), b, a, sampled)
        self.quad(wall, (x, y, z), h, a, sampled)
        self.quad(wall, (x, Y, z), a, h, sampled)
        self.quad(wall, (x, y, z), b, h, sampled)
        self.quad(wall, (X, y, z), h, b, sampled)

    def box(self, material, o, u, v, w, bottom=None, bottom_sampled=False, top=None):
        """A solid seen from outside, u x v along w; bottom and top may be of another material."""
        self.solids.append((o, u, v, w))
        self.quad(bottom or material, o, v, u, bottom_sampled)
        self.quad(top or material, add(o, w), u, v)
        self.quad(material, o, u, w)
        self.quad(material, add(o, v), w, u)
        self.quad(material, o, w, v)
        self.quad(material, add(o, u), v, w)

    def is_inside_a_solid(self, p):
        for o, u, v, w in self.solids:
            d = sub(p, o)
            if all(-1e-9 < dot(d, e) / dot(e, e) < 1 + 1e-9 for e in (u, v, w)):
                return True
        return False

    def points(self, count, seed=1, accept=lambda p: True):
        rng = random.Random(seed)
        lift = 4e-5 * self.size
        sampled = [c for _, c, s in self.faces if s]
        total, cumulative = 0.0, []
        for c in sampled:
            n = cross(sub(c[1], c[0]), sub(c[-1], c[0]))
            total += math.sqrt(dot(n, n)) / (1 if len(c) == 4 else 2)
            cumulative.append(total)
        result = []
        while len(result) < count:
            c = sampled[min(bisect.bisect(cumulative, rng.random() * total), len(sampled) - 1)]
            a, b = rng.random(), rng.random()
            u, v = sub(c[1], c[0]), sub(c[-1], c[0])
            if len(c) == 3 and a + b > 1:
                a, b = 1 - a, 1 - b
            n = unit(cross(u, v))
            p = add(add(add(c[0], mul(u, a)), mul(v, b)), mul(n, lift))
            if accept(p) and not self.is_inside_a_solid(p):
                result.append((p, n))
        return result

    def write_obj(self, path, scale=1.0):
        with open(path, "w") as out:
            number, last = 0, None
            for material, corners, _ in self.faces:
                if material != last:
                    out.write(f"usemtl {material}\n")
                    last = material
                for c in corners:
                    out.write("v %.9g %.9g %.9g\n" % (c[0] * scale, c[1] * scale, c[2] * scale))
                out.write("f " + " ".join(str(number + k + 1) for k in range(len(corners))) + "\n")
                number += len(corners)


GREY = {"floor": {"reflectance": 0.5}, "wall": {"reflectance": 0.7}, "ceiling": {"reflectance": 0.8},
        "block": {"reflectance": 0.6}, "body": {"reflectance": 0.5},
        "lamp": {"reflectance": 0.5, "exitance": 100, "sides": 1}}  # one-sided: the body is dark inside


def write_scene(folder, name, model, scene, points=None, info=None, unit_name="m"):
    scene = dict(scene)
    used = {material for material, _, _ in model.faces}
    scene["materials"] = {name: m for name, m in scene["materials"].items() if name in used}
    scene["geometry"] = [{"file": name + ".obj", "unit": unit_name, "up": "z"}]
    model.write_obj(os.path.join(folder, name + ".obj"), {"m": 1, "mm": 1000}[unit_name])
    with open(os.path.join(folder, name + ".json"), "w") as out:
        json.dump(scene, out, indent=1)
    if points is None:
        points = model.points(POINTS)
    with open(os.path.join(folder, name + ".csv"), "w") as out:
        out.write("x,y,z,nx,ny,nz\n")
        for p, n in points:
            out.write("%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n" % (p + n))
    with open(os.path.join(folder, name + ".info"), "w") as out:
        json.dump(dict({"reference": name, "size": model.size}, **(info or {})), out, indent=1)


# ---- scenes ----------------------------------------------------------------------------------------------------------
ROOM = (5.5, 4.5, 2.8)


def room_with_blocks(lamp=None):
    """Two turned blocks on the floor; `lamp(model)` adds the light."""
    m = Model(5.5)
    m.room((0, 0, 0), ROOM)
    m.box("block", (1.2, 1.0, 0), (0.955, 0.296, 0), (-0.355, 1.146, 0), (0, 0, 1.9))
    m.box("block", (3.6, 2.3, 0), (1.221, -0.446, 0), (0.309, 0.845, 0), (0, 0, 0.8))
    if lamp:
        lamp(m)
    return m


def area_lamp(m):
    """0.6 x 0.6 m, glowing 12 mm under the ceiling, its body 6 mm thick."""
    m.box("body", (2.45, 1.95, 2.788), (0.6, 0, 0), (0, 0.6, 0), (0, 0, 0.006), bottom="lamp", bottom_sampled=True)


def room_lamp(folder):
    write_scene(folder, "room_lamp", room_with_blocks(area_lamp), {"materials": GREY})


def room_uplight(folder):
    def lamp(m):
        m.box("body", (2.6, 2.1, 2.35), (0.3, 0, 0), (0, 0.3, 0), (0, 0, 0.05), bottom_sampled=True, top="lamp")
    write_scene(folder, "room_uplight", room_with_blocks(lamp), {"materials": GREY})


def room_thread(folder):
    """A lamp 1 mm wide and 1 m long."""
    def lamp(m):
        m.box("body", (2.25, 2.2495, 2.788), (1, 0, 0), (0, 0.001, 0), (0, 0, 0.002), bottom="lamp",
              bottom_sampled=True)
    scene = {"materials": dict(GREY, lamp={"reflectance": 0.5, "exitance": 36000, "sides": 1})}
    write_scene(folder, "room_thread", room_with_blocks(lamp), scene)


def room_cornell_mm(folder):
    """Closed, coloured, in millimetres: 0.556 x 0.559 x 0.549 m."""
    m = Model(0.556)
    x, y, z = 0.556, 0.559, 0.549
    m.quad("white", (0, 0, 0), (x, 0, 0), (0, y, 0))
    m.quad("white", (0, 0, z), (0, y, 0), (x, 0, 0))
    m.quad("white", (0, 0, 0), (0, 0, z), (x, 0, 0))
    m.quad("white", (0, y, 0), (x, 0, 0), (0, 0, z))
    m.quad("red", (0, 0, 0), (0, y, 0), (0, 0, z))
    m.quad("green", (x, 0, 0), (0, 0, z), (0, y, 0))
    m.box("white", (0.130, 0.065, 0), (0.158, 0.049, 0), (-0.048, 0.160, 0), (0, 0, 0.165))
    m.box("white", (0.314, 0.297, 0), (0.158, -0.049, 0), (0.049, 0.159, 0), (0, 0, 0.330))
    m.box("body", (0.213, 0.227, z - 0.012), (0.130, 0, 0), (0, 0.105, 0), (0, 0, 0.006), bottom="lamp",
          bottom_sampled=True)
    materials = {"white": {"reflectance": [0.725, 0.71, 0.68]}, "red": {"reflectance": [0.63, 0.065, 0.05]},
                 "green": {"reflectance": [0.14, 0.45, 0.091]}, "body": {"reflectance": 0.5},
                 "lamp": {"reflectance": [0.78, 0.78, 0.78], "radiance": [17, 12, 4], "sides": 1}}
    write_scene(folder, "room_cornell_mm", m, {"materials": materials}, unit_name="mm")


def room_tray(folder):
    """A lamp without size in an open tray below the ceiling: the room has its light by reflection alone."""
    def lamp(m):
        x, y, z, w, d, h = 2.5, 2.0, 2.35, 0.4, 0.4, 0.25
        a, b, up = (w, 0, 0), (0, d, 0), (0, 0, h)
        m.quad("body", (x, y, z), a, b, False)
        for o, u in (((x, y, z), a), ((x, y + d, z), a), ((x, y, z), b), ((x + w, y, z), b)):
            m.quad("body", o, u, up, False)
    scene = {"materials": GREY,
             "luminaires": [{"type": "point", "position": [2.7, 2.2, 2.4], "luminous_flux": 3000}]}
    write_scene(folder, "room_tray", room_with_blocks(lamp), scene)


SPOT = """IESNA:LM-63-2002
[TEST] a beam of 3 degrees
TILT=NONE
1 1000 1 4 1 1 2 0 0 0 1 1 100
0 3 3.5 90
0
50000 50000 0 0
"""


def room_mirror(folder):
    """A narrow beam on a mirror, which turns it on to a wall."""
    def mirror(m):
        m.quad("mirror", (2.55, 2.1, 1.15), (0.3, 0, -0.3), (0, 0.3, 0), False)
    with open(os.path.join(folder, "spot.ies"), "w") as out:
        out.write(SPOT)
    scene = {"materials": dict(GREY, mirror={"type": "mirror", "reflectance": 0.9}),
             "luminaires": [{"file": "spot.ies", "position": [2.7, 2.25, 2.7], "aim": [0, 0, -1]}]}
    write_scene(folder, "room_mirror", room_with_blocks(mirror), scene)


def room_sunpatch(folder, name="room_sunpatch", hole=(3.6, 0.6, 4.1, 1.1), sky=None):
    """Closed but for a hole of 0.5 x 0.5 m in the ceiling; the sun falls on the floor between blocks and wall."""
    m = Model(5.5)
    w, d, h = ROOM
    sun = unit((0.35, 0.15, 1.0))
    m.quad("floor", (0, 0, 0), (w, 0, 0), (0, d, 0))
    for x0, y0, x1, y1 in ((0, 0, w, hole[1]), (0, hole[3], w, d), (0, hole[1], hole[0], hole[3]),
                           (hole[2], hole[1], w, hole[3])):
        m.quad("ceiling", (x0, y0, h), (0, y1 - y0, 0), (x1 - x0, 0, 0))
    m.quad("wall", (0, 0, 0), (0, 0, h), (w, 0, 0))
    m.quad("wall", (0, d, 0), (w, 0, 0), (0, 0, h))
    m.quad("wall", (0, 0, 0), (0, d, 0), (0, 0, h))
    m.quad("wall", (w, 0, 0), (0, 0, h), (0, d, 0))
    m.box("block", (1.2, 1.0, 0), (0.955, 0.296, 0), (-0.355, 1.146, 0), (0, 0, 1.9))
    m.box("block", (3.6, 2.3, 0), (1.221, -0.446, 0), (0.309, 0.845, 0), (0, 0, 0.8))
    # One-sided: the sun on the outside is nobody's business here.
    materials = {k: dict(v, sides=1) for k, v in GREY.items() if k not in ("lamp", "body")}
    dx, dy = -sun[0] / sun[2] * h, -sun[1] / sun[2] * h
    rim = 0.03  # penumbra: half the sun's 0.533 degrees over 3 m
    patch = [hole[0] + dx - rim, hole[1] + dy - rim, hole[2] + dx + rim, hole[3] + dy + rim, 0.0]
    scene = {"materials": materials, "sun": {"direction": list(sun), "normal_illuminance": 80000}}
    write_scene(folder, name, m, dict(scene, **({"sky": sky} if sky else {})), info={"sun_patch": patch})


def contacts(folder):
    """Where furniture stands: a table on four legs of 5 cm, a bed 10 cm above the floor, a bench, a cupboard 10 cm off the
    wall. Points within 2 cm of the legs, under bed and bench, and in the gap, a quarter each."""
    m = Model(4.0)
    m.room((0, 0, 0), (4.0, 3.2, 2.6))
    legs = [(x, y) for x in (1.6, 2.75) for y in (0.5, 1.15)]
    m.box("block", (1.6, 0.5, 0.70), (1.2, 0, 0), (0, 0.7, 0), (0, 0, 0.03), bottom_sampled=True)
    for x, y in legs:
        m.box("block", (x, y, 0), (0.05, 0, 0), (0, 0.05, 0), (0, 0, 0.70))
    bed, bench, cupboard = (0.05, 1.2, 0.9, 1.95), (1.9, 2.7, 1.3, 0.35), (3.5, 0.6, 0.4, 1.4)
    m.box("block", (bed[0], bed[1], 0.10), (bed[2], 0, 0), (0, bed[3], 0), (0, 0, 0.35), bottom_sampled=True)
    m.box("block", (bench[0], bench[1], 0.42), (bench[2], 0, 0), (0, bench[3], 0), (0, 0, 0.04), bottom_sampled=True)
    for x in (bench[0] + 0.1, bench[0] + bench[2] - 0.14):
        m.box("block", (x, bench[1], 0), (0.04, 0, 0), (0, bench[3], 0), (0, 0, 0.42))
    m.box("block", (cupboard[0], cupboard[1], 0), (cupboard[2], 0, 0), (0, cupboard[3], 0), (0, 0, 1.9))
    m.box("body", (1.7, 1.3, 2.588), (0.6, 0, 0), (0, 0.6, 0), (0, 0, 0.006), bottom="lamp", bottom_sampled=True)

    def places(faces, count, seed, accept=lambda p: True):
        part = Model(4.0)
        part.solids = m.solids
        for origin, u, v in faces:
            part.quad("", origin, u, v)
        return part.points(count, seed, accept)

    def under(x, y, w, d, z):
        return [((x, y, 0), (w, 0, 0), (0, d, 0)), ((x, y, z), (0, d, 0), (w, 0, 0))]

    at_legs = places([((x - 0.02, y - 0.02, 0), (0.09, 0, 0), (0, 0.09, 0)) for x, y in legs], 500, 1)
    x, y, d, h = cupboard[0] + cupboard[2], cupboard[1], cupboard[3], 1.9
    gap = [((x, y, 0), (0, d, 0), (0, 0, h)), ((4.0, y, 0), (0, 0, h), (0, d, 0))]
    write_scene(folder, "contacts", m, {"materials": GREY},
                at_legs + places(under(*bed, 0.10), 500, 2) + places(under(*bench, 0.42), 500, 3) + places(gap, 500, 4))


CELL = (3.0, 2.5, 2.6)


def office(name, window):
    """A daylit office 4 x 6 m; the sheet of its facade has a hole, window = (x, z, width, height). Points on all surfaces
    and, 500 of 1,500, on a plane 0.8 m above the floor."""
    def make(folder):
        m = Model(6)
        a, b, h = (4, 0, 0), (0, 6, 0), (0, 0, 3)
        m.quad("floor", (0, 0, 0), a, b)
        m.quad("ceiling", (0, 0, 3), b, a)
        m.quad("wall", (0, 6, 0), a, h)
        m.quad("wall", (0, 0, 0), b, h)
        m.quad("wall", (4, 0, 0), h, b)
        x, z, w, t = window
        m.quad("wall", (0, 0, 0), (0, 0, z), a)
        m.quad("wall", (0, 0, z + t), (0, 0, 3 - z - t), a)
        m.quad("wall", (0, 0, z), (0, 0, t), (x, 0, 0))
        m.quad("wall", (x + w, 0, z), (0, 0, t), (4 - x - w, 0, 0))
        m.box("block", (0.5, 1.2, 0.70), (0.8, 0, 0), (0, 1.6, 0), (0, 0, 0.04), bottom_sampled=True)
        m.box("block", (3.3, 3.5, 0), (0.6, 0, 0), (0, 1.5, 0), (0, 0, 1.8))
        plane = Model(6)
        plane.quad("floor", (0.01, 0.01, 0.8), (3.98, 0, 0), (0, 5.98, 0))
        plane.solids = m.solids
        materials = {"floor": {"reflectance": 0.2}, "wall": {"reflectance": 0.5}, "ceiling": {"reflectance": 0.7},
                     "block": {"reflectance": 0.4}}
        write_scene(folder, name, m, {"materials": materials,
                                      "sky": {"model": "cie-overcast", "horizontal_illuminance": 10000}},
                    m.points(1000) + plane.points(500, seed=3))
    return make


def small_room(m, at):
    m.room(at, add(at, CELL))
    m.box("block", add(at, (0.9, 0.7, 0)), (0.7, 0.25, 0), (-0.25, 0.7, 0), (0, 0, 1.1))
    m.box("body", add(at, (1.3, 1.05, 2.588)), (0.4, 0, 0), (0, 0.4, 0), (0, 0, 0.006), bottom="lamp",
          bottom_sampled=True)


def rooms(folder, count, max_element):
    """`count` sealed rooms, 0.2 m apart; their light is that of rooms_1, moved."""
    name = "rooms_%d" % count
    one = Model(3.0)
    small_room(one, (0, 0, 0))
    points = one.points(POINTS, seed=7)
    columns = math.ceil(math.sqrt(count))
    m = Model(3.0)
    corner = [((i % columns) * 3.2, (i // columns) * 2.7, 0.0) for i in range(count)]
    for at in corner:
        small_room(m, at)
    rng = random.Random(11)
    moved = [(add(p, corner[rng.randrange(count)]), n) for p, n in points]
    write_scene(folder, name, m, {"materials": GREY, "solver": {"max_element": max_element}}, moved,
                {"reference": "rooms_1"})


HALL = (20.0, 20.0, 8.0)


def faces(folder, count, name):
    """A hall with `count` triangles of 1 to 5 cm, turned at random, afloat between 0.3 and 7 m; a lamp above them."""
    m = Model(20.0)
    rng = random.Random(count)
    m.room((0, 0, 0), HALL)
    m.box("body", (8.5, 8.5, 7.9), (3, 0, 0), (0, 3, 0), (0, 0, 0.05), bottom="lamp", bottom_sampled=True)
    for _ in range(count):
        c = (rng.uniform(0.3, 19.7), rng.uniform(0.3, 19.7), rng.uniform(0.3, 7.0))
        while True:
            a = (rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1))
            b = (rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1))
            n = cross(a, b)
            if 0.01 < dot(a, a) < 1 and 0.01 < dot(b, b) < 1 and dot(n, n) > 0.25 * dot(a, a) * dot(b, b):
                break
        s, t = rng.uniform(0.01, 0.05), rng.uniform(0.01, 0.05)
        m.triangle("leaf", c, add(c, mul(unit(a), s)), add(c, mul(unit(b), t)))
    # The room's own light and the leaves' alike: half of the points on each.
    walls, leaves = Model(20.0), Model(1.0)
    walls.solids = m.solids
    walls.faces = [f for f in m.faces if f[0] != "leaf"]
    leaves.faces = [f for f in m.faces if f[0] == "leaf"]
    points = walls.points(POINTS // 2) + leaves.points(POINTS // 2)
    materials = dict(GREY, leaf={"reflectance": 0.5}, lamp={"reflectance": 0.5, "exitance": 500, "sides": 1})
    write_scene(folder, name, m, {"materials": materials, "solver": {"max_element": 1.0}}, points)


def sealed(folder, name, sheet):
    """A lit room, a dark one and a lit one in a row. Floor and ceiling are one slab each, on which the partitions
    stand: boxes of 0.1 m, or single sheets. The dark room's own lamp is 1e-9 of the others', so that its surfaces take
    part: what it holds above 1e-6 of the lit rooms has leaked."""
    m = Model(4.0)
    t = 0.0 if sheet else 0.1
    w = 4.0
    x1, x2, x3 = w, w + t + 3.0, w + t + 3.0 + t + w
    d, h = 3.0, 2.6
    dark = (x1 + t, 0.0, 0.0, x2, d, h)
    m.room((0, 0, 0), (x3, d, h))
    for x in (x1, x2):
        if sheet:
            m.quad("wall", (x, 0, 0), (0, d, 0), (0, 0, h))
            m.quad("wall", (x, 0, 0), (0, 0, h), (0, d, 0))
        else:
            m.box("wall", (x, 0, 0), (t, 0, 0), (0, d, 0), (0, 0, h))
            m.faces = m.faces[:-6] + [f for f in m.faces[-6:] if abs(f[1][0][0] - f[1][2][0]) < 1e-9]
    for x, lamp in ((1.8, "lamp"), (dark[0] + 1.3, "glow"), (dark[3] + t + 1.8, "lamp")):
        m.box("body", (x, 1.3, h - 0.012), (0.4, 0, 0), (0, 0.4, 0), (0, 0, 0.006), bottom=lamp, bottom_sampled=True)
    materials = dict(GREY, glow={"reflectance": 0.5, "exitance": 1e-7, "sides": 1})
    is_dark = lambda p: dark[0] - 1e-3 < p[0] < dark[3] + 1e-3
    # Sheets shared with the lit rooms: the lifted point tells the side.
    lit = m.points(POINTS // 2, accept=lambda p: not is_dark(p) or (sheet and not dark[0] < p[0] < dark[3]))
    inside = m.points(POINTS // 2, seed=2, accept=lambda p: dark[0] < p[0] < dark[3])
    write_scene(folder, name, m, {"materials": materials}, lit + inside, {"dark": list(dark)})


SCENES = {
    "room_lamp": room_lamp, "room_cornell_mm": room_cornell_mm, "room_uplight": room_uplight,
    "room_thread": room_thread, "room_sunpatch": room_sunpatch, "contacts": contacts, "room_tray": room_tray, "room_mirror": room_mirror,
    "room_hole": lambda f: room_sunpatch(f, "room_hole", (3.6, 0.6, 3.8, 0.8), {"model": "cie-clear", "horizontal_illuminance": 10000}),
    "office_window": office("office_window", (0.5, 0.9, 3, 1.5)), "office_slit": office("office_slit", (1.5, 1.4, 1, 0.001)),
    "sealed_slab": lambda f: sealed(f, "sealed_slab", False),
    "sealed_sheet": lambda f: sealed(f, "sealed_sheet", True),
    **{"rooms_%d" % n: lambda f, n=n: rooms(f, n, 0.25) for n in (1, 3, 10, 26, 100, 260)},  # 4,000 elements each
    "faces_1e4": lambda f: faces(f, 10**4, "faces_1e4"), "faces_1e5": lambda f: faces(f, 10**5, "faces_1e5"),
    "faces_1e6": lambda f: faces(f, 10**6, "faces_1e6"),
}


def main():
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__)
    if sys.argv[1] == "--list":
        print("\n".join(SCENES))
        return
    folder = sys.argv[1]
    os.makedirs(folder, exist_ok=True)
    for name in sys.argv[2:] or [s for s in SCENES if s != "faces_1e6"]:
        if name not in SCENES:
            sys.exit(f"{name} is not a scene; there are {', '.join(SCENES)}")
        SCENES[name](folder)


if __name__ == "__main__":
    main()
