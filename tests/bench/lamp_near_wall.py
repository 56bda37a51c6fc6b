#!/usr/bin/env python3
"""Lamps near a wall: energy and mean irradiance against the closed form, by distance, size of room and accuracy.

    python3 tests/bench/lamp_near_wall.py build/release/bin/clerestory OUT.csv [--methods hierarchical] [--kinds point]

Rooms of S x 0.8 S x 0.6 S with an even reflectance of 0.5; a lamp of 1,000 lm stands off the wall y = 0. Whatever its
distance, the mean irradiance over all surfaces is flux / (A (1 - rho)). A row: imbalance, mean over the closed form by
cells (each by its area) and by points (linear between them), CPU seconds of the whole command.
"""

import argparse
import csv
import json
import math
import os
import resource
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from compare import Vtp  # noqa: E402

RHO, FLUX, EFFICACY = 0.5, 1000.0, 179.0


def room(folder, size):
    x, y, z = size, 0.8 * size, 0.6 * size
    corners = [(i, j, k) for k in (0, z) for j in (0, y) for i in (0, x)]
    faces = ["1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"]
    with open(os.path.join(folder, "room.obj"), "w") as f:
        f.writelines("v %r %r %r\n" % c for c in corners)
        f.writelines("usemtl wall\nf %s\n" % face for face in faces)
    return 2 * (x * y + x * z + y * z)


def ies(folder, opening):
    """A Lambertian lamp with a tenth of its light upwards."""
    angles = [2.5 * i for i in range(73)]
    cd = [math.cos(math.radians(a)) if a <= 90 else -math.cos(math.radians(a)) / 9 for a in angles]
    with open(os.path.join(folder, "lamp.ies"), "w") as f:
        f.write("IESNA:LM-63-1995\nTILT=NONE\n1 -1 100 %d 1 1 2 %r %r 0\n1 1 0\n" % (len(angles), opening, opening))
        f.write(" ".join("%r" % a for a in angles) + "\n0\n" + " ".join("%.6f" % max(0, c) for c in cd) + "\n")


def luminaire(kind, size, distance):
    where = [0.43 * size, distance, 0.31 * size]
    if kind == "point":
        return {"type": "point", "position": where, "luminous_flux": FLUX}
    return {"file": "lamp.ies", "position": where, "aim": {"ies_at_wall": [0, -1, 0], "panel": [0, -1, 0]}.get(kind, [0, 0, -1]),
            "luminous_flux": FLUX}


def measure(program, folder, kind, size, distance, accuracy, method):
    area = room(folder, size)
    ies(folder, 0.2 * min(size, 1) if kind == "panel" else 0)
    scene = {"geometry": [{"file": "room.obj"}], "materials": {"*": {"reflectance": RHO}},
             "luminaires": [luminaire(kind, size, distance)]}
    path = os.path.join(folder, "scene.json")
    with open(path, "w") as f:
        json.dump(scene, f)
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    out, report = os.path.join(folder, "out.vtp"), os.path.join(folder, "report.json")
    run = subprocess.run([program, "solve", path, "-o", out, "--report", report, "--accuracy", accuracy, "--method", method,
                    "--quiet"], stderr=subprocess.PIPE)
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    vtp = Vtp(out)
    cells, areas = vtp.get("CellData", "irradiance"), vtp.get("CellData", "area")
    points, corners = vtp.get("PointData", "irradiance"), vtp.get("Polys", "connectivity")
    exact = FLUX / EFFICACY / (1 - RHO)  # of the flux, so that what the scene's area misses counts
    by_cells = sum(e * a for e, a in zip(cells, areas)) / exact
    by_points = sum(a * sum(points[corners[3 * i + k]] for k in range(3)) / 3 for i, a in enumerate(areas)) / exact
    assert abs(sum(areas) / area - 1) < 1e-6
    with open(report) as f:
        r = json.load(f)
    return {"kind": kind, "size": size, "distance": distance, "accuracy": accuracy, "method": method,
            "imbalance": "%.2e" % r["energy"]["imbalance"], "cells": "%.4f" % by_cells, "points": "%.4f" % by_points,
            "rms": "%.3g" % r["error"]["rms_relative"], "cpu_s": "%.2f" % seconds, "exit": run.returncode}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("out")
    parser.add_argument("--kinds", nargs="+", default=["point", "ies_at_wall"],
                        choices=["point", "ies_along_wall", "ies_at_wall", "panel"])
    parser.add_argument("--sizes", nargs="+", type=float, default=[1, 4, 1000])
    parser.add_argument("--distances", nargs="+", type=float, default=[1e-6, 1e-3, 1e-2, 0.2])
    parser.add_argument("--accuracies", nargs="+", default=["draft", "standard"])
    parser.add_argument("--methods", nargs="+", default=["hierarchical"])
    args = parser.parse_args()
    rows = None
    with tempfile.TemporaryDirectory() as folder, open(args.out, "w", newline="") as out:
        for method in args.methods:
            for kind in args.kinds:
                for size in args.sizes:
                    for distance in args.distances:
                        if distance >= 0.7 * size:
                            continue
                        for accuracy in args.accuracies:
                            row = measure(args.program, folder, kind, size, distance, accuracy, method)
                            if rows is None:
                                rows = csv.DictWriter(out, row, lineterminator="\n")
                                rows.writeheader()
                            rows.writerow(row)
                            out.flush()
                            print(*row.values(), flush=True)


if __name__ == "__main__":
    main()
