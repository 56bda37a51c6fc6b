#!/usr/bin/env python3
"""What a time limit makes of a draft's time and its multiples, next to the levels themselves.

  time_limits.py PROGRAM SCENE REFERENCE.csv [REPEATS]

REFERENCE.csv  of field_reference.py or path_reference, for the scene
REPEATS        draft's time is the median of so many runs (3)

For draft, standard and fine, and for limits of 1, 2, 4 and 8 times a draft's time (of `standard`; 16 of `fine`): the
time on the clock, the level of the elements, and the true error of the field against the reference (compare.py).
On a machine that does nothing else. Standard library only.
"""
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True  # leaves no __pycache__ in the sources
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))


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
    return text.stdout.decode().split("\n")[0]


def main():
    program, scene, reference = sys.argv[1:4]
    repeats = int(sys.argv[4]) if len(sys.argv) > 4 else 3
    with tempfile.TemporaryDirectory() as folder:
        draft = statistics.median(run(program, scene, folder, "--accuracy", "draft")[0] for _ in range(repeats))
        for options in [["--accuracy", a] for a in ("draft", "standard", "fine")] + \
                       [["--accuracy", "fine" if k == 16 else "standard", "--time-limit", f"{k * draft:.3f}"]
                        for k in (1, 2, 4, 8, 16)]:
            wall, report, out = run(program, scene, folder, *options)
            print(f"{' '.join(options):42s} {wall:7.2f} s  {wall / draft:5.2f} x draft  elements of "
                  f"{report['settings']['accuracy']:9s} {errors(reference, out)}", flush=True)


if __name__ == "__main__":
    main()
