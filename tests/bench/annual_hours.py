#!/usr/bin/env python3
"""Hours of `clerestory annual` against each hour's own `solve --method path` at the same sensors.

  annual_hours.py PROGRAM WEATHER.epw [--scenes NAME ...] [--hours 40] [--accuracy standard] [--paths fine]
                  [--seed 1] [--out ROWS.csv] [--worst N] [--keep DIR]

--keep DIR leaves the files there; a second run takes the paths from them, while scene and sensors are the same.

The hours are those with light, one at random of each of so many equal stretches of the year. A row a scene, in per cent:

rms          sqrt(mean((x - r)^2 - s^2)) / mean(r) over all sensors and hours, x the year's, r the paths', s the standard
             error of these
bias         sum(x) / sum(r) - 1, and its own standard error
rms_no_sun   the same over those without any direct sun, relative to their own mean
worst_hour   the largest rms of one hour, relative to that hour's mean, of the hours with half the median mean at least
DA           change of the share of hours and sensors with 300 lx or more [points]; DA_moved: share of those that are on the
             other side of it in either direction, of which the paths' noise is a part
said         illuminance_error.grids.total of the year: the upper end of how wrong one is that has 100 lx at least, relative to its
             own value; true: the rms of that, noise taken off

--scenes plane: all hours with light on open ground against sky + sun of the weather file, nothing of which is the
program's: illuminances of the file, or what Perez' efficacies make of its radiation, and a solar position of its own.
Standard library only.
"""
import argparse
import array
import ast
import csv
import json
import math
import os
import random
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True  # leaves no __pycache__ in the sources
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from hierarchy_bench import commit, cpu  # noqa: E402
from make_scenes import Model, add, mul  # noqa: E402

COLUMNS = ("commit,cpu,weather,scene,accuracy,hours,rms,bias,bias_error,rms_no_sun,p95,worst_hour,DA,DA_moved,said,true,"
           "total").split(",")
SHIPPED = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "data", "scenes")
GREY = {"floor": {"reflectance": 0.3}, "wall": {"reflectance": 0.6}, "ceiling": {"reflectance": 0.8},
        "facade": {"reflectance": 0.4}, "slat": {"reflectance": 0.7}, "ground": {"reflectance": 0.2},
        "block": {"reflectance": 0.5}, "glazing": {"type": "glass", "transmittance": 0.65},
        "glass front": {"type": "mirror", "reflectance": 0.4}}
COLOURED = dict(GREY, floor={"reflectance": [0.45, 0.3, 0.2]}, wall={"reflectance": [0.7, 0.6, 0.35]},
                block={"reflectance": [0.2, 0.3, 0.6]})


# ---- scenes ----------------------------------------------------------------------------------------------------------
def wall_with_windows(m, o, along, height, windows, thickness, glazing="glazing"):
    """Inside of a wall seen from where along x up points, and the reveals outward; windows: (from, sill, width, height)."""
    length = math.sqrt(sum(a * a for a in along))
    a, up = mul(along, 1 / length), (0, 0, 1)
    out = (-a[1], a[0], 0)
    out = mul(out, -thickness)  # away from the room, which lies left of `along`
    at = 0.0
    for x, sill, w, h in sorted(windows) + [(length, 0, 0, height)]:
        m.quad("wall", add(o, mul(a, at)), mul(up, height), mul(a, x - at))
        m.quad("facade", add(add(o, out), mul(a, at)), mul(a, x - at), mul(up, height))
        if w == 0:
            break
        for z, t in ((0, sill), (sill + h, height - sill - h)):
            if t > 0:
                p = add(add(o, mul(a, x)), mul(up, z))
                m.quad("wall", p, mul(up, t), mul(a, w))
                m.quad("facade", add(p, out), mul(a, w), mul(up, t))
        p = add(add(o, mul(a, x)), mul(up, sill))
        m.quad("wall", p, mul(a, w), out)
        m.quad("wall", add(p, mul(up, h)), out, mul(a, w))
        m.quad("wall", p, out, mul(up, h))
        m.quad("wall", add(p, mul(a, w)), mul(up, h), out)
        if glazing:
            m.quad(glazing, add(p, mul(out, 0.5)), mul(a, w), mul(up, h))
        at = x + w


def shell(m, x0, y0, x1, y1, h, t, openings):
    """A room; openings of the walls south, east, north, west."""
    m.quad("floor", (x0, y0, 0), (x1 - x0, 0, 0), (0, y1 - y0, 0))
    m.quad("ceiling", (x0, y0, h), (0, y1 - y0, 0), (x1 - x0, 0, 0))
    m.quad("facade", (x0 - t, y0 - t, h + 0.2), (x1 - x0 + 2 * t, 0, 0), (0, y1 - y0 + 2 * t, 0))
    sides = (((x0, y0, 0), (x1 - x0, 0, 0)), ((x1, y0, 0), (0, y1 - y0, 0)), ((x1, y1, 0), (x0 - x1, 0, 0)),
             ((x0, y1, 0), (0, y0 - y1, 0)))
    for (o, along), (windows, glazing) in zip(sides, openings):
        wall_with_windows(m, o, along, h, windows, t, glazing)


NONE = ([], None)


def fins(m):
    """10 m deep behind an overhang of 1.5 m and slats as of a blind, 0.15 m wide every 0.2 m."""
    shell(m, 0, 0, 5, 10, 3, 0.3, (([(0.5, 0.8, 4, 2)], "glazing"), NONE, NONE, NONE))
    m.box("facade", (0, -1.8, 3), (5, 0, 0), (0, 1.5, 0), (0, 0, 0.2), bottom_sampled=True)
    for k in range(10):
        m.quad("slat", (0.5, -0.5, 0.85 + 0.2 * k), (4, 0, 0), (0, 0.15, 0.05))
    for k in range(3):
        m.quad("facade", (0.5 + 2 * k, -0.9, 0.5), (0, 0.6, 0), (0, 0, 2.5))
    return (0.3, 0.3, 0.8, 4.4, 9.4), {"materials": GREY}


def corner(m):
    """Two facades, north turned by 30 degrees, in colour; the ground outside is a real one."""
    shell(m, 0, 0, 6, 5, 3, 0.3, (([(1, 0.9, 4, 1.6)], "glazing"), ([(0.8, 0.0, 3.4, 2.6)], "glazing"), NONE, NONE))
    m.quad("ground", (-20, -20, -0.01), (46, 0, 0), (0, 45, 0))
    m.box("block", (2, 2, 0), (1.6, 0, 0), (0, 0.8, 0), (0, 0, 0.74), bottom_sampled=True)
    return (0.3, 0.3, 0.8, 5.4, 4.4), {"materials": COLOURED, "location": {"north": 30}}


def facing(m):
    """To the north; over the street a front of glass that mirrors the sun into the room."""
    shell(m, 0, 0, 5, 5, 3, 0.3, (NONE, NONE, ([(0.5, 0.8, 4, 1.9)], "glazing"), NONE))
    m.quad("ground", (-15, 5.3, -0.01), (35, 0, 0), (0, 15, 0))
    m.quad("glass front", (-5, 17, 0.5), (15, 0, 0), (0, 0, 12))
    m.quad("facade", (-5, 17.1, 0), (15, 0, 0), (0, 0, 12.5))
    return (0.3, 0.3, 0.8, 4.4, 4.4), {"materials": GREY, "location": {"north": 10}}


def flat(m):
    """Two rooms; the back one is lit through a door of the front one alone. In colour."""
    shell(m, 0, 0, 4, 8, 2.6, 0.2, (([(0.6, 0.6, 2.8, 1.8)], "glazing"), NONE, NONE, NONE))
    for x, z, w, h in ((0, 0, 2.5, 2.6), (3.4, 0, 0.6, 2.6), (2.5, 2.1, 0.9, 0.5)):
        m.box("wall", (x, 4, z), (w, 0, 0), (0, 0.1, 0), (0, 0, h), bottom_sampled=True)
    return (0.3, 0.3, 0.8, 3.4, 7.4), {"materials": COLOURED}


def courtyard(m):
    """12 x 10 m between walls of 9 m with a passage; sensors close to the ground."""
    m.quad("ground", (-12, -12, 0), (36, 0, 0), (0, 34, 0))
    for o, u, v in (((-3, -3, 0), (18, 0, 0), (0, 3, 0)), ((-3, 10, 0), (18, 0, 0), (0, 3, 0)),
                    ((-3, 0, 0), (3, 0, 0), (0, 10, 0)), ((12, 0, 0), (3, 0, 0), (0, 4, 0)),
                    ((12, 6, 0), (3, 0, 0), (0, 4, 0))):
        m.box("wall", o, u, v, (0, 0, 9))
    return (0.6, 0.6, 0.1, 10.8, 8.8), {"materials": GREY}


def plane(m):
    m.quad("ground", (-5, -5, 0), (10, 0, 0), (0, 10, 0))
    return (-1, -1, 1, 2, 2), {"materials": dict(GREY, ground={"reflectance": 0.0})}


def shipped(name):
    def make(_):
        with open(os.path.join(SHIPPED, name + ".json")) as file:
            scene = json.loads(re.sub(r"^\s*//.*$", "", file.read(), flags=re.M))
        for part in scene["geometry"]:
            part["file"] = os.path.abspath(os.path.join(SHIPPED, part["file"]))
        scene.pop("time", None), scene.pop("sensors", None), scene.pop("sky", None)
        return (0.25, 0.25, 0.8, 3.5, 5.5), scene
    return make


SCENES = {"office": shipped("office"), "light_shelf": shipped("light_shelf"), "fins": fins, "corner": corner,
          "facing": facing, "flat": flat, "courtyard": courtyard, "plane": plane}


def sensors(area):
    """Forty that look up in five columns of eight, ten that look at the four walls and down."""
    x, y, z, w, d = area
    rows = [(x + w * (i + 0.5) / 5, y + d * (j + 0.5) / 8, z, 0, 0, 1) for i in range(5) for j in range(8)]
    for k, n in enumerate(((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, -1)) * 2):
        rows.append((x + w * (0.23 if k < 5 else 0.67), y + d * (k + 0.5) / 10, z + 0.4) + n)
    return rows


# ---- files -----------------------------------------------------------------------------------------------------------
def read_npy(path):
    with open(path, "rb") as file:
        file.read(8)
        header = ast.literal_eval(file.read(int.from_bytes(file.read(2), "little")).decode())
        values = array.array({"<f4": "f", "<f8": "d", "<i4": "i", "<i8": "q"}[header["descr"]])
        values.frombytes(file.read())
    return header["shape"], values


def run(*words):
    done = subprocess.run(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode:
        sys.exit("%s\n%s" % (" ".join(words), done.stderr))


def place_of(weather):
    with open(weather, encoding="latin-1") as file:
        head = file.readline().split(",")
    return {"latitude": float(head[6]), "longitude": float(head[7]), "timezone": float(head[8])}


class Year:
    """A scene and what `annual` makes of it."""

    def __init__(self, program, weather, name, folder, accuracy):
        self.program, self.weather, self.folder = program, os.path.abspath(weather), folder
        m = Model(10)
        area, self.scene = SCENES[name](m)
        if m.faces:
            m.write_obj(os.path.join(folder, "model.obj"))
            self.scene["geometry"] = [{"file": "model.obj", "unit": "m", "up": "z"}]
            used = {material for material, _, _ in m.faces}
            self.scene["materials"] = {k: v for k, v in self.scene["materials"].items() if k in used}
        if "location" in self.scene:
            self.scene["location"].update(place_of(weather))
        self.places = sensors(area)
        self.points = os.path.join(folder, "points.csv")
        with open(self.points, "w") as file:
            file.write("x,y,z,nx,ny,nz\n" + "".join(",".join("%.9g" % a for a in p) + "\n" for p in self.places))
        scene, hours = self.write("year.json", {}), os.path.join(folder, "hours")
        run(program, "annual", scene, "--weather", self.weather, "-o", os.path.join(folder, "year.vtp"), "--sensors",
            self.points, "--hours", hours, "--accuracy", accuracy, "--report", os.path.join(folder, "report.json"), "--quiet")
        _, self.hour = read_npy(os.path.join(hours, "hour.npy"))
        (self.n, self.H), self.total = read_npy(os.path.join(hours, "sensors", "total.npy"))
        _, self.direct = read_npy(os.path.join(hours, "sensors", "direct.npy"))
        with open(os.path.join(folder, "year.json")) as file:
            self.said = json.load(file)["illuminance_error"]["grids"]["total"]
        with open(os.path.join(folder, "report.json")) as file:
            self.report = json.load(file)

    def write(self, name, sky):
        path = os.path.join(self.folder, "scene_" + name)
        with open(path, "w") as file:
            json.dump(dict(self.scene, sky=dict({"ground_reflectance": 0.2}, **sky)), file, indent=1)
        return path

    def paths(self, k, accuracy):
        """(value, standard error) of each sensor in the k-th hour [lx]."""
        h = self.hour[k]
        scene = self.write("hour.json", {"weather": self.weather, "day_of_year": h // 24 + 1, "hour": h % 24 + 1})
        out = os.path.join(self.folder, "%s_%d.csv" % (accuracy, h))
        if not os.path.exists(out):  # of an earlier run with --keep
            run(self.program, "solve", scene, "-o", os.path.join(self.folder, "hour.vtp"), "--method", "path",
                "--accuracy", accuracy, "--max-element", "100", "--no-error", "--sensors", self.points, "--sensors-out",
                out, "--quiet")
        with open(out) as file:
            return [(float(r["illuminance"]), float(r["std_error"])) for r in csv.DictReader(file)]


# ---- figures ---------------------------------------------------------------------------------------------------------
def rms_of(pairs):
    """rms, its mean, both of (x, r, s)."""
    mean = sum(r for _, r, _ in pairs) / max(len(pairs), 1)
    square = sum((x - r) ** 2 - s * s for x, r, s in pairs) / max(len(pairs), 1)
    return (math.copysign(math.sqrt(abs(square)), square) / mean if mean > 0 else 0), mean


def compare(year, hours, paths, worst):
    found = []  # (hour, sensor, x, r, s, direct)
    for k in hours:
        for p, (r, s) in enumerate(year.paths(k, paths)):
            found.append((year.hour[k], p, year.total[p * year.H + k], r, s, year.direct[p * year.H + k]))
    pairs = [f[2:5] for f in found]
    rms, mean = rms_of(pairs)
    of_hour = {h: rms_of([f[2:5] for f in found if f[0] == h]) for h in {f[0] for f in found}}
    bright = sorted(m for _, m in of_hour.values())[len(of_hour) // 2] / 2
    worst_hour = max((e, h) for h, (e, m) in of_hour.items() if m >= bright)
    relative = sorted(abs(x - r) / r for x, r, _ in pairs if r > 0)
    lit = [((x - r) / r) ** 2 - (s / r) ** 2 for x, r, s in pairs if r >= 100]
    total = sum(r for _, r, _ in pairs)
    above = [(x >= 300, r >= 300) for x, r, _ in pairs]
    if worst:
        print("   hour sensor        x        r        s   direct")
        for f in sorted(found, key=lambda f: -abs(f[2] - f[3]) / max(f[3], 0.01 * mean))[:worst]:
            print("%7d %6d %8.1f %8.1f %8.1f %8.1f" % f)
        print("hours:", ", ".join("%d %.1f%%" % (h, 100 * e) for e, h in sorted(((e, h) for h, (e, _) in of_hour.items()), reverse=True)[:8]))
    n = len(above)
    return {"rms": 100 * rms, "bias": 100 * (sum(x for x, _, _ in pairs) / total - 1),
            "bias_error": 100 * math.sqrt(sum(s * s for _, _, s in pairs)) / total,
            "rms_no_sun": 100 * rms_of([f[2:5] for f in found if f[5] == 0])[0], "p95": 100 * relative[n * 95 // 100 - 1],
            "worst_hour": 100 * worst_hour[0], "DA": 100 * sum(a - b for a, b in above) / n,
            "DA_moved": 100 * sum(a != b for a, b in above) / n, "said": 100 * year.said,
            "true": 100 * math.sqrt(max(0, sum(lit) / max(len(lit), 1)))}


def open_plane(year):
    """Largest and summed deviation from the weather file's own light."""
    from open_ground import light_of_weather
    light = light_of_weather(year.weather)
    sums, worst = [0.0, 0.0], (0, 0)
    for k, h in enumerate(year.hour):
        if h not in light:
            continue
        x, r = year.total[k], light[h]  # the first sensor looks up
        sums = [sums[0] + x, sums[1] + r]
        worst = max(worst, (abs(x - r) / r, h))
    return {"hours": len(light), "total": 100 * (sums[0] / sums[1] - 1), "worst_hour": 100 * worst[0]}


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("program"), options.add_argument("weather")
    options.add_argument("--scenes", nargs="*", default=list(SCENES))
    options.add_argument("--hours", type=int, default=40)
    options.add_argument("--accuracy", default="standard")
    options.add_argument("--paths", default="fine")
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--out"), options.add_argument("--worst", type=int, default=0), options.add_argument("--keep")
    asked = options.parse_args()
    for name in asked.scenes:
        with tempfile.TemporaryDirectory() as folder:
            if asked.keep:
                folder = os.path.join(asked.keep, name)
                os.makedirs(folder, exist_ok=True)
            year = Year(asked.program, asked.weather, name, folder, asked.accuracy)
            random.seed(asked.seed)
            hours = [int((k + random.random()) * year.H / asked.hours) for k in range(asked.hours)]
            figures = open_plane(year) if name == "plane" else compare(year, hours, asked.paths, asked.worst)
        row = dict({"weather": os.path.basename(asked.weather)[:6], "scene": name, "accuracy": asked.accuracy,
                    "hours": asked.hours}, **{k: "%.3g" % v if isinstance(v, float) else v for k, v in figures.items()})
        print(", ".join("%s %s" % item for item in row.items()), flush=True)
        if asked.out:
            row = dict({"commit": commit(), "cpu": cpu()}, **row)
            is_new = not os.path.exists(asked.out)
            with open(asked.out, "a", newline="") as file:
                writer = csv.DictWriter(file, COLUMNS, restval="")
                if is_new:
                    writer.writeheader()
                writer.writerow(row)


if __name__ == "__main__":
    main()
