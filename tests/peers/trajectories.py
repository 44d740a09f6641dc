#!/usr/bin/python3
"""Impacts step by step beside LAMMPS and YADE: how far apart the codes are, at every step of the impact.

    trajectories.py [--program PATH] [--work FOLDER]      exit 77 if there is no other code

Two balls of different size collide, or one meets a wall: head-on, or obliquely and turning, so that the contact sticks
and slips. A difference is the largest over all steps, of velocities over the speed of approach and of spins (times R)
over it. What each code does otherwise than the others, and which options make it the same: README.md.
"""
import argparse
import csv
import json
import math
import os
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
TREE = HERE.parents[1]

DENSITY, KN, KS, FRICTION, DT, STEPS = 2500.0, 1e5, 5e4, 0.5, 1e-6, 400
Ball = dict  # position, radius, velocity, spin


def ball(position, radius, velocity, spin=(0, 0, 0)):
    return Ball(position=position, radius=radius, velocity=velocity, spin=spin)


# A gap of a few steps: all codes meet the contact as it forms.
GAP = 3.3e-6
SCENES = {
    "head-on": [ball((0, 0, 0), 5e-3, (0.4, 0, 0)), ball((9e-3 + GAP, 0, 0), 4e-3, (-0.6, 0, 0))],
    "oblique": [ball((0, 0, 0), 5e-3, (0.4, 0.3, -0.1), (10, -20, 60)),
                ball((9e-3 + GAP, 0, 0), 4e-3, (-0.6, -0.2, 0.3), (-50, 30, 15))],
    "wall": [ball((0, 0, 5e-3 + GAP), 5e-3, (0.5, 0.1, -0.8), (20, 0, 40))],
}
APPROACH = {"head-on": 1.0, "oblique": 1.0, "wall": 0.8}  # m/s
# Largest differences that are explained (README.md): rounding, and U/R, which comes to 1.5e-2 here, of tangential velocities.
ROUNDING, OF_OVERLAP = 1e-12, 0.015
EXPECTED = {
    ("LAMMPS", "head-on"): ROUNDING, ("YADE", "head-on"): ROUNDING,
    ("LAMMPS", "oblique"): ROUNDING, ("YADE", "oblique"): OF_OVERLAP,
    ("LAMMPS", "wall"): ROUNDING, ("YADE", "wall"): OF_OVERLAP,
    ("defaults", "oblique"): OF_OVERLAP, ("defaults", "wall"): OF_OVERLAP, ("defaults", "head-on"): ROUNDING,
}


def run(command, folder):
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\nexit {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def eigengrain(program, folder, name, matching):
    """{step: [(velocity, spin) of each ball, half a step before]}; `matching`: with the options that make LAMMPS's contact of it."""
    law = {"between": ["any", "any"], "law": "linear", "kn": KN, "ks": KS, "friction": FRICTION}
    if matching:
        law |= {"end_step": True, "projected": True}
    scene = {
        "materials": [{"name": "grain", "density": DENSITY}],
        "contacts": [law],
        "balls": [dict(b, material="grain", position=list(b["position"]), velocity=list(b["velocity"]),
                       spin=list(b["spin"])) for b in SCENES[name]],
        "damping": {"local": 0},
        "timestep": {"policy": "fixed", "dt": DT},
        "run": {"steps": STEPS},
        "histories": [{"file": "balls.csv", "every": 1, "balls": list(range(len(SCENES[name])))}],
    }
    if matching:
        scene["levers"] = "surface"
    if name == "wall":
        scene["walls"] = [{"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}, "material": "grain"}]
    (folder / "scene.yaml").write_text(json.dumps(scene))
    shutil.rmtree(folder / "out", ignore_errors=True)
    run([program, "run", "scene.yaml", "--threads", "1", "--output", "out"], folder)
    states = {}
    with open(folder / "out" / "balls.csv") as table:
        for row in csv.DictReader(table):
            values = {key.strip(): value for key, value in row.items()}
            step = int(next(value for key, value in values.items() if key.startswith("step")))
            states[step] = [vectors(values, number) for number in range(len(SCENES[name]))]
    return states


def vectors(values, number):
    """Velocity and spin of a ball from a line of the table."""
    mine = [float(value) for key, value in values.items() if key.startswith(f"ball {number} ")]
    return mine[3:6], mine[6:9]  # position, velocity, spin


def lammps(folder, name):
    balls = SCENES[name]
    lines = ["impact", "", f"{len(balls)} atoms", "1 atom types", "", "-1 1 xlo xhi", "-1 1 ylo yhi", "-1 1 zlo zhi", "",
             "Atoms # sphere", ""]
    lines += [f"{k + 1} 1 {2 * b['radius']!r} {DENSITY!r} " + " ".join(map(repr, map(float, b["position"])))
              for k, b in enumerate(balls)]
    lines += ["", "Velocities", ""]
    lines += [f"{k + 1} " + " ".join(map(repr, map(float, (*b["velocity"], *b["spin"])))) for k, b in enumerate(balls)]
    (folder / "impact.data").write_text("\n".join(lines) + "\n")
    wall = f"fix floor all wall/gran hooke/history {KN} {KS} 0 0 {FRICTION} 0 zplane 0 NULL" if name == "wall" else ""
    (folder / "impact.in").write_text(f"""units si
atom_style sphere
atom_modify map array
boundary f f f
newton off
comm_modify vel yes cutoff 0.05
read_data impact.data
pair_style gran/hooke/history {KN} {KS} 0 0 {FRICTION} 0
pair_coeff * *
neighbor 1e-3 bin
{wall}
fix motion all nve/sphere
timestep {DT!r}
dump states all custom 1 states.dump id vx vy vz omegax omegay omegaz
dump_modify states sort id format float %.17g
run {STEPS}
""")
    run(["lmp", "-in", "impact.in", "-log", "none"], folder)
    states, step = {}, None
    for line in (folder / "states.dump").read_text().splitlines():
        if step == "next":
            step = int(line)
            states[step] = []
        elif line.startswith("ITEM: TIMESTEP"):
            step, reading = "next", False
        elif line.startswith("ITEM: ATOMS"):
            reading = True
        elif isinstance(step, int) and reading:
            numbers = [float(word) for word in line.split()[1:]]
            states[step].append((numbers[:3], numbers[3:]))
    return half_steps(states)


YADE = """
import json, sys
from math import atan
from yade import *
from yade.utils import sphere, wall
scene = json.loads(open('scene_of_yade.json').read())
grain = O.materials.append(FrictMat(density=scene['density'], frictionAngle=atan(scene['friction'])))
physics = Ip2_FrictMat_FrictMat_FrictPhys(kn=MatchMaker(algo='val', val=scene['kn']),
                                          ks=MatchMaker(algo='val', val=scene['ks']))
for b in scene['balls']:
    number = O.bodies.append(sphere(b['position'], b['radius'], material=grain))
    O.bodies[number].state.vel = b['velocity']
    O.bodies[number].state.angVel = b['spin']
if scene['wall']:
    O.bodies.append(wall(0, axis=2, sense=1, material=grain))
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=1e-3),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()], [physics],
                    [Law2_ScGeom_FrictPhys_CundallStrack()]),
    NewtonIntegrator(damping=0),
]
O.dt = scene['dt']
states = []
for step in range(scene['steps'] + 1):
    states.append([(list(b.state.vel), list(b.state.angVel)) for b in O.bodies if isinstance(b.shape, Sphere)])
    O.run(1, True)
json.dump(states, open('states_of_yade.json', 'w'))
"""


def yade(folder, name):
    """Velocities before each step."""
    scene = {"density": DENSITY, "friction": FRICTION, "kn": KN, "ks": KS, "dt": DT, "steps": STEPS,
             "balls": SCENES[name], "wall": name == "wall"}
    (folder / "scene_of_yade.json").write_text(json.dumps(scene))
    (folder / "impact.py").write_text(YADE)
    run(["yade", "-j1", "-n", "-x", "impact.py"], folder)
    states = json.loads((folder / "states_of_yade.json").read_text())
    return dict(enumerate(states))


def half_steps(states):
    """Velocities of the half steps from those of the whole ones, v(t) = (v(t - dt/2) + v(t + dt/2))/2."""
    halves = {0: states[0]}
    for step in range(1, max(states) + 1):
        halves[step] = [
            tuple([2 * whole - before for whole, before in zip(now_part, old_part)] for now_part, old_part in zip(now, old))
            for now, old in zip(states[step - 1], halves[step - 1])]
    return halves


def difference(left, right, name):
    worst = 0.0
    for step in sorted(set(left) & set(right)):
        for k, (mine, other) in enumerate(zip(left[step], right[step])):
            radius = SCENES[name][k]["radius"]
            worst = max(worst, math.dist(mine[0], other[0]), radius * math.dist(mine[1], other[1]))
    return worst / APPROACH[name]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(TREE / "build/release/bin/eigengrain"))
    parser.add_argument("--work", type=Path, default=TREE / "build/peers/trajectories", help="folder of scenes")
    arguments = parser.parse_args()
    program = os.path.abspath(arguments.program)
    if not shutil.which("lmp") and not shutil.which("yade"):
        return 77
    failed = False
    print("| impact | ours with LAMMPS's options beside | largest difference of velocities over the speed of approach |")
    print("| --- | --- | ---: |")
    for name in SCENES:
        folder = arguments.work.resolve() / name
        folder.mkdir(parents=True, exist_ok=True)
        ours = eigengrain(program, folder, name, matching=True)
        rows = [("defaults", eigengrain(program, folder, name, matching=False))]
        if shutil.which("lmp"):
            rows.append(("LAMMPS", lammps(folder, name)))
        if shutil.which("yade"):
            rows.append(("YADE", yade(folder, name)))
        for code, other in rows:
            found = difference(ours, other, name)
            limit = EXPECTED[code, name]
            failed = failed or not found <= limit
            print(f"| {name} | {code} | {found:.1e} |" + ("" if found <= limit else f" **above {limit:.0e}**"))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
