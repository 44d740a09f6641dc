#!/usr/bin/env python3
"""The density of states by random vectors against every mode, in a packing of some thousand balls.

    density_of_states.py [EDGE] [FRICTION]     a periodic cube of this edge, m; default 0.13 (3,000 balls), no friction

Needs the Python package (PYTHONPATH=build/release/lib/python). Prints each bin, by how many of its standard errors it is off, and
what both cost. All modes take 8 bytes for the square of the unknowns and some minutes.
"""
import sys
import time

import numpy as np

import eigengrain

EDGE = float(sys.argv[1]) if len(sys.argv) > 1 else 0.13
FRICTION = float(sys.argv[2]) if len(sys.argv) > 2 else 0.0

state = eigengrain.load({
    "materials": [{"name": "grain", "density": 2500}],
    "contacts": [{"between": ["grain", "grain"], "law": "linear", "kn": 1e5, "ks": 5e4 if FRICTION > 0 else 0,
                  "friction": FRICTION}],
    "periodic": {"box": [EDGE] * 3},
    "balls": [{"fill": "dense", "mean_overlap": 1e-3, "seed": 1, "material": "grain",
               "sizes": {"distribution": "lognormal", "mean": 4.6e-3, "deviation": 0.5e-3, "min": 3e-3, "max": 7e-3}}]})
system = state.system()
print(f"{len(state.bodies)} balls, {len(system.free)} unknowns")
found = system.density_of_states(bins=40, moments=512, vectors=16)
print(f"by random vectors: {found.products} products, {found.seconds:.1f} s")
start = time.perf_counter()
frequencies = system.all_modes().frequencies
print(f"all modes: {time.perf_counter() - start:.1f} s")
counted, _ = np.histogram(frequencies, bins=found.edges)
off = (found.count - counted) / found.error
for low, by_vectors, error, exact, sigmas in zip(found.edges, found.count, found.error, counted, off):
    print(f"{low:10.4g} rad/s  {by_vectors:8.2f} +- {error:5.2f}  counted {exact:5d}  off by {sigmas:5.2f} errors")
print(f"root mean square {np.sqrt((off**2).mean()):.2f} errors; within two: {(np.abs(off) <= 2).mean():.3f}; "
      f"largest {np.abs(off).max():.2f}")
