#!/usr/bin/env python3
"""A reference for compare.py by the program's own sensors, for scenes whose field is to be judged and not their light.

  field_reference.py PROGRAM SCENE OUT.csv [POINTS] [SEEDS]

POINTS  random points, uniform over the surfaces of a draft (6000)
SEEDS   runs at `fine`, with as many seeds, whose sensor values are averaged (6)

Sensors are gathered where they stand: edges of shadows are exact there, so that what the field loses between its
vertices shows. std_error is that of the mean. What sensors and field have in common, as the light of the elements, does
not show: for that there are converged paths (path_reference).
Standard library only.
"""
import csv
import math
import os
import random
import statistics
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True  # leaves no __pycache__ in the sources
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from compare import Vtp  # noqa: E402


def sub(a, b): return [x - y for x, y in zip(a, b)]
def cross(a, b): return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def points_on(path, count):
    result = Vtp(path)
    x, corner = result.points(), result.get("Polys", "connectivity")
    triangles = [[[x[3 * corner[t + k] + j] for j in range(3)] for k in range(3)] for t in range(0, len(corner), 3)]
    normals = [cross(sub(b, a), sub(c, a)) for a, b, c in triangles]
    twice_area = [math.hypot(*n) for n in normals]
    random.seed(5)
    points = []
    for i in random.choices(range(len(triangles)), twice_area, k=count):
        s, u = math.sqrt(random.random()), random.random()
        weight = (1 - s, s * (1 - u), s * u)
        place = [sum(w * c[j] for w, c in zip(weight, triangles[i])) for j in range(3)]
        points.append(place + [n / twice_area[i] for n in normals[i]])
    return points


def main():
    program, scene, out = sys.argv[1:4]
    count = int(sys.argv[4]) if len(sys.argv) > 4 else 6000
    seeds = int(sys.argv[5]) if len(sys.argv) > 5 else 6
    with tempfile.TemporaryDirectory() as folder:
        result, places, values = (os.path.join(folder, name) for name in ("r.vtp", "p.csv", "e.csv"))
        subprocess.run([program, "solve", scene, "-o", result, "--accuracy", "draft", "--quiet"], check=True)
        points = points_on(result, count)
        with open(places, "w") as file:
            file.write("x,y,z,nx,ny,nz\n" + "".join(",".join("%.9g" % a for a in p) + "\n" for p in points))
        found = [[] for _ in points]
        for seed in range(1, seeds + 1):
            subprocess.run([program, "solve", scene, "-o", result, "--accuracy", "fine", "--seed", str(seed), "--sensors",
                            places, "--sensors-out", values, "--quiet"], check=True)
            with open(values) as file:
                for E, row in zip(found, csv.DictReader(file)):
                    E.append(float(row["illuminance"]))
    with open(out, "w") as file:
        file.write("x,y,z,nx,ny,nz,illuminance,std_error,replicates\n")
        for p, E in zip(points, found):
            error = statistics.stdev(E) / math.sqrt(seeds) if seeds > 1 else 0
            file.write(",".join("%.9g" % a for a in p) + ",%.9g,%.3g,%d\n" % (statistics.mean(E), error, seeds))


if __name__ == "__main__":
    main()
