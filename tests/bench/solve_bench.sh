#!/usr/bin/env bash
# Solves the shipped scenes by each method and prints a CSV row for each; keep rows worth keeping in history/solve.csv.
#   bash tests/bench/solve_bench.sh [PROGRAM] >> tests/bench/history/solve.csv
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
program=${1:-build/release/bin/clerestory}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

figure() {  # the first value of that name in the report
  sed -n "s/^ *\"$1\": \([^,]*\),*$/\1/p" "$work/report.json" | head -n 1
}

commit=$(git rev-parse --short HEAD 2>/dev/null || echo unknown)
cpu=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1 | tr ',' ' ')
echo "commit,cores,cpu,scene,method,accuracy,elements,seconds,peak_memory_bytes,rms_error,rms_error_95,imbalance"
for scene in cornell_box furnace office house; do
  for method in progressive gauss-seidel path; do
    for accuracy in draft standard; do
      "$program" solve "data/scenes/$scene.json" -o "$work/out.vtp" --method "$method" --accuracy "$accuracy" --quiet \
        --report "$work/report.json" 2>/dev/null || continue  # a matrix that does not fit is refused
      echo "$commit,$(nproc),$cpu,$scene,$method,$accuracy,$(figure elements),$(figure total),$(figure peak_memory_bytes),$(
        figure rms_relative),$(figure confidence),$(figure imbalance)"
    done
  done
done
