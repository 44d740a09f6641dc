#!/usr/bin/env python3
"""Finds the pair of clumps for which the diagonal estimate is sqrt(3) times too long, and prints it as a scene.

For one frictionless contact of two bodies, lambda_max = k (sum of g^2/M over all twelve degrees of freedom), g = n for
translations and r x n along the principal axes for rotations, and the estimate knows the largest term only:

    estimate/truth = sqrt(sum / (4 largest)) <= sqrt(12/4) = sqrt(3)

with equality where all twelve terms are equal: n = (1, 1, 1)/sqrt(3), and in the principal frame of each body
(r x n)_k^2/I_k = 1/3m. With w_k = +-sqrt(I_k/3m) and the ball of the contact at c, that is c x n = w, which has a solution n if
c . w = 0 and |c| >= |w|. A square plate of four balls that touch has it: c = (R, R, 0) and w = (w_1, -w_1, w_3).

    find_root_three_clump.py > examples/scenes/hard_cases/root_three_clumps.yaml
    find_root_three_clump.py --search 20000     # rods of three balls with random arms: they stay below sqrt(10/4)
"""
import argparse

import numpy as np

HEAD = """\
# Two square plates of four balls, one oblique contact without friction: all twelve degrees of freedom of the pair have the
# same k/m, so a rule that takes one at a time is wrong by sqrt 3, the most that is possible, and by 1.386 after a safety of 0.8.
# Found by tests/hard_cases/find_root_three_clump.py. Closed form: dt = sqrt(m/k_n); the diagonal estimate sqrt(3 m/k_n).
"""


def plate():
    """Places of the four balls (R = 1), and principal moments over the mass."""
    places = np.array([[1, 1, 0], [-1, -1, 0], [1, -1, 0], [-1, 1, 0]], float)
    own = 2 / 5
    return places, np.array([own + 1, own + 1, own + 2])


def normal_in_plate(centre, moments):
    """The unit vector n with centre x n = (w_1, -w_1, w_3), pointing outwards."""
    w = np.sqrt(moments / 3) * np.array([1, -1, 1])
    along = centre / np.linalg.norm(centre)
    across = np.cross(w, centre)
    across /= np.linalg.norm(across)
    sine = np.linalg.norm(w) / np.linalg.norm(centre)
    return np.sqrt(1 - sine**2) * along + sine * across


def rotation_between(a, b):
    """The rotation vector that takes the unit vector a to b."""
    axis = np.cross(a, b)
    return axis / np.linalg.norm(axis), np.arctan2(np.linalg.norm(axis), a @ b)


def turned(axis, angle, v):
    return v * np.cos(angle) + np.cross(axis, v) * np.sin(angle) + axis * (axis @ v) * (1 - np.cos(angle))


def ratio(arm_terms, n):
    """Estimate over truth of a pair of equal bodies: terms (r x n)_k^2 m/I_k, and those of n."""
    terms = np.concatenate([arm_terms, n**2])
    return np.sqrt(2 * terms.sum() / (4 * terms.max()))


def scene(overlap):
    places, moments = plate()
    n_body = normal_in_plate(places[0], moments)
    n = np.ones(3) / np.sqrt(3)
    axis, angle = rotation_between(n_body, n)
    arms = np.cross(places[0], n_body)
    assert abs(ratio(arms**2 / moments, n) - np.sqrt(3)) < 1e-12
    # The second plate is the first one, mirrored in the contact point: the ball at -c meets the ball at c.
    step = turned(axis, angle, 2 * places[0]) + 2 * (1 - overlap) * n
    mine = np.array([turned(axis, angle, p) for p in places])
    gaps = [np.linalg.norm(b + step - a) - 2 for a in mine for b in mine]
    assert sum(g < 0 for g in gaps) == 1 and sorted(gaps)[1] > 0.01  # nothing else touches
    mass = 4
    text = HEAD
    text += "materials: [{name: grain, density: 0.238732414637843}]   # a ball of 1 kg, a plate of 4 kg\n"
    text += f"contacts: [{{between: [any, any], law: linear, kn: {mass}, tension: true}}]   # k_n/m = 1\n"
    text += "clumps:\n  - balls:\n"
    for p in places:
        text += f"      - {{at: [{p[0]:g}, {p[1]:g}, {p[2]:g}], radius: 1}}\n"
    # Given to the last digit, so that the axes are those of the plate although two moments are equal.
    numbers = ", ".join(f"{mass * i:.15g}" for i in moments)
    text += f"    mass: {mass}\n    centre: [0, 0, 0]\n    inertia: [{numbers}]\n"
    turn = f"axis: [{axis[0]:.15f}, {axis[1]:.15f}, {axis[2]:.15f}], angle: {angle:.15f}"
    text += "    material: grain\n    instances:\n"
    text += f"      - {{position: [0, 0, 0], {turn}}}\n"
    text += f"      - {{position: [{step[0]:.15f}, {step[1]:.15f}, {step[2]:.15f}], {turn}}}\n"
    return text + "damping: {local: 0}\n"


def search(rods, seed=1):
    """The worst of many rods of three balls in a row, touching end to end along random normals."""
    random = np.random.default_rng(seed)
    worst = 0
    for _ in range(rods):
        half = 0.3 + 3 * random.random()
        # About the mean density of three balls; overlaps counted thrice, which is enough for a search.
        moments = np.array([0.4, 0.4 + 2 / 3 * half**2, 0.4 + 2 / 3 * half**2])
        n, n_body = (v / np.linalg.norm(v) for v in random.normal(size=(2, 3)))
        arms = np.cross([half, 0, 0], n_body)
        worst = max(worst, ratio(arms**2 / moments, n))
    return worst


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--search", type=int, metavar="N", help="instead: the worst of N random rods")
    parser.add_argument("--overlap", type=float, default=1e-12, help="of the contact, over the radius")
    arguments = parser.parse_args()
    if arguments.search:
        print(f"worst of {arguments.search} rods: {search(arguments.search):.4f}, bound {np.sqrt(10 / 4):.4f}")
    else:
        print(scene(arguments.overlap), end="")
