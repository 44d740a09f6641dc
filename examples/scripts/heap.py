#!/usr/bin/env python3
"""Makes heaps with one friction after the other, measures their slopes and draws them.

    heap.py [--program PATH] [--folder FOLDER] [--radius MM] [--seed N] [--check]

5,000 balls stand in a tube on a rough floor; the tube is lifted, and what runs out below it comes to rest as a heap
(examples/scenes/heap.yaml). A rougher contact makes a steeper heap, and resistance against rolling an even steeper one.
It takes some minutes; the picture is heap.png, and angles are printed.

The slope: above each point of a grid of one radius, the height of the surface of the highest ball there; a straight line
through these heights over the distance from the axis, where their mean over a ring is from 30 to 80% of that at the top.
Eight sectors of the heap alone say how certain it is.

--radius takes larger balls (10 mm: 625 of them, some ten seconds); --check asks only whether the angles are in their order,
and draws nothing. Needs python3-numpy, python3-h5py, and for the picture python3-matplotlib.
"""
import argparse
import math
import os
import pathlib
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import h5py
import numpy

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Name of the state, what it is called, overrides.
HEAPS = [
    ("slippery", "μ = 0.1", {"friction": 0.1, "rolling_friction": 0}),
    ("rough", "μ = 0.5", {"friction": 0.5, "rolling_friction": 0}),
    ("rolling", "μ = 0.5, rolling resistance 0.2", {"friction": 0.5, "rolling_friction": 0.2}),
]
SECTORS = 8
# Degrees by which --check wants each heap to be steeper than the one before. With 625 balls from three seeds the angles
# were 12, 16 and 28, and differed by up to 1 from seed to seed (2 of the last).
MARGIN = 2


def run(program, folder, name, keys, radius, seed):
    """Centres of the balls at the end, in m: of those that are not held, and of the floor's."""
    command = [program, "run", ROOT / "examples/scenes/heap.yaml", "--threads", "1", "--output", folder / name]
    for key, value in keys.items():
        command += ["--set", f"contacts.0.{key}={value}"]
    command += ["--set", f"balls.1.seed={seed}"]
    for entry in 0, 1:
        command += ["--set", f"balls.{entry}.radius={radius}"]
    # The floor keeps its gaps of a hundredth, its top at z = 0, and its distance from the plane below.
    command += ["--set", f"balls.0.spacing={2.02 * radius}",
                "--set", f"balls.0.box={{min: [-0.3, -0.3, {-2 * radius}], max: [0.3, 0.3, 0]}}",
                "--set", f"walls.1.box={{min: [-0.31, -0.31, {-2.02 * radius}], max: [0.31, 0.31, 1], open: [+z]}}"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    with h5py.File(folder / name / "heap.h5") as state:
        bodies = state["bodies"]
        position, held = bodies["position"][:], bodies["fixed"][:] != 0
    return position[~held], position[held]


def surface(balls, radius):
    """(x, y, height) of the points of a grid above which there is a ball."""
    cells = {}
    for x, y, z in balls:
        for i in range(math.ceil((x - radius) / radius), math.floor((x + radius) / radius) + 1):
            for j in range(math.ceil((y - radius) / radius), math.floor((y + radius) / radius) + 1):
                across = (i * radius - x) ** 2 + (j * radius - y) ** 2
                if across < radius**2:
                    top = z + math.sqrt(radius**2 - across)
                    cells[i, j] = max(top, cells.get((i, j), top))
    return numpy.array([(i * radius, j * radius, top) for (i, j), top in cells.items()])


class Slope:
    """A straight line through the flank of a heap about the z axis."""

    def __init__(self, balls, radius):
        x, y, self.height = surface(balls, radius).T
        self.distance = numpy.hypot(x, y)
        rings = (self.distance / (2 * radius)).astype(int)
        count = numpy.bincount(rings)
        filled = numpy.flatnonzero(count)
        self.ring_distance = (filled + 0.5) * 2 * radius
        self.ring_height = numpy.bincount(rings, self.height)[filled] / count[filled]
        top = self.ring_height.max()
        self.near = self.ring_distance[self.ring_height < 0.8 * top][0]
        self.far = self.ring_distance[self.ring_height < 0.3 * top][0]
        flank = (self.distance > self.near) & (self.distance < self.far)
        self.line = numpy.polyfit(self.distance[flank], self.height[flank], 1)
        self.angle = angle_of(self.line)
        sector = ((numpy.arctan2(y, x) + math.pi) / (2 * math.pi) * SECTORS).astype(int) % SECTORS
        angles = [angle_of(numpy.polyfit(self.distance[flank & (sector == k)], self.height[flank & (sector == k)], 1))
                  for k in range(SECTORS)]
        self.error = numpy.std(angles, ddof=1) / math.sqrt(SECTORS)


def angle_of(line):
    return math.degrees(math.atan(-line[0]))


def draw(heaps, radius, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.collections import EllipseCollection

    figure, axes = plt.subplots(2, len(heaps), figsize=(12, 4.5), layout="constrained", sharex="row", sharey="row",
                                height_ratios=[1, 1.4])
    mm = 1e3
    for (side, profile), (text, balls, floor, slope) in zip(axes.T, heaps):
        # From the side, the farthest first; darker where farther.
        for seen, look in (balls, {"cmap": "YlOrBr_r", "clim": (-0.25, 0.35)}), (floor, {"color": "0.75"}):
            seen = seen[numpy.argsort(-seen[:, 1])]
            if "cmap" in look:
                look["array"] = -seen[:, 1]
            side.add_collection(EllipseCollection(
                2 * mm * radius, 2 * mm * radius, 0, units="xy", offsets=mm * seen[:, [0, 2]],
                transOffset=side.transData, linewidths=0.15, **{"edgecolors": "0.3", **look}))
        run = numpy.array([slope.near, slope.far])
        for sign in 1, -1:
            side.plot(sign * mm * run, mm * numpy.polyval(slope.line, run), color="tab:blue", linewidth=2)
        side.text(250, 100, f"{slope.angle:.1f}° ± {slope.error:.1f}°", ha="right", va="top", color="tab:blue")
        side.set_aspect("equal")
        side.set_xlim(-260, 260)
        side.set_ylim(-2 * mm * radius, 110)
        side.set_title(text, fontsize="medium")
        side.set_xlabel("x [mm]")
        profile.plot(mm * slope.distance, mm * slope.height, ".", color="0.7", markersize=1)
        profile.plot(mm * slope.ring_distance, mm * slope.ring_height, ".-", color="tab:brown", linewidth=1, markersize=4,
                     label="mean of a ring")
        profile.plot(mm * run, mm * numpy.polyval(slope.line, run), color="tab:blue", linewidth=2,
                     label="straight line from 80 to 30% of the top")
        profile.set_xlim(0, 260)
        profile.set_ylim(0, 110)
        profile.set_xlabel("distance from the axis [mm]")
    axes[1, 0].legend(loc="upper right", fontsize="small")
    axes[0, 0].set_ylabel("z [mm]")
    axes[1, 0].set_ylabel("height of the surface [mm]")
    figure.savefig(path, dpi=100, pil_kwargs={"optimize": True})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=ROOT / "build/release/bin/eigengrain")
    parser.add_argument("--folder", type=pathlib.Path, default=pathlib.Path("heaps"))
    parser.add_argument("--radius", type=float, default=5, help="of the balls, mm")
    parser.add_argument("--seed", type=int, default=1, help="of the places of the balls in the tube")
    parser.add_argument("--check", action="store_true")
    arguments = parser.parse_args()
    radius = 1e-3 * arguments.radius
    heaps = []
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        runs = pool.map(
            lambda heap: run(arguments.program, arguments.folder, heap[0], heap[2], radius, arguments.seed), HEAPS)
        for (_, text, _), (balls, floor) in zip(HEAPS, runs):
            slope = Slope(balls, radius)
            heaps.append((text, balls, floor, slope))
            print(f"{text}: {slope.angle:.1f} ± {slope.error:.1f} degrees, {len(balls)} balls", flush=True)
    if not arguments.check:
        draw(heaps, radius, arguments.folder / "heap.png")
        return 0
    angles = [slope.angle for *_, slope in heaps]
    return 0 if all(low + MARGIN < high for low, high in zip(angles, angles[1:])) else 1


if __name__ == "__main__":
    sys.exit(main())
