#!/usr/bin/env python3
"""A day in one solve against one of its hours: CPU and wall seconds of whole commands, taken in turn.

    python3 tests/bench/day_of_hours.py build/release/bin/clerestory data/scenes/office_march.json \
        2026-03-21T06:00/20:00/PT1H 2026-03-21T12:00 [RUNS] [OPTIONS...]

Prints rows for history/day_of_hours.csv: what the day and the hour took (the fastest of RUNS, 3 unless said otherwise),
their ratio, and the error that each time says of itself.
"""

import json
import os
import resource
import subprocess
import sys
import tempfile
import time


def run(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    start = time.monotonic()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wall = time.monotonic() - start
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, wall


def scene_at(scene, hour):
    """The scene with another time, beside it: its files are named relative to it."""
    text = open(scene).read()
    at = text.index('"time"')
    begin = text.index('"', text.index(":", at)) + 1
    text = text[:begin] + hour + text[text.index('"', begin) :]
    file, name = tempfile.mkstemp(suffix=".json", dir=os.path.dirname(scene))
    with os.fdopen(file, "w") as out:
        out.write(text)
    return name


def main():
    program, scene, times, hour = sys.argv[1:5]
    runs = int(sys.argv[5]) if len(sys.argv) > 5 else 3
    options = sys.argv[6:]
    with tempfile.TemporaryDirectory() as folder:
        one = scene_at(scene, hour)
        report, report_of_hour = folder + "/day.json", folder + "/hour.json"
        commands = {
            "day": [program, "solve", scene, "-o", folder + "/day.pvd", "--times", times, "--report", report] + options,
            "hour": [program, "solve", one, "-o", folder + "/hour.vtp", "--report", report_of_hour] + options,
        }
        try:
            took = {name: [run(command) for _ in range(1)] for name, command in commands.items()}
            for _ in range(runs - 1):
                for name, command in commands.items():
                    took[name].append(run(command))
        finally:
            os.remove(one)
        best = {name: [min(column) for column in zip(*rows)] for name, rows in took.items()}
        day, alone = json.load(open(report)), json.load(open(report_of_hour))
        name, n = os.path.basename(scene), len(day["times"])
        print("scene,what,value,unit,bar")
        for k, kind in enumerate(("CPU", "wall")):
            print(f"{name},{n} times in one solve,{best['day'][k]:.3f},s {kind},")
            print(f"{name},one hour,{best['hour'][k]:.3f},s {kind},")
            print(f"{name},day against hour,{best['day'][k] / best['hour'][k]:.3f},1 ({kind}),4")
        for what, error in (("mean of the day", day["error"]), (hour + " alone", alone["error"])):
            print(f"{name},rms error said: {what},{100 * error['rms_relative']:.3f},%,")
        for at in day["times"]:
            if at["error"]:
                print(f"{name},rms error said: {at['time']},{100 * at['error']['rms_relative']:.3f},%,")


main()
