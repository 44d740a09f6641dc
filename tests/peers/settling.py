#!/usr/bin/python3
"""A thousand balls that settle in a box, beside LAMMPS and YADE: statistics, and the early part of their paths.

    settling.py [--seeds 4] [--local] [--program PATH] [--work FOLDER] [--out FILE.md]

Exits with 77 if there is no other code.

What is compared, with which options, and where the tolerances come from: README.md.
"""
import argparse
import csv
import json
import math
import os
import random
import shutil
import statistics
import sys
import time
from collections import namedtuple
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy

from trajectories import run

HERE = Path(__file__).resolve().parent
TREE = HERE.parents[1]

COUNT, RADIUS, SIDE, DENSITY, GRAVITY = 1000, 5e-3, 0.1, 2500.0, 9.81
MASS = DENSITY * 4 / 3 * math.pi * RADIUS**3
WEIGHT = COUNT * MASS * GRAVITY
KN, KS, FRICTION, DT = 1e5, 5e4, 0.5, 2e-5
SPEED = 0.3  # m/s: balls start with velocities up to this in each direction, so that they collide from the beginning
BETA = 0.2  # damping ratio of the dashpots
LOCAL = 0.3  # local damping

KINETIC_AT, HEIGHT_AT, EARLY_AT = (3000, 6000, 8000, 9000), (4000, 7000), (100, 500, 1000, 1500, 2000, 2500)  # steps

# Where these come from: README.md.
TWIN, OF_TWIN = 1e-14, 30  # of R; how much farther LAMMPS may be than the twin that starts so far away
OF_OVERLAP = 0.05  # of R, after 1000 steps
STANDARD_ERRORS = 4
OF_FALL = {"kinetic energy, 0.06 s": 0.008, "potential energy, 0.08 s": 0.001}

Case = namedtuple("Case", "name damping steps sample")  # `sample`: steps from one look to the next
# Balls that fall from the top land after 0.15 s, 7500 steps; local damping holds up the fall too.
CASES = {
    "settled": Case("settled", "dashpots", 16000, 1000),
    "local": Case("local", "local", 28000, 1000),
    "early": Case("early", "none", 2500, 20),
}


def start(seed):
    """Positions and velocities at t = 0: balls at random places where they overlap none, in 24% of the room."""
    chance = random.Random(seed)
    height = COUNT * 4 / 3 * math.pi * RADIUS**3 / 0.24 / SIDE**2
    low, places, cells = 1.001 * RADIUS, [], {}
    while len(places) < COUNT:
        place = tuple(chance.uniform(low, room - low) for room in (SIDE, SIDE, height))
        cell = tuple(int(x // (2 * low)) for x in place)
        near = (q for dx in (-1, 0, 1) for dy in (-1, 0, 1) for dz in (-1, 0, 1)
                for q in cells.get((cell[0] + dx, cell[1] + dy, cell[2] + dz), ()))
        if all(math.dist(place, q) > 2 * low for q in near):
            places.append(place)
            cells.setdefault(cell, []).append(place)
    return [(place, tuple(chance.uniform(-SPEED, SPEED) for _ in range(3))) for place in places]


# Dashpots of the same c in all codes: c = 2 beta sqrt(m k), m the reduced mass, which at a wall is the ball's.
def dashpot(stiffness, at_wall):
    return 2 * BETA * math.sqrt((MASS if at_wall else MASS / 2) * stiffness)


def eigengrain(program, folder, case, balls):
    """{step: positions and velocities, one row a ball}."""
    law = {"law": "linear", "kn": KN, "ks": KS, "friction": FRICTION, "end_step": True, "projected": True}
    if case.damping == "dashpots":
        law |= {"beta_n": BETA, "beta_s": BETA, "no_tension": True}
    scene = {
        "gravity": [0, 0, -GRAVITY],
        "materials": [{"name": "grain", "density": DENSITY}],
        "contacts": [{"between": ["any", "any"], **law}],
        "levers": "surface",
        "balls": [{"position": list(place), "velocity": list(velocity), "radius": RADIUS, "material": "grain"}
                  for place, velocity in balls],
        "walls": [{"box": {"min": [0, 0, 0], "max": [SIDE, SIDE, 1], "open": ["+z"]}, "material": "grain"}],
        "damping": {"local": LOCAL if case.damping == "local" else 0},
        "timestep": {"policy": "fixed", "dt": DT},
        "run": {"steps": case.steps},
        "histories": [{"file": "balls.csv", "every": case.sample, "balls": list(range(COUNT))}],
    }
    (folder / "scene.yaml").write_text(json.dumps(scene))
    shutil.rmtree(folder / "out", ignore_errors=True)
    run([program, "run", "scene.yaml", "--threads", "1", "--output", "out"], folder)
    states = {}
    with open(folder / "out" / "balls.csv") as table:
        rows = csv.reader(table)
        next(rows)
        for row in rows:  # step, time; then position, velocity and spin of each ball
            states[int(row[0])] = numpy.array(list(map(float, row[2:]))).reshape(COUNT, 9)[:, :6]
    shutil.rmtree(folder / "out")
    return states


def lammps(folder, case, balls):
    lines = ["settling", "", f"{COUNT} atoms", "1 atom types", "", f"0 {SIDE} xlo xhi", f"0 {SIDE} ylo yhi",
             "0 0.4 zlo zhi", "", "Atoms # sphere", ""]
    lines += [f"{k} 1 {2 * RADIUS!r} {DENSITY!r} " + " ".join(map(repr, place)) for k, (place, _) in enumerate(balls, 1)]
    lines += ["", "Velocities", ""]
    lines += [f"{k} " + " ".join(map(repr, velocity)) + " 0 0 0" for k, (_, velocity) in enumerate(balls, 1)]
    (folder / "settling.data").write_text("\n".join(lines) + "\n")

    def law(at_wall):
        """Stiffnesses, damping as c over the reduced mass, friction, whether shear is damped, and no pull by dashpots."""
        damped = case.damping == "dashpots"
        mass = MASS if at_wall else MASS / 2
        gamma = [dashpot(k, at_wall) / mass if damped else 0.0 for k in (KN, KS)]
        return f"{KN} {KS} {gamma[0]!r} {gamma[1]!r} {FRICTION} {int(damped)}" + " limit_damping" * damped

    (folder / "settling.in").write_text(f"""units si
atom_style sphere
atom_modify map array
boundary f f f
newton off
comm_modify vel yes
read_data settling.data
pair_style gran/hooke/history {law(False)}
pair_coeff * *
neighbor 1e-3 bin
neigh_modify delay 0 every 1 check yes
fix x all wall/gran hooke/history {law(True)} xplane 0 {SIDE}
fix y all wall/gran hooke/history {law(True)} yplane 0 {SIDE}
fix z all wall/gran hooke/history {law(True)} zplane 0 NULL
fix gravity all gravity {GRAVITY} vector 0 0 -1
fix motion all nve/sphere
timestep {DT!r}
dump states all custom {case.sample} states.dump id x y z vx vy vz
dump_modify states sort id format float %.17g
run {case.steps}
""")
    run(["lmp", "-in", "settling.in", "-log", "none"], folder)
    states = {}
    with open(folder / "states.dump") as dump:
        for line in dump:
            if line.startswith("ITEM: TIMESTEP"):
                step = int(next(dump))
            elif line.startswith("ITEM: ATOMS"):
                states[step] = numpy.array([[float(word) for word in next(dump).split()[1:]] for _ in range(COUNT)])
    os.remove(folder / "states.dump")
    return states


YADE = """
import json, numpy
from math import atan
from yade import *
from yade.utils import sphere, wall
s = json.loads(open('scene_of_yade.json').read())
angle = atan(s['friction'])
if s['dashpots']:
    # Those of the pair are the sides' in series. A wall with what is stiffer makes another pair of the same ball.
    stiff = dict(density=s['density'], frictionAngle=angle, kn=2 * s['kn'], ks=2 * s['ks'])
    side = lambda ball, pair: 1 / (1 / pair - 1 / ball)
    inside, at_wall = s['dashpots']
    grain = O.materials.append(ViscElMat(cn=2 * inside[0], cs=2 * inside[1], **stiff))
    steel = O.materials.append(ViscElMat(cn=side(2 * inside[0], at_wall[0]), cs=side(2 * inside[1], at_wall[1]), **stiff))
    physics, law = Ip2_ViscElMat_ViscElMat_ViscElPhys(), Law2_ScGeom_ViscElPhys_Basic()
else:
    grain = steel = O.materials.append(FrictMat(density=s['density'], frictionAngle=angle))
    physics = Ip2_FrictMat_FrictMat_FrictPhys(kn=MatchMaker(algo='val', val=s['kn']),
                                              ks=MatchMaker(algo='val', val=s['ks']))
    law = Law2_ScGeom_FrictPhys_CundallStrack()
spheres = []
for place, velocity in s['balls']:
    spheres.append(O.bodies[O.bodies.append(sphere(place, s['radius'], material=grain))])
    # YADE's velocities are those of half a step before.
    spheres[-1].state.vel = (velocity[0], velocity[1], velocity[2] + 0.5 * s['dt'] * s['gravity'])
for place, axis, sense in (0, 0, 1), (s['side'], 0, -1), (0, 1, 1), (s['side'], 1, -1), (0, 2, 1):
    O.bodies.append(wall(place, axis=axis, sense=sense, material=steel))
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=1e-3),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()], [physics], [law]),
    NewtonIntegrator(damping=s['local'], gravity=(0, 0, -s['gravity'])),
]
O.dt = s['dt']
states = {}
for step in range(0, s['steps'] + 1, s['sample']):
    states[str(step)] = numpy.array([list(b.state.pos) + list(b.state.vel) for b in spheres])
    O.run(s['sample'], True)
numpy.savez('states_of_yade.npz', **states)
"""


def yade(folder, case, balls):
    scene = {"density": DENSITY, "friction": FRICTION, "kn": KN, "ks": KS, "dt": DT, "radius": RADIUS, "side": SIDE,
             "gravity": GRAVITY, "balls": balls, "steps": case.steps, "sample": case.sample,
             "local": LOCAL if case.damping == "local" else 0,
             "dashpots": [[dashpot(k, at_wall) for k in (KN, KS)] for at_wall in (False, True)]
             if case.damping == "dashpots" else None}
    (folder / "scene_of_yade.json").write_text(json.dumps(scene))
    (folder / "settling.py").write_text(YADE)
    run(["yade", "-j1", "-n", "-x", "settling.py"], folder)
    with numpy.load(folder / "states_of_yade.npz") as states:
        return {int(step): states[step] for step in states}


# --- one state, measured in the same way for all codes -----------------------------------------------------------------


def contacts(places):
    """(overlaps, normals) of the contacts between balls."""
    apart = places[None, :, :] - places[:, None, :]
    distance = numpy.sqrt((apart**2).sum(axis=2))
    first, second = numpy.nonzero(numpy.triu(distance < 2 * RADIUS, k=1))
    length = distance[first, second]
    return 2 * RADIUS - length, apart[first, second] / length[:, None]


def wall_overlaps(places):
    """{wall: overlaps of the balls that touch it}."""
    gaps = {"floor": places[:, 2], "sides": numpy.concatenate([places[:, :2].ravel(), (SIDE - places[:, :2]).ravel()])}
    return {wall: RADIUS - gap[gap < RADIUS] for wall, gap in gaps.items()}


def porosity(places, low, high):
    """Of the slab from wall to wall between two heights, with the parts of balls in it."""
    def below(z):  # volumes of the balls under a height
        depth = numpy.clip(z - places[:, 2] + RADIUS, 0, 2 * RADIUS)
        return (math.pi / 3 * depth**2 * (3 * RADIUS - depth)).sum()
    return 1 - (below(high) - below(low)) / (SIDE**2 * (high - low))


def observables(states, first):
    """{what: number}; energies over the weight times the mean height at the start."""
    scale = WEIGHT * first[:, 2].mean()
    found = {}
    for step in KINETIC_AT:
        found[f"kinetic energy, {step * DT:.2f} s"] = 0.5 * MASS * (states[step][:, 3:] ** 2).sum() / scale
    for step in HEIGHT_AT:
        found[f"potential energy, {step * DT:.2f} s"] = WEIGHT * states[step][:, 2].mean() / scale
    places = states[max(states)][:, :3]
    overlaps, normals = contacts(places)
    walls = wall_overlaps(places)
    everywhere = numpy.concatenate([overlaps, *walls.values()])
    found["elastic energy of normal springs at the end, 1e-6"] = 1e6 * 0.5 * KN * (everywhere**2).sum() / scale
    found["floor force over weight"] = KN * walls["floor"].sum() / WEIGHT
    found["mean height over R"] = places[:, 2].mean() / RADIUS
    found["porosity between 2 R and 14 R"] = porosity(places, 2 * RADIUS, 14 * RADIUS)
    found["contacts a ball"] = (2 * len(overlaps) + sum(map(len, walls.values()))) / COUNT
    fabric = normals.T @ normals / len(normals)
    found["fabric zz"] = fabric[2, 2]
    found["fabric xx - yy"] = fabric[0, 0] - fabric[1, 1]
    found["fabric xz"] = fabric[0, 2]
    return found


# --- the two comparisons -------------------------------------------------------------------------------------------------


def codes_of(program, case):
    codes = {"Eigengrain": lambda *what: eigengrain(program, *what)}
    if shutil.which("lmp") and case.damping != "local":  # LAMMPS has no local damping
        codes["LAMMPS"] = lammps
    if shutil.which("yade"):
        codes["YADE"] = yade
    return codes


def run_all(jobs, work):
    """Results of (name, code, case, balls), two at a time."""
    def one(job):
        name, code, case, balls = job
        folder = work / name
        folder.mkdir(parents=True, exist_ok=True)
        return code(folder, case, balls)
    with ThreadPoolExecutor(2) as pool:
        return list(pool.map(one, jobs))


def compare_paths(program, work, out):
    """Ball by ball, without damping; what is wrong."""
    case, balls = CASES["early"], start(1)
    # The same start but for a shift of each ball, far below what anyone measures: how fast two paths of one code part.
    chance = random.Random(2)
    twin = [(tuple(x + TWIN * RADIUS * chance.uniform(-1, 1) for x in place), velocity) for place, velocity in balls]
    codes = codes_of(program, case)
    jobs = [(f"early-{name}", code, case, balls) for name, code in codes.items()]
    jobs.append(("early-twin", codes["Eigengrain"], case, twin))
    states = dict(zip([*codes, "twin"], run_all(jobs, work)))
    ours = states.pop("Eigengrain")
    apart = {name: {step: numpy.sqrt(((theirs[step] - ours[step])[:, :3] ** 2).sum(axis=1)).max() / RADIUS for step in ours}
             for name, theirs in states.items()}
    fall = numpy.array([0, 0, -GRAVITY])
    out.append("| steps | balls that have collided | " + " | ".join(apart) + " |")
    out.append("| ---: | ---: |" + " ---: |" * len(apart))
    for step in EARLY_AT:
        free = ours[0][:, 3:] + fall * DT * (step - 0.5)  # velocities of half a step before
        collided = (abs(ours[step][:, 3:] - free).max(axis=1) > 1e-9).sum()
        out.append(f"| {step} | {collided} | " + " | ".join(f"{found[step]:.1e}" for found in apart.values()) + " |")
    wrong = []
    if "LAMMPS" in apart:
        ratio = max(apart["LAMMPS"][step] / apart["twin"][step] for step in ours if step > 0)
        out.append(f"\nLAMMPS is at most {ratio:.1f} times as far away as the twin.")
        if not ratio <= OF_TWIN:
            wrong.append(f"LAMMPS is {ratio:.1f} times as far away as a twin of ours, above {OF_TWIN}")
    if "YADE" in apart and not apart["YADE"][1000] <= OF_OVERLAP:
        wrong.append(f"YADE is {apart['YADE'][1000]:.1e} R away after 1000 steps, above {OF_OVERLAP} R")
    return wrong


def compare_statistics(program, work, case, seeds, out):
    """Means over the seeds, and their differences over what seeds differ by; what is wrong."""
    codes = codes_of(program, case)
    if len(codes) == 1:
        return []
    starts = [start(seed) for seed in range(1, seeds + 1)]
    jobs = [(f"{case.name}-{name}-{seed}", code, case, balls)
            for name, code in reversed(codes.items()) for seed, balls in enumerate(starts, 1)]
    states = iter(run_all(jobs, work))
    found = {name: [observables(next(states), numpy.array([place for place, _ in balls])) for balls in starts]
             for name in reversed(codes)}
    others = [name for name in codes if name != "Eigengrain"]
    out.append("| | Eigengrain | of one seed | " + " | ".join(f"{name} | difference" for name in others) + " |")
    out.append("| --- | ---: | ---: |" + " ---: | ---: |" * len(others))
    wrong = []
    error_of_mean = math.sqrt(2 / seeds)  # of the difference of two means, over the spread of one seed
    for what in found["Eigengrain"][0]:
        values = {name: [run[what] for run in found[name]] for name in codes}
        mean = {name: statistics.fmean(numbers) for name, numbers in values.items()}
        # One spread of all codes: each alone has few seeds to say it.
        spread = math.sqrt(statistics.fmean(statistics.variance(numbers) for numbers in values.values()))
        cells = [what, f"{mean['Eigengrain']:.4f}", f"{spread:.4f}"]
        for name in others:
            difference = mean[name] - mean["Eigengrain"]
            if what in OF_FALL:
                limit = OF_FALL[what] * mean["Eigengrain"]
                cells += [f"{mean[name]:.4f}", f"{difference / mean['Eigengrain']:+.2%}"]
            else:
                limit = STANDARD_ERRORS * error_of_mean * spread
                cells += [f"{mean[name]:.4f}", f"{difference / (error_of_mean * spread):+.1f} s"]
            if not abs(difference) <= limit:
                cells[-1] = f"**{cells[-1]}**"
                wrong.append(f"{case.name}, {what}: {mean[name]:.4f} in {name}, {mean['Eigengrain']:.4f} in Eigengrain; "
                             f"more than {limit:.4f} apart")
        out.append("| " + " | ".join(cells) + " |")
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(TREE / "build/release/bin/eigengrain"))
    parser.add_argument("--work", type=Path, default=TREE / "build/peers/settling", help="folder of scenes")
    parser.add_argument("--seeds", type=int, default=4, help="starts, of each of which every code makes a run")
    parser.add_argument("--local", action="store_true", help="local damping beside YADE's too")
    parser.add_argument("--out", help="file for the tables, in Markdown; stdout if absent")
    arguments = parser.parse_args()
    program, work = os.path.abspath(arguments.program), arguments.work.resolve()
    missing = [name for name, command in (("LAMMPS", "lmp"), ("YADE", "yade")) if not shutil.which(command)]
    for name in missing:
        print(f"skipped: {name} is not installed (Debian package {name.lower()})", file=sys.stderr)
    if len(missing) == 2:
        return 77
    out, began = [], time.monotonic()
    out.append("Largest distance between the same ball in two codes, over R, no damping:\n")
    wrong = compare_paths(program, work, out)
    for case in [CASES["settled"]] + [CASES["local"]] * arguments.local:
        out.append(f"\n{arguments.seeds} seeds, {case.damping}:\n")
        wrong += compare_statistics(program, work, case, arguments.seeds, out)
    out += [f"\n**{text}**" for text in wrong]
    text = "\n".join(out) + "\n"
    if arguments.out:
        Path(arguments.out).write_text(text)
    print(text, f"{time.monotonic() - began:.0f} s", sep="")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
