#!/usr/bin/env python3
"""Tutorial 4: elastic moduli, of crystals against closed forms and of random packings against mean field and pressure.

    moduli.py [FOLDER] [EDGE]     default: the current folder, and cells of 70 mm (some 500 balls)

In a face-centred lattice of springs k_n and k_s each ball is a centre of symmetry, so all follow the strain and the
moduli are sums over the contacts. In a random packing they do not, and how much softer it is than a strain that all
follow ("affine") says how far it is from a solid: without friction the shear modulus vanishes against the bulk modulus
as the pressure goes to zero (O'Hern et al., Phys. Rev. E 68, 011306, 2003). The picture is moduli.png.
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
EDGE = float(sys.argv[2]) if len(sys.argv) > 2 else 0.07  # m
FOLDER.mkdir(parents=True, exist_ok=True)
KN, KS, R = 1e5, 5e4, 5e-3  # N/m, m


def scene(balls, box, ks):
    friction = 0.5 if ks > 0 else 0
    return {"materials": [{"name": "grain", "density": 2500}],
            "contacts": [{"between": ["grain", "grain"], "law": "linear", "kn": KN, "ks": ks, "friction": friction}],
            "periodic": {"box": box}, "balls": [balls | {"material": "grain"}]}


# A crystal, pressed by next to nothing: C11 = sqrt 2 (k_n + k_s)/d, C12 = sqrt 2 (k_n - k_s)/2d, C44 = C11/2.
spacing = 2 * R * (1 - 1e-9)
crystal = eigengrain.load(scene({"lattice": "fcc", "radius": R, "spacing": spacing},
                                [3 * np.sqrt(2) * spacing] * 3, KS)).moduli()
closed = {"C11": np.sqrt(2) * (KN + KS) / spacing, "C12": np.sqrt(2) * (KN - KS) / (2 * spacing),
          "C44": np.sqrt(2) * (KN + KS) / (2 * spacing)}
for name, (i, j) in {"C11": (0, 0), "C12": (0, 1), "C44": (3, 3)}.items():
    error = crystal.stiffness[i, j] / closed[name] - 1
    print(f"fcc {name}: {crystal.stiffness[i, j]:.6e} Pa, closed form {closed[name]:.6e} Pa ({error:+.1e})")
    assert abs(error) < 1e-6

def voigt_shear(c):
    """Shear modulus of an isotropic mean of a 6x6 stiffness (Hill, Proc. Phys. Soc. A 65:349, 1952)."""
    diagonal, rest = np.trace(c[:3, :3]), c[0, 1] + c[0, 2] + c[1, 2]
    return (diagonal - rest + 3 * np.trace(c[3:, 3:])) / 15


sizes = {"distribution": "lognormal", "mean": 4.6e-3, "deviation": 0.5e-3, "min": 3e-3, "max": 7e-3}
figure, axes = plt.subplots(figsize=(6.5, 4), layout="constrained", dpi=150)
for ks, colour, name in [(0.0, eigengrain.plot.BLUE, "without shear springs"),
                         (KS, eigengrain.plot.VERMILION, "with shear springs")]:
    pressures, ratios, affine = [], [], []
    for overlap in (1e-4, 3e-4, 1e-3, 3e-3, 1e-2):
        state = eigengrain.load(scene({"fill": "dense", "mean_overlap": overlap, "seed": 1, "sizes": sizes},
                                      [EDGE] * 3, ks))
        found = state.moduli()
        mean_field = voigt_shear(found.affine)
        pressures.append(-np.trace(state.measure().stress) / 3)
        ratios.append(found.shear / found.bulk)
        affine.append(mean_field / found.bulk)
        print(f"{name}, overlap {overlap:g}: pressure {pressures[-1]:.4g} Pa, bulk {found.bulk:.4g} Pa, shear "
              f"{found.shear:.4g} Pa (mean field {mean_field:.4g} Pa)")
        assert found.shear < mean_field, "what follows its neighbours is softer than what follows the strain"
    axes.loglog(pressures, ratios, "o-", color=colour, markersize=4, label=f"{name}")
    axes.loglog(pressures, affine, ":", color=colour, label=f"{name}, mean field")
    if ks == 0:
        exponent = np.polyfit(np.log(pressures), np.log(ratios), 1)[0]
        print(f"shear over bulk modulus goes with the pressure to the power {exponent:.2f} (near jamming: 1/2)")
        assert ratios[0] < 0.5 * ratios[-1]
axes.set_xlabel("pressure [Pa]")
axes.set_ylabel("shear over bulk modulus")
axes.legend(frameon=False, fontsize="small")
figure.savefig(FOLDER / "moduli.png")
