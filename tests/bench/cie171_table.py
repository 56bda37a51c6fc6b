#!/usr/bin/env python3
"""Runs the cases of CIE 171 and prints a CSV row for each config: how far off its rows are. Keep rows worth keeping.

  python3 tests/bench/cie171_table.py [CASES_TEST] >> tests/bench/history/cie171.csv

CASES_TEST     the test program (default: build/release/bin/cases_test)
mean_percent, worst_percent   deviation relative to the reference; worst_of_zeros: of rows that are 0, in their unit
A summary of each case goes to standard error. Standard library only.
"""
import csv
import os
import subprocess
import sys

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
HEADER = "case,config,rows,mean_percent,worst_percent,worst_of_zeros".split(",")


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else os.path.join(ROOT, "build", "release", "bin", "cases_test")
    said = subprocess.run([program], capture_output=True, text=True).stdout
    rows = [row for row in csv.reader(said.splitlines()) if len(row) == len(HEADER) and row[2].isdigit()]
    commit = subprocess.run(["git", "-C", ROOT, "rev-parse", "--short", "HEAD"], capture_output=True,
                            text=True).stdout.strip() or "unknown"
    writer = csv.writer(sys.stdout, lineterminator="\n")
    writer.writerow(["commit"] + HEADER)
    for row in rows:
        writer.writerow([commit] + row)
    for case in dict.fromkeys(row[0] for row in rows):
        mine = [row for row in rows if row[0] == case]
        count = sum(int(row[2]) for row in mine)
        mean = sum(int(row[2]) * float(row[3]) for row in mine) / count
        print(f"{case:26} {len(mine):2} configs, {count:3} rows: mean {mean:8.4f} %, worst "
              f"{max(float(row[4]) for row in mine):8.4f} %", file=sys.stderr)


if __name__ == "__main__":
    main()
