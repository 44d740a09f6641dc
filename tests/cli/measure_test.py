#!/usr/bin/env python3
"""`measure` and its tables on the packing of 10,000 balls, against numpy. Arguments: the program, the examples."""
import csv
import math
import pathlib
import sys
import unittest

import numpy

from program import ProgramTest

EXAMPLES = pathlib.Path(sys.argv[2]).resolve()
WIDTH = 0.21
KN, DENSITY, G = 1e5, 2500.0, 9.81

# The walls of the packing without friction, so that the floor carries all of the weight.
SMOOTH_WALLS = f"""
gravity: [0, 0, -{G}]
materials: [{{name: grain, density: {DENSITY}}}, {{name: wall}}]
contacts:
  - {{between: [grain, grain], law: linear, kn: {KN}, ks: 5e4, friction: 0.5}}
  - {{between: [grain, wall], law: linear, kn: {KN}}}
balls: [{{file: {EXAMPLES}/data/packing_10k.txt, material: grain}}]
walls: [{{box: {{min: [0, 0, 0], max: [{WIDTH}, {WIDTH}, 0.254], open: [+z]}}, material: wall}}]
measures:
  - {{name: floor, box: {{min: [0, 0, 0], max: [{WIDTH}, {WIDTH}, 1 mm]}}}}
  - {{name: middle, box: {{min: [0, 0, 0.1], max: [{WIDTH}, {WIDTH}, 0.15]}}}}
run: {{steps: 1000}}
histories: [{{file: table.csv, every: 500, of: [walls, ledger], measures: [floor, middle]}}]
"""


def packing():
    table = numpy.loadtxt(EXAMPLES / "data" / "packing_10k.txt")
    return table[:, :3], table[:, 3]


def pairs_that_touch(x, r):
    """All pairs (i < j) with overlapping balls, by cells as wide as the largest ball."""
    width = 2 * r.max() * (1 + 1e-9)
    cells = {}
    for i, key in enumerate(map(tuple, numpy.floor(x / width).astype(int))):
        cells.setdefault(key, []).append(i)
    pairs = []
    for (a, b, c), mine in cells.items():
        near = [j for da in (-1, 0, 1) for db in (-1, 0, 1) for dc in (-1, 0, 1)
                for j in cells.get((a + da, b + db, c + dc), ())]
        near = numpy.array(near)
        for i in mine:
            touching = near[(near > i) & (numpy.linalg.norm(x[near] - x[i], axis=1) < r[near] + r[i])]
            pairs += [(i, j) for j in touching]
    return numpy.array(pairs)


class Measures(ProgramTest):
    def test_contacts_stress_and_porosity_are_those_of_numpy(self):
        x, r = packing()
        pairs = pairs_that_touch(x, r)
        i, j = pairs.T
        branch = x[j] - x[i]
        distance = numpy.linalg.norm(branch, axis=1)
        n = branch / distance[:, None]
        force = KN * (r[i] + r[j] - distance)
        count = numpy.bincount(i, minlength=len(r)) + numpy.bincount(j, minlength=len(r))
        walls = []
        for axis, place, direction in ((0, 0, 1), (0, WIDTH, -1), (1, 0, 1), (1, WIDTH, -1), (2, 0, 1)):
            gap = (x[:, axis] - place) * direction
            at = numpy.nonzero(gap < r)[0]
            count += numpy.bincount(at, minlength=len(r))
            walls.append((at, axis, -direction, r[at] - gap[at]))

        # Rattlers, one round after the other.
        held = numpy.ones(len(r), dtype=bool)
        while True:
            both = held[i] & held[j]
            links = numpy.bincount(i[both], minlength=len(r)) + numpy.bincount(j[both], minlength=len(r))
            for at, *_ in walls:
                links += numpy.bincount(at, minlength=len(r))
            loose = held & (links < 2)
            if not loose.any():
                break
            held &= ~loose

        text, report = self.succeed("measure", EXAMPLES / "scenes" / "packing_10k.yaml", "--region", "name: all",
                                    "--region", "name: middle, box: {min: [-1, -1, 0.1], max: [1, 1, 0.15]}")
        self.assertIn("coordination", text)
        everything, middle = report["regions"]
        self.assertEqual(everything["bodies"], len(r))
        self.assertEqual(everything["rattlers"], int((~held).sum()))
        self.assertGreater(everything["rattlers"], 0)
        self.assertAlmostEqual(everything["coordination"], count.mean(), delta=1e-12)
        self.assertAlmostEqual(everything["coordination_without_rattlers"], links[held].mean(), delta=1e-12)
        inside = (x[:, 2] >= 0.1) & (x[:, 2] < 0.15)
        self.assertEqual(middle["bodies"], int(inside.sum()))
        self.assertAlmostEqual(middle["coordination"], count[inside].mean(), delta=1e-12)

        # A slab: each branch with the part of its height that is inside.
        def part(start, end):
            low, high = numpy.minimum(start, end), numpy.maximum(start, end)
            return numpy.clip(numpy.minimum(high, 0.15) - numpy.maximum(low, 0.1), 0, None) / (high - low)
        stress = -numpy.einsum("c,c,ci,cj->ij", part(x[i, 2], x[j, 2]), force, n, branch)
        for at, axis, direction, overlap in walls:
            reach = direction * (r[at] - overlap / 2)
            if axis == 2:
                weight = part(x[at, 2], x[at, 2] + reach)
            else:
                weight = inside[at]
            stress[axis, axis] -= (weight * KN * overlap * direction * reach).sum()
        stress /= middle["volume"]
        # Forces of an ulp of x times k_n, 1e-12 of a mean one; sums of thousands in another order.
        numpy.testing.assert_allclose(middle["stress"], stress, rtol=0, atol=1e-10 * abs(stress).max())

        # Porosity of a slab by caps.
        def below(height):
            h = numpy.clip((height - x[:, 2]) / r, -1, 1)
            return (math.pi / 3 * r ** 3 * (1 + h) ** 2 * (2 - h)).sum()
        solid = below(0.15) - below(0.1)
        self.assertAlmostEqual(middle["porosity"], 1 - solid / middle["volume"], delta=1e-12)

        # Fabric of the ends in the slab.
        ends = inside[i].astype(float) + inside[j]
        tensor = numpy.einsum("c,ci,cj->ij", ends, n, n)
        total = ends.sum()
        for at, axis, *_ in walls:
            tensor[axis, axis] += inside[at].sum()
            total += inside[at].sum()
        numpy.testing.assert_allclose(middle["fabric"], tensor / total, rtol=0, atol=1e-12)

    def test_the_floor_carries_the_weight_and_the_ledger_closes(self):
        scene = self.folder / "smooth.yaml"
        scene.write_text(SMOOTH_WALLS)
        _, run = self.succeed("run", scene, "--output", self.folder / "out")
        with open(self.folder / "out" / "table.csv", newline="") as table:
            rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(table)]
        self.assertEqual([row["step"] for row in rows], [0, 500, 1000])
        last = rows[-1]
        _, r = packing()
        weight = DENSITY * G * (4 / 3 * math.pi * r ** 3).sum()
        (floor,) = (last[name] for name in last if "-z) force z" in name)
        # What hangs in the slab is the floor's contacts alone: its stress is their force over the area.
        self.assertAlmostEqual(last["floor stress zz [Pa]"] * WIDTH ** 2 / floor, 1, delta=1e-12)
        # And that is the weight, but for what still moves.
        self.assertAlmostEqual(last["floor stress zz [Pa]"] * WIDTH ** 2 / -weight, 1, delta=1e-3)

        # The table and the verb say the same of the state.
        _, report = self.succeed("measure", self.folder / "out" / "smooth.h5")
        names = [region["name"] for region in report["regions"]]
        self.assertEqual(names, ["floor", "middle"])
        middle = report["regions"][1]
        self.assertEqual(middle["stress"][2][2], last["middle stress zz [Pa]"])
        self.assertEqual(middle["sliding"], last["middle sliding"])
        self.assertEqual(middle["strain_rate"][0][0], last["middle strain rate xx [1/s]"])

        ledger = run["ledger"]
        self.assertEqual(ledger["slip_loss"], last["slip loss [J]"])
        self.assertGreater(ledger["damping_loss"], 0)
        self.assertGreater(ledger["slip_loss"], 0)
        self.assertEqual(rows[0]["balance error [J]"], 0)
        # The balls start at once with what is not balanced: the first step errs by 1/8 dt^2 a·M a, and all that
        # follows by little: a contact that opens or closes changes its energy, here some 1e-8 J, by up to a tenth of it
        # (1/4 dt^2 k/m), and a few do.
        turned_over = ledger["gravity_work"] + rows[0]["elastic normal [J]"]
        self.assertLess(abs(rows[1]["balance error [J]"]), 1e-3 * turned_over)
        self.assertLess(abs(last["balance error [J]"] - rows[1]["balance error [J]"]), 5e-5 * ledger["gravity_work"])

    def test_of_a_column_with_all_that_there_is(self):
        """Glued balls with dashpots at rest on a polygon in a periodic cell, under local damping."""
        mass = DENSITY * 4 / 3 * math.pi * 5e-3 ** 3
        sinks = [2 * mass * G / KN, mass * G / KN]
        low = 5e-3 - sinks[0]
        high = low + 10e-3 - sinks[1]
        scene = self.folder / "column.yaml"
        scene.write_text(f"""
gravity: [0, 0, -{G}]
materials: [{{name: grain, density: {DENSITY}}}, {{name: wall}}]
contacts:
  - {{between: [grain, grain], law: linear, kn: {KN}, ks: 5e4, friction: 0.5, restitution: 0.8,
     bond: {{kind: contact, tension: 1e3, gap: 0.1 mm}}}}
  - {{between: [grain, wall], law: linear, kn: {KN}, restitution: 0.8}}
damping: {{local: 0.2}}
periodic: {{box: [0.02, 0.02, 1], axes: [x, y]}}
balls:
  - {{position: [0.01, 0.008, {low!r}], radius: 5 mm, material: grain}}
  - {{position: [0.01, 0.008, {high!r}], radius: 5 mm, material: grain}}
walls:
  - {{polygon: {{corners: [[-0.1, -0.1, 0], [0.1, -0.1, 0], [0.1, 0.1, 0], [-0.1, 0.1, 0]]}}, material: wall}}
measures:
  - {{name: floor, box: {{min: [0, 0, 0], max: [0.02, 0.02, 1 mm]}}}}
  - {{name: middle, box: {{min: [0, 0, 8 mm], max: [0.02, 0.02, 12 mm]}}}}
  - {{name: all}}
run: {{steps: 200}}
outputs: {{series: 100, fields: [stress]}}
histories: [{{file: table.csv, every: 100, of: [walls, ledger], measures: [floor, middle]}}]
""")
        self.succeed("run", scene, "--output", self.folder / "out")
        for source in (scene, self.folder / "out" / "column.h5"):
            _, report = self.succeed("measure", source)
            floor, middle, everything = report["regions"]
            # Overlaps are differences of 1e-2: an ulp times k_n, 1e-12 of a weight of 1e-2.
            self.assertAlmostEqual(floor["stress"][2][2] * 0.02 ** 2 / (-2 * mass * G), 1, delta=1e-10)
            self.assertAlmostEqual(middle["stress"][2][2] * 0.02 ** 2 / (-mass * G), 1, delta=1e-10)
            self.assertEqual(everything["coordination"], 1.5)
            self.assertEqual(everything["sliding"], 0)
        with open(self.folder / "out" / "table.csv", newline="") as table:
            last = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(table)][-1]
        self.assertAlmostEqual(last["middle stress zz [Pa]"], middle["stress"][2][2], delta=0)
        self.assertAlmostEqual(last["elastic normal [J]"] / (KN / 2 * sum(s ** 2 for s in sinks)), 1, delta=1e-9)
        self.assertLess(abs(last["balance error [J]"]), 1e-9 * last["elastic normal [J]"])

    def test_mistakes_in_regions_are_explained(self):
        text = self.fail_with("measure", EXAMPLES / "scenes" / "packing_10k.yaml", "--region", "sphere: {radius: 1}")
        self.assertIn("--region", text)
        self.assertIn("centre is missing", text)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
