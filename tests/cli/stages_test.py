#!/usr/bin/env python3
"""Stages of `run`: a whole test in one file. Arguments: the program, and whether it has PETSc."""
import math
import signal
import subprocess
import sys
import time
import unittest

import h5py
import numpy

from program import PROGRAM, ProgramTest

HAS_PETSC = sys.argv[2] == "ON"

R, DENSITY, KN, G = 5e-3, 2500.0, 2e4, 9.81
MASS = 4 / 3 * math.pi * R ** 3 * DENSITY
BOX = f"""
gravity: [0, 0, -{G}]
materials: [{{name: glass, density: {DENSITY}}}]
contacts: [{{between: [glass, glass], law: linear, kn: {KN}, ks: 1e4, friction: 0.5}}]
walls: [{{box: {{min: [0, 0, 0], max: [60 mm, 60 mm, 1], open: [+z]}}, material: glass}}]
timestep: {{policy: bound}}
"""
# One layer to fall on, and a few balls above it.
LAYER = """
balls:
  - {lattice: square, radius: 5 mm, material: glass, box: {min: [0, 0, 0], max: [60 mm, 60 mm, 10 mm]}}
  - {position: [21 mm, 22 mm, 20 mm], radius: 5 mm, material: glass}
"""
POUR = """
  - name: pour
    repeat: 3
    balls: [{fill: random, fraction: 0.15, radius: 5 mm, material: glass, velocity: [0, 0, -0.5],
             box: {min: [0, 0, 0.03], max: [60 mm, 60 mm, 0.09]}}]
    run: {time: 30 ms}
"""


def arrays(file):
    """All that a state holds but where its numbers were made."""
    found = {}
    with h5py.File(file, "r") as state:
        state.visititems(lambda name, item: found.update({name: item[()]})
                         if isinstance(item, h5py.Dataset) and name != "settings" else None)
        for key in ("time", "step", "dt", "next_dt"):
            found[key] = state.attrs[key]
    return found


class Stages(ProgramTest):
    scene_name = "tale.yaml"

    def expect_same_state(self, first, second):
        a, b = arrays(first), arrays(second)
        self.assertEqual(set(a), set(b))
        for name in a:
            self.assertEqual(numpy.asarray(a[name]).tobytes(), numpy.asarray(b[name]).tobytes(), name)

    def run_until_interrupted(self, *arguments, after=0.4):
        running = subprocess.Popen([PROGRAM, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   text=True)
        time.sleep(after)
        running.send_signal(signal.SIGINT)
        running.communicate(timeout=60)
        return running.returncode

    def test_a_stage_is_what_a_user_would_do_by_hand(self):
        tilt = "[1.7, 0, -9.66]"
        stages = ("stages:\n  - {name: settle, run: {steps: 700}}\n"
                  f"  - {{set: {{gravity: {tilt}, contacts.0.friction: 0.3}}, run: {{steps: 400}}}}\n")
        _, report = self.succeed("run", self.scene(BOX + LAYER + stages), "--output", self.folder / "stages")
        self.assertEqual([entry["steps"] for entry in report["stages"]], [700, 400])
        self.assertEqual(report["step"], 1100)
        by_hand = self.scene(BOX + LAYER)
        self.succeed("run", by_hand, "--output", self.folder / "hand", "--set", "run.steps=700")
        self.succeed("run", self.folder / "hand" / "tale.h5", "--set", "run.steps=1100", "--set", f"gravity={tilt}",
                     "--set", "contacts.0.friction=0.3")
        a, b = arrays(self.folder / "stages" / "tale.h5"), arrays(self.folder / "hand" / "tale.h5")
        self.assertEqual(set(a), set(b))
        for name in a:
            self.assertEqual(numpy.asarray(a[name]).tobytes(), numpy.asarray(b[name]).tobytes(), name)

    def test_goes_on_with_the_stage_that_it_was_stopped_in(self):
        scene = self.scene(BOX + LAYER + "stages:" + POUR + "  - {set: {damping.local: 0.3}, run: {steps: 15000}}\n"
                           "histories: [{file: t.csv, every: 100, of: [energies]}]\noutputs: {checkpoint: 1000}\n")
        self.succeed("run", scene, "--output", self.folder / "whole", "--threads", 1)
        stopped = 0
        file = scene
        for _ in range(60):
            code = self.run_until_interrupted("run", file, "--output", self.folder / "parts", "--threads", 1)
            file = self.folder / "parts" / "tale.h5"
            if code == 0:
                break
            self.assertEqual(code, 128 + signal.SIGINT)
            stopped += 1
        self.assertEqual(code, 0)
        self.assertGreater(stopped, 0)
        self.expect_same_state(self.folder / "whole" / "tale.h5", file)
        self.assertEqual((self.folder / "whole" / "t.csv").read_text(), (self.folder / "parts" / "t.csv").read_text())
        text, report = self.succeed("run", file)
        self.assertEqual(report["steps"], 0)  # all is done

    def test_balls_that_are_poured_come_to_rest_on_the_floor(self):
        scene = self.scene(BOX + LAYER + "stages:" + POUR +
                           "  - {name: rest, run: {until: {unbalanced: 1e-4, kinetic: 1 nJ}}, save: rest.h5}\n")
        text, report = self.succeed("run", scene, "--output", self.folder)
        self.assertIn("stage 1 of 2 (pour), 2 of 3: ", text)
        self.assertEqual([entry["name"] for entry in report["stages"]], ["pour"] * 3 + ["rest"])
        self.assertLess(report["energies"]["kinetic"], 1e-9)
        state = arrays(self.folder / "rest.h5")
        balls = len(state["bodies/identity"])
        self.assertGreater(balls, 37 + 3 * 20)
        self.assertEqual(sorted(state["bodies/identity"]), list(range(balls)))
        # Contacts carry the weight: the sum of their forces on all balls lacks what is still unbalanced.
        total = state["bodies/force"].sum(axis=0)
        self.assertAlmostEqual(total[2] / (balls * MASS * G), 1, delta=1e-3)
        self.assertGreater(state["bodies/position"][:, 2].min(), 0)

    def test_groups_are_held_and_let_go(self):
        # The upper ball is lifted at a given speed, and let go.
        scene = self.scene(BOX + LAYER + """
groups: [{name: top, box: {min: [0, 0, 15 mm], max: [1, 1, 1]}}]
stages:
  - {bodies: [{group: top, fix: z, velocity: [0, 0, 2]}], run: {time: 10 ms}, save: up.h5}
  - {bodies: [{group: top, free: z}, {box: {min: [0, 0, 0], max: [1, 1, 10.1 mm]}, growth: {factor: 0.5}}],
     set: {damping.local: 0}, run: {time: 10 ms}}
""")
        text, report = self.succeed("check", scene)
        self.assertIn("group       top, 1 ball\n", text)
        self.assertEqual(report["groups_of_balls"], {"top": 1})
        self.succeed("run", scene, "--output", self.folder)
        up, end = arrays(self.folder / "up.h5"), arrays(self.folder / "tale.h5")
        top = numpy.argmax(up["bodies/identity"])
        z = up["bodies/position"][top, 2]
        self.assertAlmostEqual(z, 20e-3 + 2 * up["time"], delta=1e-12)
        # Free at t₁ with 2 m/s half a step before: z + (v + ½ g dt) t - ½ g t (t + dt), steps of one length.
        t, dt = end["time"] - up["time"], end["dt"]
        self.assertAlmostEqual(end["bodies/position"][top, 2], z + 2 * t - 0.5 * G * t * t, delta=G * dt * t)
        lower = numpy.flatnonzero(end["bodies/radius"] < R)
        self.assertEqual(len(lower), 36)
        numpy.testing.assert_allclose(end["bodies/radius"][lower], 2.5e-3, rtol=1e-15)
        numpy.testing.assert_allclose(end["bodies/mass"][lower], MASS / 8, rtol=1e-14)

    def test_contacts_that_exist_take_another_entry_and_a_state_knows(self):
        scene = self.scene(BOX.replace("contacts: [", "contacts: [{name: damped, between: [any, any], law: linear, "
                                       f"kn: {KN}, ks: 1e4, friction: 0.5, beta_n: 0.2}}, ") + LAYER + """
stages:
  - {run: {steps: 300}}
  - {contacts: [{take: damped, wall: wall 1 (box -z)}], run: {steps: 300}}
  - {run: {steps: 100}}
""")
        text, report = self.succeed("run", scene, "--output", self.folder)
        self.assertIn("stage 2 of 3: 36 contacts by damped", text)
        text, _ = self.succeed("check", self.folder / "tale.h5")
        self.assertRegex(text, r"3\d ball-wall, linear by contacts\[0\] any-any")  # a few may have opened since
        text = self.fail_with("check", self.scene(BOX + LAYER + "stages: [{contacts: [{take: damped}]}]\n"))
        self.assertIn('no entry of contacts has the name "damped"', text)

    def test_ends_when_a_wall_feels_the_force(self):
        # The floor is pushed up under a ball that is held: kn U = 2 N after U = 0.1 mm, at 10 mm/s after 10 ms.
        scene = self.scene(f"""
materials: [{{name: glass, density: {DENSITY}}}]
contacts: [{{between: [glass, glass], law: linear, kn: {KN}}}]
balls: [{{position: [0, 0, 5 mm], radius: 5 mm, material: glass, fix: all}}]
walls: [{{plane: {{point: [0, 0, 0], normal: [0, 0, 1]}}, material: glass, velocity: [0, 0, 10 mm/s]}}]
timestep: {{policy: fixed, dt: 1 us}}
stages:
  - {{run: {{time: 1 s, until: {{wall_force: {{wall: wall 1 (plane), at_least: 2 N}}}}}}}}
  - {{run: {{steps: 500, until: {{wall_force: {{wall: wall 1 (plane), at_least: 200 N}}}}}}}}
""")
        text, report = self.succeed("run", scene, "--output", self.folder)
        self.assertEqual([entry["met"] for entry in report["stages"]], [True, False])
        # Looked at every 100 steps; rounding may hide the very first.
        self.assertIn(report["stages"][0]["steps"], (10000, 10100))
        self.assertIn("the conditions of `until` did not hold together", text)

    @unittest.skipUnless(HAS_PETSC, "built without PETSc")
    def test_relaxes_between_runs(self):
        scene = self.scene(BOX + LAYER + "stages:\n  - {run: {time: 40 ms}}\n  - {relax: {tolerance: 1e-9}, save: r.h5}\n"
                           "  - {run: {steps: 200}}\n")
        _, report = self.succeed("run", scene, "--output", self.folder)
        self.assertEqual([entry["does"] for entry in report["stages"]], ["run", "relax", "run"])
        self.assertTrue(report["stages"][1]["converged"])
        self.assertLess(report["stages"][1]["unbalanced"]["mean"], 1e-9)
        self.assertLess(report["unbalanced"]["mean"], 1e-9)  # and stays there
        _, relaxed = self.succeed("check", self.folder / "r.h5")
        self.assertEqual(relaxed["stages"], 3)

    @unittest.skipIf(HAS_PETSC, "built with PETSc")
    def test_says_that_it_cannot_relax(self):
        self.assertIn("stages[0]: this program was built without PETSc and cannot relax",
                      self.fail_with("run", self.scene(BOX + LAYER + "stages: [{relax: {}}]\n"), "--output", self.folder))

    def test_mistakes_of_all_stages_are_told_before_anything_runs(self):
        text = self.fail_with("run", self.scene(BOX + LAYER + """
stages:
  - {run: {steps: 10}}
  - {set: {contacts.0.fricton: 1}}
  - {balls: [{position: [0, 0, 0], radius: 1, material: glas}]}
"""), "--output", self.folder)
        self.assertIn("2 mistakes:", text)
        self.assertIn("stages[1].set: ", text)
        self.assertIn('unknown key; did you mean "friction"?', text)
        self.assertIn("stages[2].balls[0].material", text)
        self.assertFalse((self.folder / "tale.h5").exists())

    def test_a_group_that_nobody_is_in_is_an_error(self):
        text = self.fail_with("check", self.scene(BOX + LAYER + "groups: [{name: far, sphere: {centre: [9, 9, 9], "
                                                  "radius: 1}}]\n"))
        self.assertIn('groups, "far": no ball is meant', text)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
