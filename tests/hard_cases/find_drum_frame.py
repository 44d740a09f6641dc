#!/usr/bin/env python3
"""Writes the balls of a drum in motion as a packing: a frame that estimates are asked about.

    find_drum_frame.py build/release/bin/eigengrain --time 0.5 > examples/scenes/hard_cases/drum_frame.txt

Runs examples/scenes/drum.yaml and takes the places of the balls at the end; velocities and shear forces are left out.
"""
import argparse
import pathlib
import subprocess
import tempfile

import h5py
import numpy as np

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("program")
parser.add_argument("--time", type=float, default=0.5, help="s")
arguments = parser.parse_args()

scene = pathlib.Path(__file__).parents[2] / "examples/scenes/drum.yaml"
with tempfile.TemporaryDirectory() as folder:
    subprocess.run([arguments.program, "run", str(scene), "--set", f"run.time={arguments.time}", "--output", folder],
                   check=True, stdout=subprocess.DEVNULL)
    with h5py.File(pathlib.Path(folder) / "drum.h5") as state:
        order = np.argsort(state["bodies/identity"][:])
        balls = np.column_stack([state["bodies/position"][:], state["bodies/radius"][:]])[order]

print(f"# x y z r of the balls of drum.yaml at t = {arguments.time:g} s, m (tests/hard_cases/find_drum_frame.py)")
for x, y, z, r in balls:
    print(f"{x:.9g} {y:.9g} {z:.9g} {r:.6g}")
