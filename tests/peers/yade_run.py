"""The scene of packings.py in YADE.   yade -jN -n -x yade_run.py PACKING STEPS VERLET

Prints one line `RESULT {...}`. Runs in YADE's own interpreter.
"""
import json
import sys
import time
from math import atan

from yade import *
from yade.utils import sphere, wall

packing, steps, verlet = sys.argv[1], int(sys.argv[2]), float(sys.argv[3])
grain = O.materials.append(FrictMat(density=2500, frictionAngle=atan(0.5)))
# YADE would take stiffness from the material's modulus and the radii; these are the pair's own, in N/m.
physics = Ip2_FrictMat_FrictMat_FrictPhys(kn=MatchMaker(algo='val', val=1e5), ks=MatchMaker(algo='val', val=5e4))
with open(packing) as lines:
    box = [float(s) for s in next(lines).split()[2:5]]
    rows = [tuple(float(s) for s in line.split()) for line in lines]
# Neighbours in space near each other in memory, which YADE leaves to its user: 1.5 times as fast with 100,000 balls.
rows.sort(key=lambda row: [row[axis] // 0.02 for axis in (2, 1, 0)])
weight = 0
for x, y, z, r in rows:
    number = O.bodies.append(sphere((x, y, z), r, material=grain))
    weight += O.bodies[number].state.mass * 9.81
balls = len(rows)
del rows  # not to count as YADE's memory, as far as Python gives it back
for position, axis, side in (0, 0, 1), (box[0], 0, -1), (0, 1, 1), (box[1], 1, -1):
    O.bodies.append(wall(position, axis=axis, sense=side, material=grain))
floor = O.bodies.append(wall(0, axis=2, sense=1, material=grain))
# Only what a step needs: no engine that measures, controls the timestep or draws.
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=verlet),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()], [physics],
                    [Law2_ScGeom_FrictPhys_CundallStrack()]),
    NewtonIntegrator(damping=0, gravity=(0, 0, -9.81)),
]
O.dt = 2e-5
O.run(2, True)  # the first neighbour search: set-up, as in the other codes
start = time.perf_counter()
O.run(steps - 2, True)
seconds = time.perf_counter() - start
O.run(1, True)  # YADE moves after it sums forces: one more step gives those at the end of the last
print('RESULT ' + json.dumps({'balls': balls, 'steps': steps - 2, 'seconds': seconds,
                              'floor': -O.forces.f(floor)[2] / weight}), flush=True)
