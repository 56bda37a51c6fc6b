#!/usr/bin/env python3
"""Errors of a result against the reference at the same points.

  compare.py REFERENCE.csv [--sensors OUT.csv] [--field OUT.vtp] [--points POINTS.csv] [--info SCENE.info]
             [--report REPORT.json] [--worst N]

REFERENCE.csv  of path_reference: x,y,z,nx,ny,nz,illuminance,std_error,replicates
--sensors      sensor values of `clerestory solve`, the same points in the same order
--field        the written result, interpolated linearly in the triangle that lies under each point on its side
--points       where to look in the field, when the rooms of the reference were moved
--info         the scene's .info: names the box of the dark room, for the leak check, and the sun's patch, whose points
               do not count: the light it reflects is judged
--worst N      the N largest relative errors, with their points

rms = sqrt(mean((x - r)^2)) / mean(r); median, p95, p99, max of |x - r| / r; p99_lit the same over points above 2 % of
the mean, which leaves out the gap between a lamp and the ceiling; total = sum(x) / sum(r) - 1; all in per cent. Points at which the reference is below 1e-6 of its mean count for the leak only. `noise` is the reference's own
standard error, in the same measure as rms: it is contained in it.
Standard library only.
"""
import argparse
import array
import base64
import json
import math
import re
import struct
import sys
import zlib


def read_csv(path):
    with open(path) as file:
        rows = [line.rstrip("\n").split(",") for line in file if line.strip()]
    if not rows[0][0].lstrip("-").replace(".", "", 1)[:1].isdigit():
        return rows[0], [[float(x) for x in row] for row in rows[1:]]
    return [], [[float(x) for x in row] for row in rows]


# ---- the result file -------------------------------------------------------------------------------------------------
TYPES = {"Float32": "f", "Float64": "d", "Int32": "i", "Int64": "q", "UInt8": "B", "UInt32": "I", "UInt64": "Q"}


class Vtp:
    """Arrays of an XML PolyData file with inline data in base64, zlib blocks."""

    def __init__(self, path):
        with open(path) as file:
            text = file.read()
        self.word = "Q" if 'header_type="UInt64"' in text else "I"
        self.arrays = {}
        section = ""
        for name, rest, data in re.findall(r"<(\w+)([^>]*)>\s*([^<\s]*)", text):
            if name in ("FieldData", "PointData", "CellData", "Points", "Verts", "Lines", "Strips", "Polys"):
                section = name
            elif name == "DataArray":
                a = dict(re.findall(r'(\w+)="([^"]*)"', rest))
                self.arrays[section, a.get("Name", "Points")] = TYPES.get(a["type"]), data

    def length(self, words):
        return 4 * -(-words * struct.calcsize(self.word) // 3)

    def words(self, data, count):
        return struct.unpack("<%d%s" % (count, self.word), base64.b64decode(data[:self.length(count)]))

    def get(self, section, name):
        kind, data = self.arrays[section, name]
        # Two texts in base64: header (blocks, their size, that of the last, each one's size when packed), packed blocks.
        blocks = self.words(data, 3)[0]
        header = self.words(data, 3 + blocks)
        packed, at, result = base64.b64decode(data[self.length(3 + blocks):]), 0, array.array(kind)
        for size in header[3:]:
            result.frombytes(zlib.decompress(packed[at:at + size]))
            at += size
        return result

    def points(self):
        return self.get("Points", next(name for section, name in self.arrays if section == "Points"))


class Field:
    """Illuminance on the vertices of triangles."""

    def __init__(self, path):
        vtp = Vtp(path)
        self.position = vtp.points()
        self.corner = vtp.get("Polys", "connectivity")
        self.E = vtp.get("PointData", "illuminance")
        self.cell_E = vtp.get("CellData", "illuminance")

    def at(self, points, reach):
        """Values at points (x, y, z, nx, ny, nz); None where no triangle is within `reach` [m] on that side."""
        lower = [min(p[k] for p in points) for k in range(3)]
        upper = [max(p[k] for p in points) for k in range(3)]
        volume = math.prod(max(u - l, 1e-9) for l, u in zip(lower, upper))
        cell = (volume / max(len(points), 1)) ** (1 / 3)
        grid = {}
        for i, p in enumerate(points):
            grid.setdefault((math.floor(p[0] / cell), math.floor(p[1] / cell), math.floor(p[2] / cell)), []).append(i)
        best = [(-1.0, math.inf)] * len(points)
        value = [None] * len(points)
        X, C, E, floor = self.position, self.corner, self.E, math.floor
        for t in range(0, len(C), 3):
            a, b, c = C[t], C[t + 1], C[t + 2]
            ax, ay, az = X[3 * a], X[3 * a + 1], X[3 * a + 2]
            bx, by, bz = X[3 * b], X[3 * b + 1], X[3 * b + 2]
            cx, cy, cz = X[3 * c], X[3 * c + 1], X[3 * c + 2]
            found = None
            k0, k1 = floor((min(az, bz, cz) - reach) / cell), floor((max(az, bz, cz) + reach) / cell)
            j0, j1 = floor((min(ay, by, cy) - reach) / cell), floor((max(ay, by, cy) + reach) / cell)
            for i in range(floor((min(ax, bx, cx) - reach) / cell), floor((max(ax, bx, cx) + reach) / cell) + 1):
                for j in range(j0, j1 + 1):
                    for k in range(k0, k1 + 1):
                        here = grid.get((i, j, k))
                        if here:
                            found = found + here if found else here
            if not found:
                continue
            ux, uy, uz, vx, vy, vz = bx - ax, by - ay, bz - az, cx - ax, cy - ay, cz - az
            nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
            n2 = nx * nx + ny * ny + nz * nz
            if n2 == 0:
                continue
            n = math.sqrt(n2)
            for i in found:
                p = points[i]
                if p[3] * nx + p[4] * ny + p[5] * nz < 0.99 * n:
                    continue
                dx, dy, dz = p[0] - ax, p[1] - ay, p[2] - az
                off = abs(dx * nx + dy * ny + dz * nz) / n
                if off > reach:
                    continue
                # Barycentric weights of the foot of p in the triangle's plane.
                wb = ((dy * vz - dz * vy) * nx + (dz * vx - dx * vz) * ny + (dx * vy - dy * vx) * nz) / n2
                wc = ((uy * dz - uz * dy) * nx + (uz * dx - ux * dz) * ny + (ux * dy - uy * dx) * nz) / n2
                inside = min(1 - wb - wc, wb, wc, 0.0)  # 0 inside, else how far outside
                if inside < -1e-3 or (inside, -off) <= (best[i][0], -best[i][1]) and value[i] is not None:
                    continue
                best[i] = (inside, off)
                value[i] = E[a] + wb * (E[b] - E[a]) + wc * (E[c] - E[a])
        return value

    def largest_inside(self, box):
        """Largest value of a cell or vertex of the triangles whose middle lies in the box."""
        largest, X, C = 0.0, self.position, self.corner
        for t in range(0, len(C), 3):
            corners = C[t:t + 3]
            middle = [sum(X[3 * c + k] for c in corners) / 3 for k in range(3)]
            # On the sheet between two rooms the normal tells the side.
            if not all(box[k] - 1e-9 <= middle[k] <= box[k + 3] + 1e-9 for k in range(3)):
                continue
            p = [[X[3 * c + k] for k in range(3)] for c in corners]
            nx = (p[1][1] - p[0][1]) * (p[2][2] - p[0][2]) - (p[1][2] - p[0][2]) * (p[2][1] - p[0][1])
            if (abs(middle[0] - box[0]) < 1e-6 and nx < 0) or (abs(middle[0] - box[3]) < 1e-6 and nx > 0):
                continue
            largest = max(largest, self.cell_E[t // 3], *(self.E[c] for c in corners))
        return largest


# ---- figures ---------------------------------------------------------------------------------------------------------
def errors(values, reference, std_error, lit):
    """{rms, median, p95, p99, max, total, noise} in per cent, over the lit points that have a value."""
    x = [(values[i], reference[i], std_error[i]) for i in lit if values[i] is not None]
    if not x:
        return {}
    n, mean = len(x), sum(r for _, r, _ in x) / len(x)
    relative = sorted(abs(v - r) / r for v, r, _ in x)
    not_dark = sorted(abs(v - r) / r for v, r, _ in x if r > 0.02 * mean)
    quantile = lambda q, of=relative: of[min(len(of) - 1, int(q * len(of)))]
    figures = {
        "rms": math.sqrt(sum((v - r) ** 2 for v, r, _ in x) / n) / mean,
        "median": quantile(0.5), "p95": quantile(0.95), "p99": quantile(0.99), "max": relative[-1],
        "p99_lit": quantile(0.99, not_dark),
        "total": sum(v for v, _, _ in x) / (n * mean) - 1,
        "noise": math.sqrt(sum(s * s for _, _, s in x) / n) / mean,
    }
    return {k: 100 * v for k, v in figures.items()}


def in_sun(p, info):
    """On the floor where the sun falls or nearly: a handful of points a thousand times the others would rule rms."""
    x0, y0, x1, y1, z = (info or {}).get("sun_patch", (1, 1, 0, 0, 0))
    return x0 < p[0] < x1 and y0 < p[1] < y1 and abs(p[2] - z) < 1e-3


def compare(reference_file, sensors=None, field=None, points=None, info=None, worst=0):
    """{"sensors": figures, "field": figures, "leak": share, "missed": points that no triangle holds}"""
    _, reference = read_csv(reference_file)
    r, s = [row[6] for row in reference], [row[7] for row in reference]
    where = read_csv(points)[1] if points else reference
    mean = sum(r) / len(r)
    lit = [i for i in range(len(r)) if r[i] > 1e-6 * mean and not in_sun(reference[i], info)]
    dark = [i for i in range(len(r)) if r[i] <= 1e-6 * mean] if info and "dark" in info else []
    lit_mean = sum(r[i] for i in lit) / len(lit)
    result, leak = {"points": len(lit)}, []

    def judge(name, values):
        result[name] = errors(values, r, s, lit)
        leak.extend(values[i] / lit_mean for i in dark if values[i] is not None)
        if worst:
            order = sorted((i for i in lit if values[i] is not None), key=lambda i: -abs(values[i] - r[i]) / r[i])
            for i in order[:worst]:
                print("  %s %.4g for %.4g lx (+- %.2g): %+.1f %%  at %.3f %.3f %.3f facing %.2f %.2f %.2f" % (
                    name, values[i], r[i], s[i], 100 * (values[i] / r[i] - 1), *where[i][:6]))

    if sensors:
        header, rows = read_csv(sensors)
        column = header.index("illuminance") if header else 6
        if len(rows) != len(r):
            sys.exit(f"{sensors} has {len(rows)} points, the reference {len(r)}")
        judge("sensors", [row[column] for row in rows])
    if field:
        read = Field(field)
        reach = 1e-3 * (info or {}).get("size", 5) / 5
        values = read.at(where, reach)
        result["missed"] = sum(values[i] is None for i in lit)
        judge("field", values)
        if dark:
            leak.append(read.largest_inside(info["dark"]) / lit_mean)
    if dark:
        result["leak"] = max(leak)
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("reference")
    for name in ("sensors", "field", "points", "info", "report"):
        parser.add_argument("--" + name)
    parser.add_argument("--worst", type=int, default=0)
    a = parser.parse_args()
    info = json.load(open(a.info)) if a.info else {}
    result = compare(a.reference, a.sensors, a.field, a.points, info, a.worst)
    print("%-8s %7s %7s %7s %7s %8s %9s %8s %7s" % ("%", "rms", "median", "p95", "p99", "p99_lit", "max", "total",
                                                    "noise"))
    for name in ("sensors", "field"):
        if result.get(name):
            f = result[name]
            print("%-8s %7.3f %7.3f %7.3f %7.2f %8.2f %9.1f %+8.3f %7.3f" % (
                name, f["rms"], f["median"], f["p95"], f["p99"], f["p99_lit"], f["max"], f["total"], f["noise"]))
    if result.get("missed"):
        print(f"{result['missed']} of {result['points']} points lie on no triangle of the result")
    if "leak" in result:
        print("leak: dark room / lit mean = %.3g (bar 1e-6)" % result["leak"])
    if a.report:
        report = json.load(open(a.report))
        c, s, e = report["counts"], report["seconds"], report["energy"]
        print(f"{c['elements']} elements, {c['points']} points, {c['links']} links, {c['rays'] / 1e6:.2f} M rays, "
              f"imbalance {e['imbalance']:.2g}, {report['peak_memory_bytes'] / 2**20:.1f} MiB")
        print("seconds  " + "  ".join(f"{k} {v:.3f}" for k, v in s.items()))


if __name__ == "__main__":
    main()
