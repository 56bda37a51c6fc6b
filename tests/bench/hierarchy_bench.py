#!/usr/bin/env python3
"""Solves the scenes of make_scenes.py by each method and accuracy, and appends a CSV row for each: cost and error.

  hierarchy_bench.py PROGRAM FOLDER [--scenes a,b] [--methods a,b] [--accuracies a,b] [--threads 2,1]
                     [--repeat 3] [--timeout 180] [--out history/hierarchy.csv]

FOLDER      holds the scenes, and the references of path_reference in FOLDER/ref/SCENE.csv; without a reference the row
            has cost only
--threads   one row for each number; the first is used for the errors
seconds     wall time of the whole command with 2,000 sensors: the best of --repeat; cpu_seconds likewise;
            seconds_median is the median
rms ... total       of the sensors, field_*: of the written field, in per cent; see compare.py
p99_lit, field_p99_lit   the same over points above 2 % of the mean: without the gap between lamp and ceiling
memory      MiB, peak of the whole process
leak        largest value in the dark room over the mean of the lit ones
Standard library only.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys
import time

sys.dont_write_bytecode = True  # leaves no __pycache__ in the sources
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import compare  # noqa: E402

COLUMNS = ("commit,cores,cpu,scene,method,accuracy,elements,links,seconds,cpu_seconds,memory,rms,median,p95,p99,total,"
           "field_rms,field_p95,field_p99,imbalance,seconds_median,points,rays,p99_lit,field_p99_lit,leak").split(",")
SCENES = "room_lamp,room_cornell_mm,room_uplight,room_thread,room_sunpatch,sealed_slab,sealed_sheet"


def timed(command, timeout):
    """(exit code or None when it was stopped, wall seconds, CPU seconds, peak MiB)"""
    start = time.monotonic()
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    while True:
        pid, status, usage = os.wait4(child.pid, os.WNOHANG)
        wall = time.monotonic() - start
        if pid:
            message = child.stderr.read().decode(errors="replace").strip()
            child.returncode = os.waitstatus_to_exitcode(status)
            if child.returncode not in (0, 4):
                print("\n".join(message.splitlines()[-3:]), file=sys.stderr)
            return child.returncode, wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024
        if wall > timeout:
            child.kill()
            _, _, usage = os.wait4(child.pid, 0)
            child.returncode = -9
            return None, wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024
        time.sleep(0.002)


def commit():
    try:
        here = os.path.dirname(os.path.abspath(__file__))
        return subprocess.run(["git", "-C", here, "rev-parse", "--short", "HEAD"], capture_output=True,
                              text=True).stdout.strip() or "unknown"
    except OSError:
        return "unknown"


def cpu():
    with open("/proc/cpuinfo") as file:
        for line in file:
            if line.startswith("model name"):
                return line.split(":")[1].strip().replace(",", " ")
    return "unknown"


def bench(a, scene, method, accuracy, threads):
    base, out = os.path.join(a.folder, scene), os.path.join(a.folder, "out_%s_%s_%s" % (scene, method, accuracy))
    command = [a.program, "solve", base + ".json", "-o", out + ".vtp", "--method", method, "--accuracy", accuracy,
               "--sensors", base + ".csv", "--sensors-out", out + ".csv", "--report", out + ".report", "--threads",
               str(threads), "--quiet"]
    runs = []
    for _ in range(a.repeat):
        code, wall, cpu_seconds, memory = timed(command, a.timeout)
        if code not in (0, 4):
            what = "stopped after %.0f s" % a.timeout if code is None else "exit code %d" % code
            print(f"{scene} {method} {accuracy}: {what}, {cpu_seconds:.1f} CPU s, {memory:.0f} MiB", file=sys.stderr)
            return None
        runs.append((wall, cpu_seconds, memory))
        if wall > a.timeout / 6:
            break  # long runs are not repeated
    with open(out + ".report") as file:
        report = json.load(file)
    with open(base + ".info") as file:
        info = json.load(file)
    counts = report["counts"]
    row = {"scene": scene, "method": method, "accuracy": accuracy, "cores": threads, "elements": counts["elements"],
           "links": counts["links"], "points": counts["points"], "rays": counts["rays"],
           "seconds": round(min(r[0] for r in runs), 3), "cpu_seconds": round(min(r[1] for r in runs), 3),
           "seconds_median": round(statistics.median(r[0] for r in runs), 3),
           "memory": round(max(r[2] for r in runs), 1), "imbalance": "%.3g" % report["energy"]["imbalance"]}
    reference = os.path.join(a.folder, "ref", info["reference"] + ".csv")
    if os.path.exists(reference):
        result = compare.compare(reference, out + ".csv", out + ".vtp", base + ".csv", info)
        for name, prefix in (("sensors", ""), ("field", "field_")):
            for figure, value in result[name].items():
                row[prefix + figure] = round(value, 4)
        if "leak" in result:
            row["leak"] = "%.3g" % result["leak"]
        if result["missed"]:
            print(f"{scene} {method} {accuracy}: {result['missed']} points lie on no triangle", file=sys.stderr)
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("--scenes", default=SCENES)
    parser.add_argument("--methods", default="progressive")
    parser.add_argument("--accuracies", default="draft,standard,fine")
    parser.add_argument("--threads", default="2")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--timeout", type=float, default=180)
    parser.add_argument("--out", help="append rows here; default: print them")
    a = parser.parse_args()
    names = {"commit": commit(), "cpu": cpu()}
    if not a.out or not os.path.exists(a.out):
        header = ",".join(COLUMNS)
        print(header) if not a.out else open(a.out, "w").write(header + "\n")
    for scene in a.scenes.split(","):
        for method in a.methods.split(","):
            for accuracy in a.accuracies.split(","):
                for threads in a.threads.split(","):
                    row = bench(a, scene, method, accuracy, int(threads))
                    if not row:
                        break
                    line = ",".join(str({**names, **row}.get(c, "")) for c in COLUMNS)
                    print(line, flush=True)
                    if a.out:
                        with open(a.out, "a") as file:
                            file.write(line + "\n")


if __name__ == "__main__":
    main()
