#!/usr/bin/env python3
"""Tutorial 3: the density of states of packings near jamming, against pressure.

    density_of_states.py [FOLDER] [EDGE]     default: the current folder, and cells of 90 mm (some 1,000 balls)

Frictionless packings lose their rigidity where the pressure falls to zero (O'Hern et al., Phys. Rev. E 68, 011306,
2003): modes of low frequency appear that are no sound waves, and the density of states becomes flat down to a frequency
that falls with the pressure. The kernel polynomial method shows it for any size, with error bars.
The pictures are density_of_states.png and modes.png.
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
EDGE = float(sys.argv[2]) if len(sys.argv) > 2 else 0.09  # m
FOLDER.mkdir(parents=True, exist_ok=True)


def packing(overlap):
    """Frictionless balls of many sizes, pressed until contacts overlap by this part of their radii on average."""
    return eigengrain.load({
        "materials": [{"name": "grain", "density": 2500}],
        "contacts": [{"between": ["grain", "grain"], "law": "linear", "kn": 1e5, "ks": 0, "friction": 0}],
        "periodic": {"box": [EDGE] * 3},
        "balls": [{"fill": "dense", "mean_overlap": overlap, "seed": 1, "material": "grain",
                   "sizes": {"distribution": "lognormal", "mean": 4.6e-3, "deviation": 0.5e-3, "min": 3e-3,
                             "max": 7e-3}}]})


figure, axes = plt.subplots(figsize=(6.5, 4.2), layout="constrained", dpi=150)
lowest = {}
for overlap, colour in [(1e-2, eigengrain.plot.BLUE), (1e-3, eigengrain.plot.VERMILION)]:
    state = packing(overlap)
    pressure = -np.trace(state.measure().stress) / 3  # stresses are positive in tension
    # Modes of balls that are held: rattlers have no frequency.
    rigidity = state.rigidity(with_rattlers=False)
    system = state.system()
    density = system.density_of_states(bins=40, moments=512)
    eigengrain.plot.density_of_states(density, axes, colour=colour,
                                      label=f"overlap {overlap:g}, pressure {pressure / 1e3:.3g} kPa")
    modes = system.lowest_modes(10)
    lowest[overlap] = modes.frequencies[0]
    print(f"mean overlap {overlap:g}: pressure {pressure:.4g} Pa, {rigidity.excess} springs beyond isostaticity "
          f"({rigidity.excess / rigidity.bodies:.3f} a ball), slowest mode {modes.frequencies[0]:.4g} rad/s with "
          f"participation {modes.participation[0]:.3f}")
figure.savefig(FOLDER / "density_of_states.png")

# The slowest mode of the packing that is nearest to jamming is no plane wave.
axes = eigengrain.plot.mode_shape(state, modes, 0)
axes.figure.savefig(FOLDER / "modes.png")

assert lowest[1e-3] < lowest[1e-2], "rigidity is lost as the pressure falls"
