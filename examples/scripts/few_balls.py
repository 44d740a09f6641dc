#!/usr/bin/env python3
"""Runs two scenes of a few balls and draws what they do.

    few_balls.py [PROGRAM] [FOLDER]       default: build/release/bin/eigengrain, and the current folder

1. A ball is dropped onto a floor without damping (examples/scenes/bouncing_ball.yaml). It comes back to the height it
   fell from, again and again: the cycle neither makes nor loses energy.
2. Three balls in a column feel gravity all of a sudden (three_balls.yaml). Local damping lets each half cycle be 0.42
   times the one before it, and the column comes to rest where its weight and its springs agree.

Needs python3-matplotlib. The pictures are bouncing_ball.png and three_balls.png.
"""
import csv
import pathlib
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/release/bin/eigengrain"
FOLDER = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else ".")

MASS = 4 / 3 * 3.141592653589793 * 5e-3**3 * 2500  # kg
GRAVITY = 9.81  # m/s2
STIFFNESS = 2e4  # N/m


def run(scene):
    """Runs a scene; the columns of its history by name."""
    subprocess.run([PROGRAM, "run", ROOT / "examples/scenes" / f"{scene}.yaml", "--output", FOLDER], check=True)
    with open(FOLDER / f"{scene}.csv", newline="") as table:
        rows = list(csv.reader(table))
    return {name: [float(row[k]) for row in rows[1:]] for k, name in enumerate(rows[0])}


def column(table, *parts):
    """The one column whose name has all the parts."""
    (name,) = (name for name in table if all(part in name for part in parts))
    return table[name]


def draw_bouncing_ball():
    table = run("bouncing_ball")
    t = column(table, "time")
    kinetic, elastic, weight = (column(table, name) for name in ("kinetic", "elastic", "gravitational"))
    figure, (height, energy) = plt.subplots(2, 1, sharex=True, figsize=(7, 5), layout="constrained")
    height.plot(t, [1e3 * z for z in column(table, "ball 0 z")])
    height.axhline(5, color="grey", linewidth=0.8, label="radius: where it touches the floor")
    height.set_ylim(top=31)
    height.set_ylabel("height of the centre [mm]")
    height.set_title("A ball dropped onto a floor, undamped")
    height.legend(loc="upper right", fontsize="small")
    for name, values in (("kinetic", kinetic), ("elastic", elastic), ("gravitational", weight),
                         ("sum", [sum(e) for e in zip(kinetic, elastic, weight)])):
        energy.plot(t, [1e6 * e for e in values], label=name)
    energy.set_ylabel("energy [µJ]")
    energy.set_xlabel("time [s]")
    energy.legend(loc="upper right", ncols=4, fontsize="small")
    energy.set_ylim(top=1.25 * 1e6 * max(weight))
    figure.savefig(FOLDER / "bouncing_ball.png", dpi=110)


def draw_three_balls():
    table = run("three_balls")
    t = [1e3 * time for time in column(table, "time")]
    figure, (position, floor) = plt.subplots(2, 1, sharex=True, figsize=(7, 5), layout="constrained")
    sunk = 0.0  # where it comes to rest: the contact below ball k carries the balls from k on
    for ball in range(3):
        z = column(table, f"ball {ball} z")
        (line,) = position.plot(t, [1e6 * (height - z[0]) for height in z], label=f"ball {ball}")
        sunk -= (3 - ball) * MASS * GRAVITY / STIFFNESS
        position.axhline(1e6 * sunk, color=line.get_color(), linestyle=":", linewidth=1)
    position.set_ylabel("displacement [µm]")
    position.set_title("Three balls under sudden gravity, local damping 0.7 (dotted: at rest)")
    position.legend(loc="upper right", ncols=3, fontsize="small")
    floor.plot(t, [-force / (3 * MASS * GRAVITY) for force in column(table, "force", " z")])
    floor.axhline(1, color="grey", linewidth=0.8)
    floor.set_ylabel("force on the floor / weight")
    floor.set_xlabel("time [ms]")
    figure.savefig(FOLDER / "three_balls.png", dpi=110)


if __name__ == "__main__":
    FOLDER.mkdir(parents=True, exist_ok=True)
    draw_bouncing_ball()
    draw_three_balls()
