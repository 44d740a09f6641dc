#!/usr/bin/env bash
# Are all sources as clang-format would write them? With --fix: makes them so.
set -euo pipefail
cd "$(dirname "$0")/.."
options=(--dry-run -Werror)
[ "${1:-}" = --fix ] && options=(-i)
find include src solvers python tests examples \( -name '*.cpp' -o -name '*.hpp' \) -print0 |
  xargs -0 clang-format --style=file "${options[@]}"
