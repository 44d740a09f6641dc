#!/usr/bin/env bash
# Builds the unit and law tests with assertions, warnings as errors and sanitizers, and runs them, and compiles every
# public header alone: before a release and after changes of memory, indices or includes. Not a part of run.sh, which it
# would take beyond half an hour.
set -euo pipefail
cd "$(dirname "$0")/.."
export OMP_WAIT_POLICY=passive
jobs=${JOBS:-$(nproc)}
cmake --preset dev >/dev/null
cmake --build --preset dev -j "$jobs" --target test_unit --target test_laws --target headers_alone
ctest --preset dev -j "$jobs" -L '^(unit|laws)$'
