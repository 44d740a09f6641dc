#!/usr/bin/env bash
# From a bare Debian 12 to the true critical timestep of two packings and an equilibrium: installs what is missing (as
# root or through sudo), builds the program, and asks it. May be started from any folder, and again at any time.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

cmake/dependencies.sh
cmake --preset release >/dev/null
cmake --build --preset release --target eigengrain

say() { printf '\n$ %s\n' "$*"; "$@"; }
program=build/release/bin/eigengrain
say "$program" check examples/scenes/packing_10k.yaml
say "$program" timestep examples/scenes/packing_10k.yaml
say "$program" timestep examples/scenes/packing_100k.yaml
results=build/quickstart
say "$program" relax examples/scenes/packing_10k.yaml --set "gravity=[1.7035, 0, -9.6610]" --output "$results"
say "$program" run "$results/packing_10k-relaxed.h5" --set run.steps=1000 --output "$results"

cat <<END

That was the estimated and the true critical timestep of 10,000 and 100,000 balls; then the equilibrium of 10,000 after
gravity had tilted by 10 degrees, and 1,000 cycles from there, which keep it. From here, in $PWD:
  $program timestep --help
      what else it takes, e.g. --json FILE, --set contacts.0.kn=2e5
  examples/scenes/packing_10k.yaml
      the scene, to copy and change; docs/scene-schema.md has every key
  $program check MY_SCENE.yaml
      reports every mistake of a scene at once
  tests/run.sh
      builds and runs every test
END
