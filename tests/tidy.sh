#!/usr/bin/env bash
# clang-format and clang-tidy (.clang-tidy) over our sources, with all processors; several minutes, so not a part
# of run.sh. With --tests: over the tests too. With files: clang-tidy over these only. Needs the compile commands of
# the preset release: configures it.
set -euo pipefail
cd "$(dirname "$0")/.."
tests/format.sh
cmake --preset release >/dev/null
which=("^$PWD/(src|solvers)/")
if [ "${1:-}" = --tests ]; then
  which=("^$PWD/(src|solvers|tests)/")
elif [ "$#" -gt 0 ]; then
  which=("$@")
fi
run-clang-tidy -quiet -p build/release -j "${JOBS:-$(nproc)}" "${which[@]}"
