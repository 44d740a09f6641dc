#!/usr/bin/env python3
"""Tutorial 2: a triaxial test, from equilibrium and from a state that is not in equilibrium.

    triaxial.py [FOLDER] [EDGE] [PROGRAM]     default: the current folder, 100 mm (1,200 balls; a minute), that of the build

A box of smooth plates is filled; servo walls press it from all sides, and `relax` finds the equilibrium under that pressure.
Then the top comes down step by step while the sides keep their pressure, and each step is relaxed: a quasi-static test,
without inertia, speed or damping. Its first step is what the stiffness matrix K says, walls included. Beside it, the same
test by the explicit cycle: from the equilibrium, and at once from the filling, whose contacts are not yet in balance with
the plates. That one has no beginning: what it shows of the first strains is the filling that settles. The picture is
triaxial.png.
"""
import csv
import json
import pathlib
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import scipy.sparse.linalg

import eigengrain
import eigengrain.plot

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
EDGE = float(sys.argv[2]) if len(sys.argv) > 2 else 0.1  # m
PROGRAM = pathlib.Path(sys.argv[3] if len(sys.argv) > 3 else ROOT / "build/release/bin/eigengrain").resolve()
FOLDER.mkdir(parents=True, exist_ok=True)

PRESSURE, AREA = 10e3, EDGE**2  # Pa, m2: what servo walls push with; the area stays what it was at the start
STRAIN, INCREMENTS = 0.03, 20
SPEED = 0.05 * EDGE  # m/s of the explicit tests: an inertial number of 3e-4, which is slow
LEFT, RIGHT, FRONT, BACK, BOTTOM, TOP = range(6)


def ask(verb, source, *options):
    done = subprocess.run([PROGRAM, verb, source, *options], cwd=FOLDER, text=True, capture_output=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{verb} {source}: {done.stderr}")


def plate(point, normal, **motion):
    return {"plane": {"point": point, "normal": normal}, "material": "plate"} | motion


servo = {"servo": {"stress": PRESSURE, "area": AREA, "max_speed": 0.05}}
lid = [0, 0, EDGE], [0, 0, -1]
# Plates without friction, so that stresses are the same from end to end.
(FOLDER / "triaxial.yaml").write_text(json.dumps({
    "materials": [{"name": "grain", "density": 2500}, {"name": "plate"}],
    "contacts": [{"between": ["grain", "grain"], "law": "linear", "kn": 1e5, "ks": 5e4, "friction": 0.5},
                 {"between": ["grain", "plate"], "law": "linear", "kn": 1e5}],
    "balls": [{"fill": "dense", "mean_overlap": 2e-4, "seed": 1, "material": "grain",
               "box": {"min": [0, 0, 0], "max": [EDGE] * 3},
               "sizes": {"distribution": "uniform", "min": 4e-3, "max": 6e-3}}],
    "walls": [plate([0, 0, 0], [1, 0, 0], **servo), plate([EDGE, 0, 0], [-1, 0, 0], **servo),
              plate([0, 0, 0], [0, 1, 0], **servo), plate([0, EDGE, 0], [0, -1, 0], **servo),
              plate([0, 0, 0], [0, 0, 1]), plate(*lid, **servo)]}))


def sides(state):
    """(3,) lengths between the plates. A contact point lies half the overlap behind its plate."""
    contacts = state.contacts
    plane = np.einsum("ij,ij->i", contacts.point, np.abs(contacts.normal)) - 0.5 * contacts.overlap * contacts.normal.sum(axis=1)
    at = [plane[contacts.wall == wall].mean() for wall in range(6)]
    return np.array([at[RIGHT] - at[LEFT], at[BACK] - at[FRONT], at[TOP] - at[BOTTOM]])


def stresses(state):
    """(3,) pressures on the plates, by the areas that they have now; of opposite ones the mean."""
    length, force = sides(state), np.abs(np.diagonal(state.wall_forces.reshape(3, 2, 3), axis1=0, axis2=2)).mean(axis=0)
    return force * length / length.prod()


def balance_of_stress(state):
    """By how much contacts inside carry another stress than plates push with; the same in equilibrium (Love, Weber)."""
    contacts = state.contacts
    at_plates = contacts.wall >= 0
    inside = np.einsum("ij,ij->j", contacts.force, contacts.branch)
    outside = np.einsum("ij,ij->j", contacts.force[at_plates], contacts.point[at_plates])
    return np.abs(inside / outside - 1).max()


# Equilibrium under the same pressure from all sides.
filling = eigengrain.load(FOLDER / "triaxial.yaml")
ask("relax", "triaxial.yaml")
rest = eigengrain.load(FOLDER / "triaxial-relaxed.h5")
start = sides(rest)
for name, state in (("filling", filling), ("equilibrium", rest)):
    print(f"{name:12} {len(state.bodies)} balls, unbalanced ratio {state.balance.mean:.1e}, stresses on the plates "
          f"{np.round(stresses(state), 1)} Pa, inside off by {balance_of_stress(state):.1e}")
wanted = PRESSURE * AREA / (start.prod() / start)  # the plates have come in, and push with the same force
np.testing.assert_allclose(stresses(rest), wanted, rtol=1e-8)
assert balance_of_stress(rest) < 1e-8  # 1e-10 of the mean contact force is left on each ball, times a row of some ten balls

# The first step of the test by K alone. Contacts with plate w move by W d where the plate moves by d; what the balls do
# about it, x, is K x = -B'D W d, and the plates push back with S d, S = W'D(W + B x).
system = rest.system()
elements, K, B, D = system.elements, system.K, system.B, system.D
W = np.zeros((6 * len(elements), 6))
for e in np.flatnonzero(elements.b < 0):
    axis = np.abs(elements.normal[e]).argmax()
    outwards = np.sign(elements.normal[e, axis])
    W[6 * e + axis, 2 * axis + (outwards > 0)] = 1
loads = B.T @ (D @ W)
followed = np.column_stack([scipy.sparse.linalg.cg(K, -load, tol=1e-12, atol=0, maxiter=100_000)[0] for load in loads.T])
S = W.T @ (D @ W) + loads.T @ followed
free = [LEFT, RIGHT, FRONT, BACK]  # whose forces stay, while the top comes down by 1 m
moved = np.append(np.linalg.solve(S[np.ix_(free, free)], S[free, TOP]), [0, -1])
young_of_K = -(S @ moved)[TOP] * start[2] ** 2 / start.prod()
poisson_of_K = np.array([moved[RIGHT] - moved[LEFT], moved[BACK] - moved[FRONT]]) / start[:2] * start[2]

# The same by a quasi-static step, of a strain that is small beside the overlaps (1e-3). K has all contacts stick, so here
# they do, too; what those that are about to slip change is printed beside it.
let_go = ["--set", f"walls.{TOP}={json.dumps(plate(*lid, velocity=[0, 0, 0]))}"]


def down(strain):
    return ["--load", f"displacement.{TOP}=[0, 0, {-strain * start[2]}]"]


young = {}
for friction in (100, 0.5):
    ask("relax", "triaxial-relaxed.h5", *let_go, *down(1e-6), "--increments", "1", "--output", "first", "--set",
        f"contacts.0.friction={friction}")
    first = eigengrain.load(FOLDER / "first" / "triaxial-relaxed-load-0001.h5")
    force = np.abs([state.wall_forces[TOP, 2] for state in (rest, first)])
    young[friction] = (force[1] - force[0]) * start[2] / start.prod() / 1e-6
    if friction == 100:
        poisson = (sides(first) - start)[:2] / start[:2] / 1e-6
print(f"first step: Young's modulus {young[100]:.5e} Pa, Poisson's ratios {poisson[0]:.4f} and {poisson[1]:.4f} while all "
      f"contacts stick; by K {young_of_K:.5e} Pa, {poisson_of_K[0]:.4f} and {poisson_of_K[1]:.4f}; with slip {young[0.5]:.5e} Pa")

# The test: a row of equilibria. Of forces, 1e-6 is far more than a curve shows.
ask("relax", "triaxial-relaxed.h5", *let_go, *down(STRAIN), "--increments", str(INCREMENTS), "--tolerance", "1e-6")
path = [rest] + [eigengrain.load(FOLDER / f"triaxial-relaxed-load-{k:04}.h5") for k in range(1, INCREMENTS + 1)]


def curves(length, stress):
    """Rows (strain of the axis, deviator, strain of the volume), compression of the axis and growth of the volume positive."""
    volume = length.prod(axis=1)
    return np.array([1 - length[:, 2] / length[0, 2], stress[:, 2] - stress[:, :2].mean(axis=1), volume / volume[0] - 1])


def explicit(source, name):
    """The same test by the explicit cycle, by its table of forces on the plates and of their places."""
    columns = {"file": "plates.csv", "every": 20, "of": ["walls", "wall_positions"]}
    ask("run", source, "--set", f"walls.{TOP}={json.dumps(plate(*lid, velocity=[0, 0, -SPEED]))}", "--set",
        f"run={json.dumps({'time': STRAIN * EDGE / SPEED})}", "--set", f"histories={json.dumps([columns])}", "--output", name)
    (table,) = (FOLDER / name).glob("*plates.csv")  # a run from a state puts the name of the state in front
    rows = np.loadtxt(table, delimiter=",", skiprows=1)
    forces, places = rows[:, 2:20].reshape(-1, 3, 2, 3), rows[:, 20:38].reshape(-1, 3, 2, 3)
    length = np.stack([places[:, k, 1, k] - places[:, k, 0, k] for k in range(3)], axis=1)
    force = np.stack([np.abs(forces[:, k, :, k]).mean(axis=1) for k in range(3)], axis=1)
    return curves(length, force * length / length.prod(axis=1)[:, None])


static = curves(np.array([sides(state) for state in path]), np.array([stresses(state) for state in path]))
slow, hasty = explicit("triaxial-relaxed.h5", "from_equilibrium"), explicit("triaxial.yaml", "from_filling")

figure, axes = plt.subplots(2, 1, figsize=(6.5, 6.5), sharex=True, layout="constrained", dpi=110)
for (strain, deviator, volume), style, name in (
        (static, {"marker": "o", "markersize": 4, "color": eigengrain.plot.BLUE}, "equilibria (relax --load)"),
        (slow, {"color": eigengrain.plot.GREEN, "linewidth": 1}, "explicit, from equilibrium"),
        (hasty, {"color": eigengrain.plot.VERMILION, "linewidth": 1, "linestyle": "--"}, "explicit, from the filling")):
    axes[0].plot(100 * strain, deviator / 1e3, label=name, **style)
    axes[1].plot(100 * strain, 100 * volume, **style)
begins = np.array([0, 0.15 * STRAIN])
axes[0].plot(100 * begins, young_of_K * begins / 1e3, ":", color=eigengrain.plot.GREY, label="first step, by K")
axes[0].set(ylabel="axial - lateral stress [kPa]", ylim=(min(0, 1.1 * hasty[1].min() / 1e3), None))
axes[0].legend(frameon=False)
axes[1].axhline(0, color=eigengrain.plot.GREY, linewidth=0.5)
axes[1].set(xlabel="axial strain [%]", ylabel="growth of the volume [%]")
figure.savefig(FOLDER / "triaxial.png")

strain, deviator, volume = static


def off(test):
    """By how much a test differs from the equilibria: (rms of the deviator over its largest, largest of the volume's strain)."""
    return (np.sqrt(np.mean((np.interp(strain, test[0], test[1]) - deviator) ** 2)) / deviator.max(),
            np.abs(np.interp(strain, test[0], test[2]) - volume).max())


sine = (deviator / (deviator + 2 * PRESSURE)).max()
print(f"largest deviator {deviator.max():.4g} Pa at {100 * strain[deviator.argmax()]:.1f}%: angle of friction "
      f"{np.degrees(np.arcsin(sine)):.1f}°; volume {100 * volume.min():+.3f}% at its least, {100 * volume[-1]:+.3f}% at the end")
for name, test in (("equilibrium", slow), ("the filling", hasty)):
    print(f"explicit from {name}: deviator off by {off(test)[0]:.1%} of the largest, volume by {100 * off(test)[1]:.3f}%; at "
          f"strain 0 {test[1, 0]:.4g} Pa, by {STRAIN / INCREMENTS:.1%} {np.interp(STRAIN / INCREMENTS, *test[:2]):.4g} Pa "
          f"(equilibria {deviator[1]:.4g} Pa)")

# K leaves out how forces turn with their contacts, of the size of an overlap over a radius (2e-3), some times that as balls
# move by more than their share of the strain: 0.3% here. Steps this small open no contact.
assert abs(young[100] / young_of_K - 1) < 1e-2 and np.abs(poisson - poisson_of_K).max() < 5e-3
assert young[0.5] <= young[100], "contacts that slip make it softer"
# Dense packings contract a little, and grow then; spheres with a friction of 0.5 fail at 20 to 30 degrees.
assert volume.min() < 0 < volume[-1] and 20 < np.degrees(np.arcsin(sine)) < 30
# From equilibrium both ways are the same test, but for the size of the increments: each of 0.15% is a jump in which contacts
# slip, which costs up to a tenth of the deviator (with 60 of them half as much, and the speed has no part in it).
assert off(slow)[0] < 0.15 and off(slow)[1] < 1e-3
# From the filling, the volume is off by what the pressure took of it, and the first deviator is no property of the balls.
settled = 1 - start.prod() / EDGE**3
assert 0.5 * settled < off(hasty)[1] < 2 * settled and off(hasty)[1] > 3 * off(slow)[1]
early = STRAIN / INCREMENTS
assert np.interp(early, *hasty[:2]) < 0.7 * np.interp(early, *slow[:2])
