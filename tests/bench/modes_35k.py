#!/usr/bin/env python3
"""Modes and density of states at the size of a study of the literature: 35,201 spheres, 211,206 unknowns (Otsubo et al.,
Granular Matter, 2017). Theirs are pressed between walls; here they are the lowest 35,201 balls of the settled bed of
examples/data/packing_100k.txt, in its open box.

    modes_35k.py [FOLDER]      writes modes_35k.png and prints what each part costs

Needs the Python package (PYTHONPATH=build/release/lib/python).
"""
import pathlib
import resource
import sys
import time

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import eigengrain
import eigengrain.plot

BALLS = 35_201
ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")


def timed(name, work):
    start, cpu = time.perf_counter(), time.process_time()
    result = work()
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    print(f"{name:28} {time.perf_counter() - start:7.1f} s ({time.process_time() - cpu:.1f} s of processors), "
          f"{memory:.2f} GB at most so far", flush=True)
    return result


rows = np.loadtxt(ROOT / "examples" / "data" / "packing_100k.txt")
rows = rows[np.argsort(rows[:, 2])][:BALLS]
side = float(open(ROOT / "examples" / "data" / "packing_100k.txt").readline().split()[2])
scene = {"materials": [{"name": "grain", "density": 2500}],
         "contacts": [{"between": ["grain", "grain"], "law": "linear", "kn": 1e5, "ks": 5e4, "friction": 0.5}],
         "balls": [{"array": rows, "material": "grain"}],
         "walls": [{"box": {"min": [0, 0, 0], "max": [side, side, 1], "open": ["+z"]}, "material": "grain"}]}
bed = timed("scene", lambda: eigengrain.load(scene))
system = timed("K, M", bed.system)
print(f"{len(bed.bodies)} balls, {len(system.elements)} contacts, {system.size} unknowns, {len(system.set_aside)} balls set aside")
found = timed("true critical timestep", lambda: bed.timestep(certify="never"))
print(f"true step {found.true.dt:.6e} s, residual {found.true.residual:.0e}")
high = timed("20 highest modes", lambda: system.highest_modes(20))
low = timed("20 lowest modes", lambda: system.lowest_modes(20))
density = timed("density of states", lambda: system.density_of_states(bins=80, moments=1024))
for name, modes in (("highest", high), ("lowest", low)):
    print(f"{name}: {modes.frequencies.min():.4g} to {modes.frequencies.max():.4g} rad/s, residuals up to "
          f"{modes.residuals.max():.0e}, participation {modes.participation.min():.2g} to {modes.participation.max():.2g}, "
          f"translations {modes.translation.min():.2f} to {modes.translation.max():.2f}")
print(f"density: {density.products} products, error of a bin {np.median(density.error / np.maximum(density.count, 1)):.1%} "
      f"(median), resolution {density.resolution / density.edges[-1]:.2%} of the range")
figure, axes = plt.subplots(1, 2, figsize=(10, 4), layout="constrained", dpi=110)
eigengrain.plot.density_of_states(density, axes[0])
eigengrain.plot.participation(low, high, axes=axes[1])
figure.savefig(FOLDER / "modes_35k.png")
