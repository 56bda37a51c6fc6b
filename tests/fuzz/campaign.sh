#!/usr/bin/env bash
# Looks for inputs that break a target, guided by coverage: clang's libFuzzer with address and undefined-behaviour
# sanitizers. Ends with 1 and their names when there are any.
#   --seconds S      on each target (600)
#   --executions N   instead: rounds of a minute on each target until there are N in all
#   --jobs J         targets at a time (all cores)
#   TARGET...        only these: ply, scene, ... (all)
# What a target's inputs cover is kept in build/fuzz/campaign/corpus, and the next campaign goes on from there. A row a
# target is added to tests/fuzz/history.csv.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

seconds=600 wanted=0 jobs=$(nproc) targets=()
while [ $# -gt 0 ]; do
  case $1 in
    --seconds) seconds=$2; shift ;;
    --executions) wanted=$2 seconds=60; shift ;;
    --jobs) jobs=$2; shift ;;
    -*) echo "usage: $0 [--seconds S | --executions N] [--jobs J] [TARGET...]" >&2; exit 2 ;;
    *) targets+=("$1") ;;
  esac
  shift
done

bash apps/install_dependencies.sh libgtest-dev clang-16 libclang-rt-16-dev
cmake --preset fuzz >/dev/null
[ ${#targets[@]} -gt 0 ] || mapfile -t targets < <(sed 's/^fuzz_//' build/fuzz/fuzz_targets.txt)
cmake --build --preset fuzz --target "${targets[@]/#/fuzz_}"

export root=$PWD work=$PWD/build/fuzz/campaign seconds
# Half as long for each input that is refused: exceptions leave much behind on a stack that is watched after return.
export ASAN_OPTIONS=detect_stack_use_after_return=0:malloc_context_size=5
memory=$(mktemp -d -p "$([ -w /dev/shm ] && echo /dev/shm || echo "${TMPDIR:-/tmp}")" clerestory_fuzz.XXXXXX)
export memory
trap 'rm -rf "$memory"' EXIT

# One target for a while: its figures to $memory/NAME.stats, "executions seconds edges inputs"; what it found to findings/NAME.
fuzz_one() {
  local name=$1 log=$work/log/$1.log dictionary=()
  [ ! -s "$root/tests/fuzz/dictionaries/$name.dict" ] || dictionary=(-dict="$root/tests/fuzz/dictionaries/$name.dict")
  local seeds=("$root/tests/fuzz/corpus/$name")
  [ ! -d "$root/tests/fuzz/found/$name" ] || seeds+=("$root/tests/fuzz/found/$name")
  mkdir -p "$work/corpus/$name" "$work/findings/$name" "$work/log" "$memory/$name"
  local start=$SECONDS
  (cd "$memory/$name" && "$root/build/fuzz/bin/fuzz_$name" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 \
    -print_final_stats=1 -artifact_prefix="$work/findings/$name/" "${dictionary[@]}" "$work/corpus/$name" "${seeds[@]}") \
    >"$log" 2>&1 || true
  awk -v seconds=$((SECONDS - start)) '
    { for (i = 1; i < NF; ++i) { if ($i == "cov:") edges = $(i + 1); if ($i == "corp:") split($(i + 1), inputs, "/") } }
    $1 == "stat::number_of_executed_units:" { executions = $2 }
    END { print executions + 0, seconds, edges + 0, inputs[1] + 0 }' "$log" >>"$memory/$name.stats"
}
export -f fuzz_one

findings_of() { find "$work/findings/$1" -type f 2>/dev/null | wc -l; }
sum() { cat "$memory"/*.stats | awk -v column="$1" '{ total += $column } END { print total + 0 }'; }

for name in "${targets[@]}"; do rm -rf "${work:?}/findings/$name"; done
done_so_far=0
while :; do
  printf '%s\n' "${targets[@]}" | xargs -P "$jobs" -I{} bash -c 'fuzz_one {}'
  echo "$(sum 1) executions in $(sum 2) s of runs"
  [ "$(sum 1)" -lt "$wanted" ] || break
  # Such a round would come again and again.
  [ "$(sum 1)" -gt "$done_so_far" ] || { echo "no target runs any more; see $work/log" >&2; exit 1; }
  done_so_far=$(sum 1)
  going=()  # a target that found something has ended
  for name in "${targets[@]}"; do [ "$(findings_of "$name")" -gt 0 ] || going+=("$name"); done
  [ ${#going[@]} -gt 0 ] || break
  targets=("${going[@]}")
done

history=tests/fuzz/history.csv
[ -s $history ] || echo "date,commit,cpu,target,executions,seconds,edges,inputs,findings" >$history
cpu=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1 | tr -d ',')
total=0
for stats in "$memory"/*.stats; do
  name=$(basename "$stats" .stats)
  found=$(findings_of "$name")
  total=$((total + found))
  awk -v start="$(date +%F),$(git describe --always --dirty),$cpu,$name" -v found="$found" '
    { executions += $1; seconds += $2; edges = $3; inputs = $4 }
    END { print start "," executions "," seconds "," edges "," inputs "," found }' "$stats" >>$history
done
echo "$(sum 1) executions, $total findings"
[ "$total" -eq 0 ] || { find "$work/findings" -type f; exit 1; }
