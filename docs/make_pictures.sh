#!/usr/bin/env bash
# Draws the pictures of the tutorials anew, into docs/pictures; takes some minutes, most of them for the heaps.
# PROGRAM=... and PYTHONPATH=... are others than those of build/release.
set -euo pipefail
cd "$(dirname "$0")/.."
program=${PROGRAM:-build/release/bin/eigengrain}
export PYTHONPATH=${PYTHONPATH:-$PWD/build/release/lib/python} OMP_WAIT_POLICY=passive
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for script in timesteps triaxial jamming moduli bonded_beam; do
  /usr/bin/python3 "examples/scripts/$script.py" "$work"
done
/usr/bin/python3 examples/scripts/few_balls.py "$program" "$work"
/usr/bin/python3 examples/scripts/heap.py --program "$program" --folder "$work"
# With 128 colours they are a third as large, and look the same.
/usr/bin/python3 - "$work" docs/pictures <<'END'
import pathlib, sys
from PIL import Image
for path in sorted(pathlib.Path(sys.argv[1]).glob("*.png")):
    picture = Image.open(path).convert("RGB").quantize(128, dither=Image.Dither.NONE)
    picture.save(pathlib.Path(sys.argv[2]) / path.name, optimize=True)
END
