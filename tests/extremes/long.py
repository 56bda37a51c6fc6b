#!/usr/bin/env python3
"""The extremes that take minutes: halls of 10^4 to 10^6 faces, checked against the laws.

  long.py PROGRAM FOLDER [--faces N ...] [--accuracy draft ...] [--out ROWS.csv]

Writes a row a run, as in tests/bench/history/extremes.csv. Scenes come from tests/bench/make_scenes.py, into FOLDER.
Exit code 1 when a run fails, a law is broken or a value is no number or below 0. Standard library only.
"""
import argparse
import csv
import json
import os
import resource
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
COLUMNS = ["program", "scene", "faces", "accuracy", "exit", "cpu_s", "mib", "elements", "imbalance", "law", "space",
           "worst", "bound", "least_share"]


def version():
    return subprocess.run(["git", "-C", HERE, "rev-parse", "--short", "HEAD"], capture_output=True, text=True).stdout.strip()


def run(program, folder, faces, accuracy):
    scene = f"faces_1e{len(str(faces)) - 1}"
    if not os.path.exists(f"{folder}/{scene}.json"):
        subprocess.run([sys.executable, f"{HERE}/../bench/make_scenes.py", folder, scene], check=True)
    report = f"{folder}/{scene}.report.json"
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([program, "solve", f"{folder}/{scene}.json", "-o", f"{folder}/{scene}.vtp", "--accuracy",
                           accuracy, "--check", "--quiet", "--report", report])
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    row = {"program": version(), "scene": scene, "faces": faces, "accuracy": accuracy, "exit": done.returncode,
           "cpu_s": round(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, 1)}
    if done.returncode not in (0, 4):
        return row
    with open(report) as f:
        r = json.load(f)
    checked = [law for law in r["laws"] if law.get("worst")]
    # The law that is nearest to its bound.
    nearest = max(checked, key=lambda law: law["worst"]["worst"] / law["worst"]["bound"])
    least = next(law for law in checked if law["law"] == "no_negative_light")
    row.update(mib=round(r["peak_memory_bytes"] / 2**20), elements=r["counts"]["elements"],
               imbalance=f"{r['energy']['imbalance']:.2e}", law=nearest["law"], space=nearest["worst"]["name"],
               worst=f"{nearest['worst']['worst']:.2e}", bound=f"{nearest['worst']['bound']:.2e}",
               least_share=f"{-least['worst']['worst']:.1e}")
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("--faces", type=int, nargs="+", default=[10**4, 10**5, 10**6])
    parser.add_argument("--accuracy", nargs="+", default=["draft", "standard"])
    parser.add_argument("--out", help="where rows are added to (default: standard output)")
    a = parser.parse_args()
    os.makedirs(a.folder, exist_ok=True)
    out = open(a.out, "a", newline="") if a.out else sys.stdout
    writer = csv.DictWriter(out, COLUMNS)
    if not a.out or out.tell() == 0:
        writer.writeheader()
    failed = False
    for faces in a.faces:
        for accuracy in a.accuracy:
            row = run(a.program, a.folder, faces, accuracy)
            writer.writerow(row)
            out.flush()
            failed |= row["exit"] != 0
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
