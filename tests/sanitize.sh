#!/usr/bin/env bash
# Builds the unit and law tests with assertions, warnings as errors and sanitizers, and runs them: before a release and
# after changes of memory or indices. Not a part of run.sh, which it would take beyond half an hour.
set -euo pipefail
cd "$(dirname "$0")/.."
export OMP_WAIT_POLICY=passive
jobs=${JOBS:-$(nproc)}
cmake --preset dev >/dev/null
cmake --build --preset dev -j "$jobs" --target test_unit --target test_laws
ctest --preset dev -j "$jobs" -L '^(unit|laws)$'
