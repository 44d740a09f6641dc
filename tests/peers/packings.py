#!/usr/bin/python3
"""Writes one scene for Eigengrain, LAMMPS and YADE.

    packings.py FOLDER SIZE STEPS      SIZE: tiny, drop, 1k, 10k, 100k or 1M
    packings.py settle                 makes packing_1k.txt anew: a minute, the same bits each time

The first leaves in FOLDER
    SIZE.txt     `# box Wx Wy H balls N weight W`, then `x y z r` a line (m): what YADE and Eigengrain read,
    SIZE.data    the same balls in the same order for LAMMPS (atom style sphere),
    SIZE.yaml    Eigengrain's scene, which says STEPS.

Every number is written with all its digits, so all codes start from the same bits.
"""
import math
import sys
from itertools import product
from pathlib import Path

HERE = Path(__file__).resolve().parent
DATA = HERE.parents[1] / "examples" / "data"
DENSITY, KN, KS, FRICTION, GRAVITY, DT = 2500.0, 1e5, 5e4, 0.5, 9.81, 2e-5


def read(path):
    """(box, balls) of a packing: three lengths, and rows x, y, z, r."""
    lines = Path(path).read_text().splitlines()
    box = tuple(float(s) for s in lines[0].split()[2:5])
    return box, [tuple(float(s) for s in line.split()) for line in lines[1:]]


def near_pairs(balls, reach):
    """Pairs of balls with less than `reach` between their surfaces, by a grid of cells."""
    side = 2 * max(b[3] for b in balls) + reach
    cells = {}
    for i, (x, y, z, _) in enumerate(balls):
        cells.setdefault((int(x // side), int(y // side), int(z // side)), []).append(i)
    pairs = []
    for (cx, cy, cz), inside in cells.items():
        for dx, dy, dz in product((-1, 0, 1), repeat=3):
            for j in cells.get((cx + dx, cy + dy, cz + dz), ()):
                for i in inside:
                    if i < j and math.dist(balls[i][:3], balls[j][:3]) < balls[i][3] + balls[j][3] + reach:
                        pairs.append((i, j))
    return sorted(pairs)


def settle(box, balls, steps, damping, dt=5e-5, reach=1e-3):
    """The balls after `steps` of frictionless motion from rest under gravity, with local damping.

    Without friction a bed at rest needs no shear forces, so positions alone are all of its state: each code can
    start from it at rest. Plain floats and a fixed order of the sums make it the same on every machine.
    """
    count = len(balls)
    radius = [b[3] for b in balls]
    mass = [DENSITY * 4 / 3 * math.pi * r**3 for r in radius]
    at = [list(axis) for axis in zip(*(b[:3] for b in balls))]
    speed = [[0.0] * count for _ in range(3)]
    listed = None
    for _ in range(steps):
        x, y, z = at
        if listed is None or max(math.dist(a, b) for a, b in zip(zip(x, y, z), listed)) > reach / 2:
            listed = list(zip(x, y, z))
            pairs = [(i, j, radius[i] + radius[j]) for i, j in near_pairs(list(zip(x, y, z, radius)), reach)]
        fx, fy, fz = force = [0.0] * count, [0.0] * count, [-GRAVITY * m for m in mass]
        for i, j, touching in pairs:
            dx, dy, dz = x[j] - x[i], y[j] - y[i], z[j] - z[i]
            square = dx * dx + dy * dy + dz * dz
            if square < touching * touching:
                push = KN * (touching / math.sqrt(square) - 1)
                fx[i] -= push * dx
                fy[i] -= push * dy
                fz[i] -= push * dz
                fx[j] += push * dx
                fy[j] += push * dy
                fz[j] += push * dz
        for axis, (f, v, s) in enumerate(zip(force, speed, at)):
            for i in range(count):
                if s[i] < radius[i]:
                    f[i] += KN * (radius[i] - s[i])
                if axis < 2 and box[axis] - s[i] < radius[i]:
                    f[i] -= KN * (radius[i] - box[axis] + s[i])
                f[i] *= 1 - damping if f[i] * v[i] > 0 else 1 + damping
                v[i] += dt * f[i] / mass[i]
                s[i] += dt * v[i]
    return list(zip(*at, radius))


def corner(count=1000, side=0.1):
    """The lowest `count` balls that lie wholly within the corner x, y <= side of the 10k packing, settled in it.

    Little damping until they have found their places (they fall by 5 mm), then much.
    """
    _, balls = read(DATA / "packing_10k.txt")
    inside = [b for b in balls if max(b[0], b[1]) + b[3] <= side]
    lowest = sorted(inside, key=lambda b: b[2])[:count]
    assert len(lowest) == count
    box = (side, side, max(b[2] for b in lowest) + 0.01)
    return box, settle(box, settle(box, lowest, 15000, damping=0.1), 10000, damping=0.7)


def ten_copies():
    """The 100k packing, 5 times along x and twice along y, each copy the mirror image of its neighbours.

    A ball that touched a wall now touches its own image, and no other ball: for centres on one side of the wall
    the image of another ball is farther than that ball by more than the overlaps. So the copies hold each other up
    as the walls did, and no gap closes when the run begins; the overlaps there are twice those with the wall.
    """
    (wx, wy, height), balls = read(DATA / "packing_100k.txt")
    copies = []
    for cx, cy in product(range(5), range(2)):
        for x, y, z, r in balls:
            copies.append((cx * wx + (wx - x if cx % 2 else x), cy * wy + (wy - y if cy % 2 else y), z, r))
    return (5 * wx, 2 * wy, height), copies


def packing(size):
    if size == "1k":
        return read(HERE / "packing_1k.txt")
    if size == "tiny":  # what a code needs before it has particles worth speaking of
        box, balls = read(HERE / "packing_1k.txt")
        return box, sorted(balls, key=lambda b: b[2])[:10]
    if size == "drop":  # the 1k bed, which falls by 0.2 mm: of a bed at rest all codes say the same, whatever they do
        box, balls = read(HERE / "packing_1k.txt")
        return box, [(x, y, z + 2e-4, r) for x, y, z, r in balls]
    if size == "1M":
        return ten_copies()
    return read(DATA / f"packing_{size}.txt")


def write_text(path, box, balls):
    weight = sum(DENSITY * 4 / 3 * math.pi * r**3 * GRAVITY for *_, r in balls)
    with open(path, "w") as out:
        print("# box", *box, "balls", len(balls), "weight", weight, file=out)
        for ball in balls:
            print(*ball, file=out)


def write_lammps(path, box, balls):
    with open(path, "w") as out:
        # Room above for balls that jump: LAMMPS stops when one leaves its box.
        out.write(f"packing\n\n{len(balls)} atoms\n1 atom types\n\n"
                  f"0 {box[0]} xlo xhi\n0 {box[1]} ylo yhi\n0 {box[2] + 0.05} zlo zhi\n\nAtoms # sphere\n\n")
        for number, (x, y, z, r) in enumerate(balls, 1):
            print(number, 1, 2 * r, DENSITY, x, y, z, file=out)


def write_eigengrain(path, size, box, steps):
    Path(path).write_text(f"""\
gravity: [0, 0, -{GRAVITY}]
materials:
  - {{name: grain, density: {DENSITY}}}
contacts:
  - {{between: [grain, grain], law: linear, kn: {KN}, ks: {KS}, friction: {FRICTION}}}
balls:
  - {{file: {size}.txt, material: grain}}
walls:
  - box: {{min: [0, 0, 0], max: [{box[0]}, {box[1]}, {box[2]}], open: [+z]}}
    material: grain
damping: {{local: 0}}
timestep: {{policy: fixed, dt: {DT}}}
run: {{steps: {steps}}}
histories:
  - {{file: walls.csv, every: {steps}, of: [walls]}}
""")


def main(folder, size, steps):
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    text, data = folder / f"{size}.txt", folder / f"{size}.data"
    # A million lines take a while, so the packing is kept; newer rules (this file) make it anew.
    if not data.exists() or data.stat().st_mtime < Path(__file__).stat().st_mtime:
        box, balls = packing(size)
        write_text(text, box, balls)
        write_lammps(data, box, balls)
    with open(text) as lines:
        box = [float(s) for s in lines.readline().split()[2:5]]
    write_eigengrain(folder / f"{size}.yaml", size, box, steps)


if __name__ == "__main__":
    if sys.argv[1:] == ["settle"]:
        write_text(HERE / "packing_1k.txt", *corner())
    else:
        main(sys.argv[1], sys.argv[2], int(sys.argv[3]))
