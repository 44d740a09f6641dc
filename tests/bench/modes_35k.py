#!/usr/bin/env python3
"""Modes and density of states at the size of a study of the literature: 35,201 spheres, 211,206 unknowns (Otsubo et al.,
Granular Matter, 2017).

    modes_35k.py [FOLDER] [BALLS]      writes modes_35k.png and prints what each part costs; an hour, half of it the packing

Only the size and the kind of the contacts are theirs. Here equal glass balls are pressed together without friction, in a
cell that repeats along all axes, until contacts overlap by 2e-4; then they get Hertz's contacts with friction, which find
their own equilibrium. So rattlers are few, and no wall has a part in the modes. Needs the Python package
(PYTHONPATH=build/release/lib/python).
"""
import pathlib
import sys
import time

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import eigengrain
import eigengrain.plot

FOLDER = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
BALLS = int(sys.argv[2]) if len(sys.argv) > 2 else 35_201
RADIUS = 1e-3  # m
# Dense fillings begin with balls of 0.64 of the volume, to half a ball, so the edge decides how many there are.
EDGE = (BALLS * 4 / 3 * np.pi * RADIUS**3 / 0.64) ** (1 / 3)
FOLDER.mkdir(parents=True, exist_ok=True)
# On a busy machine the second one says more; it counts all threads.
CLOCKS = (time.perf_counter, time.process_time)


def forget_peak():
    """So that each part shows its own peak (Linux; elsewhere that of all so far)."""
    try:
        pathlib.Path("/proc/self/clear_refs").write_text("5")
    except OSError:
        pass


def peak():
    """Largest memory that was in use, GB."""
    for line in pathlib.Path("/proc/self/status").read_text().splitlines():
        if line.startswith("VmHWM:"):
            return int(line.split()[1]) / 1e6
    return float("nan")


def timed(name, work):
    forget_peak()
    start = [clock() for clock in CLOCKS]
    result = work()
    wall, processors = (clock() - before for clock, before in zip(CLOCKS, start))
    print(f"| {name} | {wall:.1f} | {processors:.1f} | {peak():.2f} |", flush=True)
    return result


def scene():
    return {"materials": [{"name": "glass", "density": 2500, "young": 70e9, "poisson": 0.2}],
            "contacts": [{"between": ["glass", "glass"], "law": "hertz", "friction": 0.3}],
            "periodic": {"box": [EDGE] * 3},
            "balls": [{"fill": "dense", "mean_overlap": 2e-4, "radius": RADIUS, "seed": 1, "material": "glass"}]}


print("| | s | s of processors | GB at most |\n| --- | ---: | ---: | ---: |")
cell = timed("packing", lambda: eigengrain.load(scene()))
found = timed("equilibrium", cell.relax)
system = timed("system", cell.system)
step = timed("true critical timestep", lambda: cell.timestep(certify="never"))
high = timed("20 highest modes", lambda: system.highest_modes(20))
low = timed("20 lowest modes", lambda: system.lowest_modes(20))
density = timed("density of states", lambda: system.density_of_states(bins=80, moments=1024))

pressure = -np.trace(cell.measure().stress) / 3
print(f"\n{len(cell.bodies)} balls, {len(system.elements)} contacts, {system.size} unknowns, {len(system.set_aside)} balls "
      f"without acting contacts; pressure {pressure:.4g} Pa")
print(f"equilibrium: {found.method}, {found.steps} cycles, {found.iterations} iterations of Newton, unbalanced ratio from "
      f"{found.start.mean:.1e} to {found.end.mean:.1e}")
print(f"true step {step.true.dt:.6e} s, residual {step.true.residual:.0e}, {step.true.products} products; PFC3D's rule "
      f"{step['diagonal'].ratio_to_true:.4f} of it, scaled block bound {step['scaled-block-bound'].ratio_to_true:.4f}")
for name, modes in (("highest", high), ("lowest", low)):
    print(f"{name}: {modes.frequencies.min():.5g} to {modes.frequencies.max():.5g} rad/s, residuals up to "
          f"{modes.residuals.max():.0e}, participation {modes.participation.min():.2g} to {modes.participation.max():.2g}, "
          f"translations {modes.translation.min():.2f} to {modes.translation.max():.2f}")
print(f"density: {density.products} products, error of a bin {np.median(density.error / np.maximum(density.count, 1)):.1%} "
      f"(median), resolution {density.resolution / density.edges[-1]:.2%} of the range")
figure, axes = plt.subplots(1, 2, figsize=(10, 4), layout="constrained", dpi=110)
eigengrain.plot.density_of_states(density, axes[0])
eigengrain.plot.participation(low, high, axes=axes[1])
figure.savefig(FOLDER / "modes_35k.png")

# The same number by two ways, each with its residual: 2/sqrt(lambda_max) by Lanczos and by block methods.
assert abs(step.true.dt * high.frequencies.max() / 2 - 1) < 1e-8
assert density.count.sum() > 0 and abs(density.count.sum() / density.modes - 1) < 1e-9
