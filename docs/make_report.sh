#!/usr/bin/env bash
# Writes the report of the documentation anew:
#   docs/report/timesteps.html   estimated against true critical timesteps: all hard cases and lattices, the packings of
#                                examples/, and the cost up to a million balls
#   docs/report/steps.html       what a larger step costs in accuracy: a ball that bounces
# Takes some minutes on an idle machine; costs mean something on an idle one only. PROGRAM=... is another program than
# build/release/bin/eigengrain, SIZES=... other numbers of balls.
set -euo pipefail
cd "$(dirname "$0")/.."
program=${PROGRAM:-build/release/bin/eigengrain}
if [ -z "${PROGRAM:-}" ]; then
  cmake --preset release >/dev/null
  cmake --build --preset release --target eigengrain
fi
export OMP_WAIT_POLICY=passive
scenes=()
[ -d examples/scenes/hard_cases ] && scenes+=(examples/scenes/hard_cases)
scenes+=(examples/scenes/dense_packing.yaml examples/scenes/packing_10k.yaml examples/scenes/packing_100k.yaml)
mkdir -p docs/report
"$program" compare timesteps "${scenes[@]}" --sizes "${SIZES:-100,1000,10000,100000,1000000}" \
  --output docs/report/timesteps.html
"$program" compare steps examples/scenes/bouncing_ball.yaml --output docs/report/steps.html
