#!/usr/bin/env python3
"""A year in parts on the workers of a Dask cluster, put together when all are done.

    pip install "dask[distributed]"
    python3 dask_year.py office.json city.epw --parts 8 -o year.vtp --scheduler tcp://head:8786

Without --scheduler a worker a core is started on this computer. All workers see the same files under the same names.
Options behind -- go to clerestory annual:  ... -- --accuracy fine --schedule 9-17
"""

import argparse
import os
import pathlib
import subprocess
import sys

from distributed import Client


def run(words, folder):
    """Runs the program there; what it says of a failure becomes that of the task."""
    done = subprocess.run(words, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(words)}: exit code {done.returncode}: {done.stderr.strip()[-1000:]}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("weather")
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--parts", type=int, default=8)
    parser.add_argument("--scheduler", help="address of the cluster (default: this computer)")
    words = sys.argv[1:]
    own = words.index("--") if "--" in words else len(words)
    asked = parser.parse_args(words[:own])

    output = pathlib.Path(asked.output).resolve()
    files = [str(output.with_suffix(f".part_{i}.vtp")) for i in range(1, asked.parts + 1)]
    # Each part is a process of its own: one thread of Dask for it, and one of the program.
    client = Client(asked.scheduler) if asked.scheduler else Client(threads_per_worker=1)
    with client:
        tasks = [
            client.submit(
                run,
                ["clerestory", "annual", asked.scene, "--weather", asked.weather, "--part", f"{i}/{asked.parts}"]
                + ["-o", file, "--threads", "1", "--quiet"]
                + words[own + 1 :],
                os.getcwd(),
                key=f"part {i} of {asked.parts} of {output}",
                retries=2,
                pure=False,
            )
            for i, file in enumerate(files, 1)
        ]
        client.gather(tasks)  # raises what a part failed with
    subprocess.run(["clerestory", "merge", *files, "-o", str(output)], check=True)


if __name__ == "__main__":
    main()
