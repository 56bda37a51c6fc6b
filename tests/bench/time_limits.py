#!/usr/bin/env python3
"""What a time limit makes of a draft's time and its multiples, next to the levels themselves.

  time_limits.py PROGRAM SCENE REFERENCE.csv [REPEATS] >> history/time_limits.csv

REFERENCE.csv  of field_reference.py or path_reference, for the scene
REPEATS        draft's time is the median of so many runs (3)

A row each for draft, standard and fine, and for limits of 1, 2, 4 and 8 times a draft's time (of `standard`; 16 of
`fine`): the level asked for and that of the elements, the limit and the time on the clock [s], the time over that of a
draft, and the true error of the field against the reference in per cent (compare.py).
On a machine that does nothing else. Standard library only.
"""
import csv
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True  # leaves no __pycache__ in the sources
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from pairs import cpu_name  # noqa: E402


def run(program, scene, folder, *options):
    out, report = os.path.join(folder, "out.vtp"), os.path.join(folder, "report.json")
    start = time.monotonic()
    done = subprocess.run([program, "solve", scene, "-o", out, "--report", report, "--quiet", *options],
                          stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
    wall = time.monotonic() - start
    if done.returncode not in (0, 4):
        sys.exit(f"{scene} {' '.join(options)}: exit code {done.returncode}")
    with open(report, encoding="utf-8") as file:
        return wall, json.load(file), out


def errors(reference, out):
    compare = os.path.join(os.path.dirname(os.path.abspath(__file__)), "compare.py")
    text = subprocess.run([sys.executable, compare, reference, "--field", out], stdout=subprocess.PIPE, check=True)
    field = next(line for line in text.stdout.decode().split("\n") if line.startswith("field"))
    return dict(zip(("rms", "median", "p95", "p99"), field.split()[1:]))


def main():
    program, scene, reference = sys.argv[1:4]
    repeats = int(sys.argv[4]) if len(sys.argv) > 4 else 3
    rows = csv.writer(sys.stdout)
    with tempfile.TemporaryDirectory() as folder:
        draft = statistics.median(run(program, scene, folder, "--accuracy", "draft")[0] for _ in range(repeats))
        asked = [(level, None) for level in ("draft", "standard", "fine")]
        asked += [("fine" if k == 16 else "standard", k * draft) for k in (1, 2, 4, 8, 16)]
        for level, limit in asked:
            options = ["--accuracy", level] + (["--time-limit", f"{limit:.3f}"] if limit else [])
            wall, report, out = run(program, scene, folder, *options)
            rows.writerow([cpu_name(), os.path.basename(scene), level, report["settings"]["accuracy"],
                           f"{limit:.2f}" if limit else "", f"{wall:.2f}", f"{wall / draft:.2f}",
                           *errors(reference, out).values()])
            sys.stdout.flush()


if __name__ == "__main__":
    main()
