#!/usr/bin/env bash
# Builds the documentation as a site, to be read from its files without any server:
#   docs/build_site.sh [OUT]         default: build/site; begin at OUT/index.html
# Commands, keys of scenes and the Python reference come from the program and the package as they are built:
# PROGRAM=... and PYTHONPATH=... are others than those of build/release. INSTALL=no installs nothing.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
out=$(realpath -m "${1:-$root/build/site}")
program=${PROGRAM:-$root/build/release/bin/eigengrain}
export PYTHONPATH=${PYTHONPATH:-$root/build/release/lib/python} PYTHONDONTWRITEBYTECODE=1
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
[ "${INSTALL:-yes}" = no ] || "$root/cmake/dependencies.sh" "$root/docs/packages.txt"
[ -x "$program" ] || { echo "$program is not there; build it first: cmake --build --preset release" >&2; exit 1; }

# Debian's packages are those of its own python3, whatever else is called so.
python=/usr/bin/python3
work=$out.work
mkdir -p "$work" "$out"

# The C++ reference, beside the rest. The first entry of its list of pages leads back to the others.
doxygen -l "$work/layout.xml"
sed -i '0,/<navindex>/s//<navindex><tab type="user" url="..\/index.html" title="All documentation"\/>/' "$work/layout.xml"
(cat "$root/docs/site/Doxyfile"
 printf '%s\n' "INPUT = $root/include" "STRIP_FROM_PATH = $root/include" "OUTPUT_DIRECTORY = $out" "HTML_OUTPUT = cpp" \
   "HTML_EXTRA_STYLESHEET = $root/docs/site/static/cpp.css" "LAYOUT_FILE = $work/layout.xml") >"$work/Doxyfile"
doxygen "$work/Doxyfile" &
cpp=$!
trap 'kill $cpp 2>/dev/null || true' EXIT

"$python" "$root/docs/site/stage.py" "$program" "$work/source"
"$python" -m sphinx -q -W --keep-going -b html -c "$root/docs/site" -d "$work/doctrees" "$work/source" "$out"
wait $cpp
