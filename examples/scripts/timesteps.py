#!/usr/bin/env python3
"""Tutorial 1: estimated against true critical timesteps, in Python.

    timesteps.py [FOLDER]        default: the current folder; the picture is FOLDER/timesteps.png

Explicit DEM is stable below a step Δt = 2/√λ, λ the largest eigenvalue of K x = λ M x. Codes do not compute it: they
estimate it, and multiply by a safety factor. Here is what that costs, or risks.
"""
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import numpy as np

import eigengrain
import eigengrain.plot

SCENES = pathlib.Path(__file__).resolve().parents[1] / "scenes"
FOLDER = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
FOLDER.mkdir(parents=True, exist_ok=True)

# 10,000 balls that settled in an open box. `load` reads the scene, finds the contacts and makes a state of it.
bed = eigengrain.load(SCENES / "packing_10k.yaml")
print(bed)

# The truth is an eigenvalue, with its residual; estimates stand beside it, each by its name.
found = bed.timestep()
print(f"true critical timestep {found.true.dt:.6e} s (residual {found.true.residual:.0e}), of the damped cycle "
      f"{found.true.limit:.6e} s")
rule = found["diagonal"]
print(f"PFC3D's rule: {rule.dt:.6e} s, {rule.ratio_to_true:.3f} of the truth: {1 / rule.ratio_to_true:.2f} times as many "
      "steps as are needed, before any safety factor")

# All of them at a look. What is right of the line would have let the run blow up.
axes = eigengrain.plot.timesteps(found)
axes.set_title("10,000 settled balls")
axes.figure.savefig(FOLDER / "timesteps.png")

# The same rule is unsafe elsewhere: two balls whose contact stands along (1, 1, 1).
pair = {"materials": [{"name": "grain", "density": 2500}],
        "contacts": [{"between": ["grain", "grain"], "law": "linear", "kn": 1e5, "ks": 0, "friction": 0}],
        "balls": [{"position": [0, 0, 0], "radius": 0.005, "material": "grain"},
                  {"position": list(np.full(3, (0.01 - 1e-9) / np.sqrt(3))), "radius": 0.005, "material": "grain"}]}
rule = eigengrain.load(pair).timestep()["diagonal"]
print(f"two balls along (1, 1, 1): PFC3D's rule is {rule.ratio_to_true:.4f} of the truth (√1.5 = {np.sqrt(1.5):.4f}), "
      f"{'safe' if rule.safe else 'UNSAFE'}")

# Softer contacts allow longer steps, by the root of the stiffness; settings of a state change like those of a scene.
softer = bed.with_settings({"contacts.0.kn": 2.5e4, "contacts.0.ks": 1.25e4}).timestep(certify="never")
print(f"a quarter of the stiffness: {softer.true.dt / found.true.dt:.6f} times the step")

assert not rule.safe and abs(rule.ratio_to_true - np.sqrt(1.5)) < 1e-6
assert abs(softer.true.dt / found.true.dt - 2) < 1e-9
