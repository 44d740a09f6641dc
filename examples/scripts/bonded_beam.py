#!/usr/bin/env python3
"""Tutorial 5: a beam of bonded balls, bent and in vibration, against beam theory.

    bonded_beam.py [FOLDER] [BALLS]     default: the current folder, and 21 balls

A row of balls with parallel bonds (PFC3D 1.6) is a beam of short elements: each bond bends by M/(k_n I) and shears by
Q/(k_s A), A and I of its disk. So the cantilever with a force F at its end has a closed form, and for long beams it is
that of Euler and Bernoulli with E = k_n 2R. The first is met to the digits of the small deflection, the second as the
elements get shorter. Frequencies come from K and M without any run. The picture is bonded_beam.png.
"""
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import eigengrain
import eigengrain.plot

FOLDER = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
BALLS = int(sys.argv[2]) if len(sys.argv) > 2 else 21
FOLDER.mkdir(parents=True, exist_ok=True)

R, DENSITY, FORCE = 5e-3, 2500.0, 1e-2  # m, kg/m3, N
KN, KS = 1e10, 5e9  # of the bonds, Pa/m
AREA, INERTIA = np.pi * R**2, np.pi * R**4 / 4
BONDS = BALLS - 1
LENGTH = 2 * R * BONDS


def ball(k):
    entry = {"position": [2 * R * k, 0, 0], "radius": R, "material": "grain"}
    if k == 0:
        return entry | {"fix": ["all"]}
    return entry | ({"force": [0, 0, -FORCE]} if k == BONDS else {})


state = eigengrain.load({
    "materials": [{"name": "grain", "density": DENSITY}],
    # The contact's own spring would add to the bond where balls press each other: next to nothing.
    "contacts": [{"between": ["grain", "grain"], "law": "linear", "kn": 1e-3,
                  "bond": {"kind": "parallel", "kn": KN, "ks": KS, "gap": 1e-9}}],
    "balls": [ball(k) for k in range(BALLS)]})
state.relax(1e-8)  # rounding of places against springs that are this stiff allows little less
place = state.bodies.in_scene_order(state.bodies.position)
deflection = -place[:, 2]

# Bond j, at (2j - 1)R, bears the force F and the moment F (L - x_j); each ball behind it goes down by both.
x = 2 * R * np.arange(BALLS)
at = (2 * np.arange(1, BALLS) - 1) * R
behind = np.maximum(x[:, None] - at, 0) * (x[:, None] > at)
exact = (FORCE * (LENGTH - at) / (KN * INERTIA) * behind + FORCE / (KS * AREA) * (x[:, None] > at)).sum(axis=1)
young = KN * 2 * R
beam = FORCE * x**2 * (3 * LENGTH - x) / (6 * young * INERTIA)
tip = deflection[-1]
print(f"{BALLS} balls: the end goes down by {tip:.6e} m, the closed form is {exact[-1]:.6e} m "
      f"({tip / exact[-1] - 1:+.1e}), Euler and Bernoulli {beam[-1]:.6e} m ({tip / beam[-1] - 1:+.1e})")

# A cantilever's first frequencies; a ball has the mass 4/3 pi R^3 rho for each 2R, and some inertia against rotation.
per_length = DENSITY * 4 / 3 * np.pi * R**3 / (2 * R)
modes = state.system().lowest_modes(8)
bending = modes.frequencies[:2]  # in both planes alike
theory = 1.8751040687**2 * np.sqrt(young * INERTIA / (per_length * LENGTH**4))
print(f"lowest frequency {bending[0]:.5g} and {bending[1]:.5g} rad/s, Euler and Bernoulli {theory:.5g} "
      f"({bending[0] / theory - 1:+.1e})")

figure, axes = plt.subplots(figsize=(6.5, 3.6), layout="constrained", dpi=150)
axes.plot(1e3 * x, 1e6 * beam, color=eigengrain.plot.GREY, label="Euler and Bernoulli")
axes.plot(1e3 * x, 1e6 * exact, color=eigengrain.plot.BLUE, linestyle="--", label="elements of bonds, closed form")
axes.plot(1e3 * x, 1e6 * deflection, "o", markersize=3, color=eigengrain.plot.VERMILION, label="balls in equilibrium")
axes.set_xlabel("along the beam [mm]")
axes.set_ylabel("deflection [µm]")
axes.invert_yaxis()
axes.legend(frameon=False)
figure.savefig(FOLDER / "bonded_beam.png")

slope = exact[-1] / LENGTH
assert abs(tip / exact[-1] - 1) < 2 * slope**2, "small deflections are those of the closed form"
# The half elements at the ends, and shear: of order (R/L).
assert abs(tip / beam[-1] - 1) < 4 * R / LENGTH
assert abs(bending[0] / theory - 1) < 4 * R / LENGTH
