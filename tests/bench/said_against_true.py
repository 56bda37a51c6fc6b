#!/usr/bin/env python3
"""How well runs know their own error: said against true rms of the worst room, from the tables of `clerestory tradeoff`.

  said_against_true.py FOLDER [METHOD]      FOLDER/NAME/tradeoff.csv for each scene, as docs/pictures/tradeoff.sh leaves them

For each run of METHOD (hierarchical; `all` for all) the ratio said / true, and whether it agrees within a factor of 1.5 or within
the confidence of the true figure. Bounds, which claim no more than not to be too small, are right when they are.
Standard library only.
"""
import csv
import glob
import math
import os
import sys

FACTOR = 1.5


def rows(folder, method):
    for path in sorted(glob.glob(os.path.join(folder, "*", "tradeoff.csv"))):
        with open(path) as file:
            for row in csv.DictReader(file):
                if method in ("all", row["method"]):
                    yield os.path.basename(os.path.dirname(path)), row


def main():
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__)
    method = sys.argv[2] if len(sys.argv) > 2 else "hierarchical"
    within = near = half = count = 0
    for scene, row in rows(sys.argv[1], method):
        said, true, confidence = float(row["said_rms"]), float(row["rms"]), float(row["confidence"])
        if math.isnan(said) or not true > 0:
            continue
        count += 1
        ratio = said / true
        is_within = 1 / FACTOR <= ratio <= FACTOR
        is_near = is_within or true - confidence <= said <= true + confidence
        within, near, half = within + is_within, near + is_near, half + (ratio >= 0.5)
        print("%-20s %-13s %-21s said %6.3g %%, true %6.3g +- %.2g %%%s, ratio %.2f%s" % (
            scene, row["method"], row["settings"], 100 * said, 100 * true, 100 * confidence,
            " (bound)" if row["bound"] not in ("", "0") else "", ratio, "" if is_within else " near" if is_near else " OFF"))
    if count:
        print("%d pairs: within a factor of %.1f %d, or within the confidence %d; said at least half %d" % (
            count, FACTOR, within, near, half))


main()
