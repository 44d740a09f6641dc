#!/usr/bin/env bash
# Builds the preset `bench`, runs the benchmarks and writes Markdown tables, to stdout or to a file.
#   tests/bench/run.sh [--full] [FILE]      --full: a million bodies too (minutes, and several GB)
set -euo pipefail
tree=$(cd "$(dirname "$0")/../.." && pwd)

filter='-bodies:1000000(/|$)'
if [ "${1:-}" = --full ]; then
  filter=.
  shift
fi
out=$(realpath -ms "${1:-/dev/stdout}")
cd "$tree"

cmake --preset bench >/dev/null
cmake --build --preset bench --target bench >&2
results=$(mktemp)
trap 'rm -f "$results"' EXIT
# Threads that wait sleep: on a machine that does other things too, spinning takes the time of those it waits for.
OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMP_WAIT_POLICY=passive \
  build/bench/bin/bench --benchmark_filter="$filter" --benchmark_min_time=0.2 --benchmark_repetitions=3 \
  --benchmark_report_aggregates_only=true --benchmark_out="$results" --benchmark_out_format=json >&2
python3 tests/bench/table.py "$results" >"$out"
