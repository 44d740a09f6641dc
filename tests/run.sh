#!/usr/bin/env bash
# Installs what is missing, builds, and runs every test. What is built and why: CONTRIBUTING.md.
set -euo pipefail
cd "$(dirname "$0")/.."
cmake/dependencies.sh tests/peers/packages.txt docs/packages.txt
# Everything stays on this machine: no network between MPI processes, and root may start them.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
# Tests run beside each other: threads that wait for the others of their program must not hold the cores meanwhile.
export OMP_WAIT_POLICY=passive
jobs=${JOBS:-$(nproc)}

run() { # run PRESET [targets] [-- ctest options]: configure, build and test one preset
  local preset=$1 targets=()
  shift
  while [ "$#" -gt 0 ] && [ "$1" != -- ]; do targets+=(--target "$1") && shift; done
  [ "${1:-}" = -- ] && shift
  cmake --preset "$preset" >/dev/null
  cmake --build --preset "$preset" -j "$jobs" "${targets[@]}"
  ctest --preset "$preset" -j "$jobs" "$@"
}

run release
# The same objects without PETSc: the question is whether they link and the program knows what it lacks.
run minimal eigengrain test_unit -- -L '^(cli|install)$'
