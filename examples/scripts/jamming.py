#!/usr/bin/env python3
"""Tutorial 3: the density of states of frictionless packings near jamming, against pressure.

    jamming.py [FOLDER] [EDGE]     default: the current folder, and cells of 85 mm (some 900 balls; a minute)

Frictionless balls jam when each has z = 6 contacts, one for each two of its three components: just as many springs as
unknowns. Pressed further, contacts beyond these come as z - 6 ~ √p (O'Hern et al., Phys. Rev. E 68, 011306, 2003). Near
jamming there are far more slow modes than sound waves: the density of states is flat down to a frequency ω* that goes to
zero as ω* ~ z - 6 ~ √p (Wyart, Nagel and Witten, Europhys. Lett. 72, 486, 2005). Here are five pressures over two decades,
with every mode. The pictures are jamming.png and modes.png.
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
EDGE = float(sys.argv[2]) if len(sys.argv) > 2 else 0.085  # m
FOLDER.mkdir(parents=True, exist_ok=True)
KN = 1e5  # N/m
OVERLAPS = (1e-4, 10**-3.5, 1e-3, 10**-2.5, 1e-2)  # mean ones, as parts of r_a + r_b


def packing(overlap):
    """Balls of many sizes, so that they do not crystallise, pressed until contacts overlap by this much on average."""
    return eigengrain.load({
        "materials": [{"name": "grain", "density": 2500}],
        "contacts": [{"between": ["grain", "grain"], "law": "linear", "kn": KN, "ks": 0, "friction": 0}],
        "periodic": {"box": [EDGE] * 3},
        "balls": [{"fill": "dense", "mean_overlap": overlap, "seed": 1, "material": "grain",
                   "sizes": {"distribution": "lognormal", "mean": 4.6e-3, "deviation": 0.5e-3, "min": 3e-3,
                             "max": 7e-3}}]})


figure, ((states, scaling), (excess, shares)) = plt.subplots(2, 2, figsize=(10, 8), layout="constrained", dpi=110)
colours = matplotlib.colormaps[eigengrain.plot.COLOURS](np.linspace(0.9, 0, len(OVERLAPS)))
pressures, coordination, missing, star, plateau, over_debye, middle, fastest = ([] for _ in range(8))
for overlap, colour in zip(OVERLAPS, colours):
    state = packing(overlap)
    pressure = -np.trace(state.measure().stress) / 3  # stresses are positive in tension

    # Maxwell's count. A ball that fewer than four contacts hold is a rattler, and no part of the network.
    counted = state.rigidity("normal", with_rattlers=False)
    pressures.append(pressure)
    coordination.append(2 * counted.contacts / counted.bodies)
    # Springs beyond isostaticity, 3 N - 3 for N balls in a cell that repeats: three motions of all at once are free.
    missing.append(2 * counted.excess / counted.bodies)
    # Each spring beyond isostaticity is a state of self-stress, unless something floppy is left.
    assert counted.excess == counted.self_stress == counted.contacts - (3 * counted.bodies - 3)

    # Every mode. Those of frequency zero are the three of all, and rattlers.
    modes = state.system().all_modes(shapes=True)
    held = modes.eigenvalues > 1e-10 * modes.eigenvalues[-1]
    whole = state.rigidity("normal")
    # Calladine's: zeros - self-stresses = unknowns - springs; zeros are counted by LAPACK, self-stresses by a sparse QR.
    assert np.sum(~held) - whole.self_stress == whole.unknowns - len(whole.springs)
    unit = np.sqrt(KN / state.bodies.mass.mean())
    frequencies, participation = modes.frequencies[held] / unit, modes.participation[held]
    below = np.arange(1, len(frequencies) + 1) / len(frequencies)  # part of the modes up to each frequency

    # The plateau, and ω*: the density below it is a quarter of the plateau's on average. Counts need no bins.
    band = (frequencies > 0.4) & (frequencies < 1)
    plateau.append(band.mean() / 0.6)
    at = 3 + np.argmax((below / (plateau[-1] * frequencies))[3:] > 0.25)
    star.append(frequencies[at])

    # Debye's count of sound waves, with the elastic moduli of the packing itself.
    found = state.moduli()
    density = state.bodies.mass.sum() / EDGE**3
    slow, fast = np.sqrt(found.shear / density), np.sqrt((found.bulk + 4 / 3 * found.shear) / density)  # m/s
    debye = EDGE**3 / (6 * np.pi**2) * (2 / slow**3 + 1 / fast**3) * (frequencies * unit) ** 3
    over_debye.append((at + 1) / debye[at])
    middle.append(np.median(participation[band]))
    fastest.append(np.median(participation[-10:]))
    print(f"pressure {pressure:9.4g} Pa: z = {coordination[-1]:.4f}, beyond isostaticity {missing[-1]:.4f}; ω* = "
          f"{star[-1]:.4f} √(k/m), {star[-1] / missing[-1]:.3f} of it, with {at + 1} modes below, {over_debye[-1]:.1f} times "
          f"Debye's; participation {np.median(participation[:10]):.2f} of the slowest, {middle[-1]:.2f} of the plateau, "
          f"{fastest[-1]:.3f} of the fastest", flush=True)

    name = f"{pressure / 1e3:.3g} kPa"
    counts, edges = np.histogram(frequencies, bins=np.geomspace(0.5 * frequencies[0], frequencies[-1], 25))
    centres, widths = np.sqrt(edges[1:] * edges[:-1]), np.diff(edges)
    shown = counts > 0
    states.loglog(centres[shown], (counts / widths)[shown] / len(frequencies), "o-", markersize=3, color=colour, label=name)
    states.axvline(star[-1], ymin=0.94, color=colour)
    excess.loglog((centres / star[-1])[shown], (counts / (debye[at] * np.diff(edges**3) / frequencies[at]**3))[shown], "o-",
                  markersize=3, color=colour, label=name)
    shares.semilogx(frequencies, participation, ".", markersize=2, color=colour, alpha=0.6)
    if overlap == OVERLAPS[0]:
        nearest = state, state.system().lowest_modes(1)

pressures, missing, star = map(np.array, (pressures, missing, star))
contact_exponent, star_exponent, debye_exponent = (
    np.polyfit(np.log(pressures), np.log(values), 1)[0] for values in (missing, star, over_debye))
at_jamming = np.polyfit(np.sqrt(pressures), coordination, 1)[1]
print(f"z - z_iso ~ p^{contact_exponent:.3f}, ω* ~ p^{star_exponent:.3f} (theory: 1/2); z at no pressure {at_jamming:.3f} "
      f"(theory: 6); modes below ω* over Debye's ~ p^{debye_exponent:.2f} (theory: -1/4)")

states.set(xlabel="ω √(m/k)", ylabel="density of states √(k/m)", title="Flat down to ω* (ticks)")
states.legend(frameon=False, fontsize="small")
scaling.loglog(pressures, missing, "o", color=eigengrain.plot.BLUE, label="z - z$_{iso}$")
scaling.loglog(pressures, star, "s", color=eigengrain.plot.VERMILION, label="ω* √(m/k)")
for values in (missing, star):
    scaling.loglog(pressures, np.exp(np.mean(np.log(values / np.sqrt(pressures)))) * np.sqrt(pressures), "--",
                   color=eigengrain.plot.GREY, linewidth=1)
scaling.set(xlabel="pressure [Pa]", title="Both go with the root of the pressure (dashed)")
scaling.legend(frameon=False)
excess.axhline(1, color=eigengrain.plot.GREY, linewidth=1)
excess.set(xlabel="ω / ω*", ylabel="density of states over Debye's", title="More slow modes than sound waves")
shares.set(xlabel="ω √(m/k)", ylabel="participation ratio", title="Extended, but for the fastest", ylim=(0, 1))
figure.savefig(FOLDER / "jamming.png")

# The slowest mode of the packing that is nearest to jamming is no plane wave.
eigengrain.plot.mode_shape(*nearest, 0).figure.savefig(FOLDER / "modes.png")

# Slopes over ln(p_max/p_min) = 4.8. In 320 balls (the cell of the test, 60 mm) there are 20 contacts too
# many at the lowest pressure, 10% more or less by the seed, and 4 modes below ω*, one more or less: 0.1 to 0.25 / 4.8.
assert abs(contact_exponent - 0.5) < 0.05 and abs(star_exponent - 0.5) < 0.05
assert np.ptp(np.log(star / missing)) < 0.3, "ω* is z - z_iso, but for a factor and one mode of four"
# The shear modulus goes with z - z_iso, so Debye's count with ω*^3 / G^(3/2) ~ p^(3/4), and the plateau's with ω* ~ p^(1/2).
assert abs(debye_exponent + 0.25) < 0.1 and min(over_debye) > 1
# 6 - 6/N, and what the root leaves: contacts go with the overlap, too.
assert abs(at_jamming - 6) < 0.05
assert np.ptp(plateau) < 0.1 * np.mean(plateau), "the plateau has the same height at all pressures"
# Three Gaussian components of equal balls at random have 3/5; order in a mode makes it less.
assert all(0.35 < share < 0.6 for share in middle) and max(fastest) < 0.05
