#!/usr/bin/env python3
"""Runs two builds of the program in turn on the same scenes, and appends a CSV row for each scene: ratios of cost, and the
error that each of them measured.

  pairs.py BASE HEAD SCENE[:ACCURACY[:SKY]] ... [--pairs 3] [--out history/pairs.csv] [--commits BASE,HEAD]

SCENE       a scene or a model; ACCURACY: draft, standard (the default) or fine; SKY: of a model without light
ratio       CPU seconds of BASE over those of HEAD, the median of the pairs: above 1 the head is faster
element     the same for each element
rms, p95    in per cent, as the reports say it of the field; sensors: rms of these
Both take turns, so that what else the machine does falls on both. Standard library only.
"""
import argparse
import csv
import json
import os
import statistics
import subprocess
import sys
import tempfile

COLUMNS = ("cpu,cores,base,head,scene,accuracy,pairs,base_cpu_s,head_cpu_s,ratio,base_wall_s,head_wall_s,base_elements,"
           "head_elements,ratio_element,base_mib,head_mib,base_rms,head_rms,base_p95,head_p95,base_sensors,head_sensors").split(",")


def cpu_name():
    with open("/proc/cpuinfo") as f:
        return next((line.split(":")[1].strip().replace(",", " ") for line in f if line.startswith("model name")), "")


def run(program, scene, accuracy, sky, folder):
    report = os.path.join(folder, "report.json")
    command = [program, "solve", scene, "-o", os.path.join(folder, "out.vtp"), "--report", report,
               "--accuracy", accuracy, "--quiet"]
    if sky:
        command += ["--sky", sky]
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    message = child.stderr.read().decode(errors="replace")
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{message}")
    with open(report) as f:
        figures = json.load(f)

    def per_cent(name, key):
        return round(100 * figures[name][key], 3) if figures.get(name) else ""

    return {"cpu_s": usage.ru_utime + usage.ru_stime, "wall_s": figures["seconds"]["total"],
            "elements": figures["counts"]["elements"], "mib": figures["peak_memory_bytes"] / 2**20,
            "rms": per_cent("error", "rms_relative"), "p95": per_cent("error", "p95_relative"),
            "sensors": per_cent("error_sensors", "rms_relative")}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("base")
    parser.add_argument("head")
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--pairs", type=int, default=3)
    parser.add_argument("--out", default=os.path.join(os.path.dirname(os.path.abspath(__file__)), "history", "pairs.csv"))
    parser.add_argument("--commits", default="base,head")
    options = parser.parse_args()
    base, head = options.commits.split(",")
    is_new = not os.path.exists(options.out)
    with open(options.out, "a", newline="") as f, tempfile.TemporaryDirectory() as folder:
        rows = csv.DictWriter(f, COLUMNS)
        if is_new:
            rows.writeheader()
        for scene in options.scenes:
            scene, accuracy, sky = (scene.split(":", 2) + ["", ""])[:3]
            runs = [(run(options.base, scene, accuracy or "standard", sky, folder),
                     run(options.head, scene, accuracy or "standard", sky, folder)) for _ in range(options.pairs)]
            row = {"cpu": cpu_name(), "cores": os.cpu_count(), "base": base, "head": head,
                   "scene": os.path.basename(scene), "accuracy": accuracy or "standard", "pairs": options.pairs,
                   "ratio": round(statistics.median(b["cpu_s"] / h["cpu_s"] for b, h in runs), 3),
                   "ratio_element": round(statistics.median(b["cpu_s"] / b["elements"] / (h["cpu_s"] / h["elements"])
                                                            for b, h in runs), 3)}
            for k, which in enumerate(("base", "head")):
                for name in ("cpu_s", "wall_s", "elements", "mib"):
                    row[f"{which}_{name}"] = round(statistics.median(pair[k][name] for pair in runs), 3)
                for name in ("rms", "p95", "sensors"):
                    row[f"{which}_{name}"] = runs[0][k][name]
            rows.writerow(row)
            f.flush()
            print(f"{row['scene']} {row['accuracy']}: {row['base_cpu_s']:.2f} -> {row['head_cpu_s']:.2f} CPU s, "
                  f"{row['ratio']:.2f} times; rms {row['base_rms']} -> {row['head_rms']} %, "
                  f"p95 {row['base_p95']} -> {row['head_p95']} %")


if __name__ == "__main__":
    main()
