#!/usr/bin/env python3
"""`run` and `relax` as a user meets them. Arguments: the program, and whether it has PETSc."""
import csv
import math
import os
import signal
import subprocess
import sys
import time
import unittest

from program import PROGRAM, ProgramTest

HAS_PETSC = sys.argv[2] == "ON"

MASS = 4 / 3 * math.pi * 5e-3 ** 3 * 2500
COLUMN = """
gravity: [0, 0, -9.81]
materials: [{name: glass, density: 2500}]
contacts: [{between: [glass, glass], law: linear, kn: 2e4, ks: 1e4, friction: 0.5}]
balls:
  - {position: [0, 0, 5 mm], radius: 5 mm, material: glass}
  - {position: [0, 0, 15 mm], radius: 5 mm, material: glass}
  - {position: [0, 0, 25 mm], radius: 5 mm, material: glass}
walls: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: glass}]
"""
RUN = """
run: {steps: 400}
outputs: {checkpoint: 100, series: 100}
measures: [{name: all}]
histories: [{file: column.csv, every: 50, of: [energies, unbalanced, walls, ledger], measures: all, balls: [2]}]
"""
# Three balls hang on each other. The upper bond carries two weights, 327 Pa, and more while they swing.
CHAIN = """
gravity: [0, 0, -9.81]
materials: [{name: glass, density: 2500}]
contacts:
  - between: [glass, glass]
    law: linear
    kn: 2e4
    bond: {kind: parallel, kn: 5e8 Pa/m, ks: 2e8 Pa/m, tension: 280 Pa, gap: 1 um}
balls:
  - {position: [0, 0, 30 mm], radius: 5 mm, material: glass, fix: all}
  - {position: [0, 0, 20 mm], radius: 5 mm, material: glass}
  - {position: [0, 0, 10 mm], radius: 5 mm, material: glass}
"""


class Runs(ProgramTest):
    scene_name = "column.yaml"

    def test_a_column_comes_to_rest_under_its_weight(self):
        _, report = self.succeed("run", self.scene(COLUMN + RUN), "--output", self.folder / "out")
        self.assertEqual(report["steps"], 400)
        self.assertGreater(report["particle_steps_per_second"], 0)
        self.assertLess(report["unbalanced"]["mean"], 1e-3)
        self.assertEqual(report["unsupported"], 0)
        with open(self.folder / "out" / "column.csv", newline="") as table:
            rows = list(csv.DictReader(table))
        self.assertEqual([int(row["step"]) for row in rows], list(range(0, 401, 50)))
        (floor,) = (name for name in rows[0] if "force z" in name)
        # The floor carries the weight but for what is still unbalanced.
        self.assertAlmostEqual(float(rows[-1][floor]) / (-3 * MASS * 9.81), 1, delta=1e-2)
        self.assertTrue((self.folder / "out" / "column.pvd").exists())
        self.assertTrue((self.folder / "out" / "column.h5").exists())

    def test_a_run_in_two_parts_ends_with_the_same_numbers(self):
        scene = self.scene(COLUMN + RUN)
        _, whole = self.succeed("run", scene, "--output", self.folder / "whole", "--threads", 1)
        self.succeed("run", scene, "--output", self.folder / "parts", "--set", "run.steps=200")
        _, parts = self.succeed("run", self.folder / "parts" / "column.h5", "--set", "run.steps=400", "--threads", 2)
        self.assertEqual(parts["steps"], 200)
        for key in ("step", "time", "dt", "unbalanced", "energies", "ledger"):
            self.assertEqual(whole[key], parts[key], key)
        for file in ("column.csv", "column.pvd"):
            self.assertEqual((self.folder / "whole" / file).read_text(), (self.folder / "parts" / file).read_text())

    def test_bonds_that_break_are_written_down(self):
        scene = self.scene(CHAIN + "run: {steps: 500}\noutputs: {series: 100}\n")
        text, report = self.succeed("check", scene)
        self.assertEqual(report["bonds"], 2)
        self.assertIn("bonds       2 ball-ball, parallel by contacts[0] glass-glass", text)
        text, whole = self.succeed("run", scene, "--output", self.folder / "whole")
        self.assertEqual(whole["bonds"], {"intact": 1, "broken": 1})
        self.assertIn("bonds: 1 intact, 1 broken", text)
        with open(self.folder / "whole" / "column-breaks.csv", newline="") as table:
            (row,) = csv.DictReader(table)
        self.assertEqual({int(row["ball a"]), int(row["ball b"])}, {0, 1})
        self.assertEqual(row["mode"], "tension")
        self.assertAlmostEqual(float(row["z [m]"]), 25e-3, delta=1e-5)
        self.succeed("run", scene, "--output", self.folder / "parts", "--set", "run.steps=3")
        _, parts = self.succeed("run", self.folder / "parts" / "column.h5", "--set", "run.steps=500")
        self.assertEqual(parts["energies"], whole["energies"])
        for file in ("column-breaks.csv", "column_breaks.pvd", "column_breaks_series/column_breaks_0000000500.vtu"):
            self.assertEqual((self.folder / "parts" / file).read_bytes(), (self.folder / "whole" / file).read_bytes())
        self.assertIn(b'NumberOfPoints="1"', (self.folder / "whole" / file).read_bytes())
        start = self.folder / "whole" / "column_breaks_series" / "column_breaks_0000000000.vtu"
        self.assertIn(b'NumberOfPoints="0"', start.read_bytes())

    def test_a_run_needs_an_end(self):
        self.assertIn("run.steps=10000", self.fail_with("run", self.scene(COLUMN), "--output", self.folder))

    def test_stops_by_time_and_by_balance(self):
        scene = self.scene(COLUMN)
        _, report = self.succeed("run", scene, "--output", self.folder, "--set", "run.time=0.001")
        self.assertLess(report["time"] - 1e-3, report["dt"])
        self.assertGreaterEqual(report["time"], 1e-3)
        _, report = self.succeed("run", scene, "--output", self.folder, "--set", "run={until: {unbalanced: 1e-6}}")
        self.assertLess(report["unbalanced"]["mean"], 1e-6)

    def test_a_step_above_the_limit_is_warned_of_and_the_blow_up_explained(self):
        # One ball on the floor, 2 sqrt(m/kn) undamped: twice that blows up.
        step = 2.0 * 2 * math.sqrt(MASS / 2e4)
        scene = self.scene(COLUMN + RUN)
        text = self.fail_with("run", scene, "--output", self.folder / "out", "--set", "run.steps=100000",
                         "--set", f"timestep={{policy: fixed, dt: {step}}}", "--set", "damping.local=0")
        self.assertIn("WARNING", text)
        self.assertIn("blew up", text)
        self.assertRegex(text, r"balls [0-2]")
        self.assertRegex(text, r"\d\.\d+ times" )
        self.assertIn("last good state: step", text)
        # What was kept opens.
        self.assertEqual(self.run_program("check", self.folder / "out" / "column.h5").returncode, 0)

    def test_an_interrupt_saves_the_state(self):
        scene = self.scene(COLUMN + "run: {steps: 100000000}\n")
        running = subprocess.Popen([PROGRAM, "run", scene, "--output", self.folder / "out"], stderr=subprocess.PIPE,
                                   stdout=subprocess.DEVNULL, text=True)
        state = self.folder / "out" / "column.h5"
        while not state.exists():
            time.sleep(0.01)
        time.sleep(0.2)
        running.send_signal(signal.SIGINT)
        _, text = running.communicate(timeout=60)
        self.assertEqual(running.returncode, 128 + signal.SIGINT, text)
        self.assertIn("continue with: eigengrain run", text)
        _, report = self.succeed("check", state)
        self.assertEqual(report["bodies"], 3)

    def test_damaged_states_are_refused(self):
        self.succeed("run", self.scene(COLUMN + RUN), "--output", self.folder)
        state = self.folder / "column.h5"
        content = bytearray(state.read_bytes())
        content[len(content) // 2] ^= 1
        state.write_bytes(content)
        self.assertIn("column.h5", self.fail_with("run", state))
        os.truncate(state, len(content) // 2)
        self.assertIn("column.h5", self.fail_with("run", state))

    def test_folders_that_cannot_be_made_are_named(self):
        (self.folder / "file").write_text("")
        self.assertIn("--output", self.fail_with("run", self.scene(COLUMN + RUN), "--output", self.folder / "file" / "x"))

    def test_a_blow_up_of_a_contact_that_was_not_there_at_the_start_is_explained(self):
        scene = self.scene(COLUMN.replace("[0, 0, 5 mm]", "[0, 0, 6 mm]").replace("15 mm", "25 mm")
                           .replace("25 mm], radius", "45 mm], radius", 1) + "run: {steps: 100000}\n")
        text = self.fail_with("run", scene, "--output", self.folder, "--set", "damping.local=0",
                         "--set", f"timestep={{policy: fixed, dt: {3 * 2 * math.sqrt(MASS / 2e4)}}}")
        self.assertIn("blew up", text)
        self.assertNotIn("WARNING", text)
        self.assertRegex(text, r"is \d\.\d+ times")

    @unittest.skipUnless(HAS_PETSC, "built without PETSc")
    def test_friction_may_come_on_in_a_state_that_could_not_turn(self):
        scene = self.scene(COLUMN.replace("ks: 1e4, friction: 0.5", "friction: 0") + RUN)
        self.succeed("run", scene, "--output", self.folder)
        override = ["--set", "contacts.0.ks=1e4", "--set", "contacts.0.friction=0.5"]
        _, report = self.succeed("relax", self.folder / "column.h5", *override)
        self.assertTrue(report["converged"])
        _, report = self.succeed("run", self.folder / "column.h5", *override, "--set", "run.steps=500")
        self.assertEqual(report["steps"], 100)

    @unittest.skipUnless(HAS_PETSC, "built without PETSc")
    def test_relax_knows_what_rounding_allows(self):
        text = self.fail_with("relax", self.scene(COLUMN), "--output", self.folder, "--tolerance", "1e-15")
        self.assertIn("rounding of positions", text)

    @unittest.skipUnless(HAS_PETSC, "built without PETSc")
    def test_a_relaxed_state_has_tables_of_its_own(self):
        self.succeed("run", self.scene(COLUMN + RUN), "--output", self.folder)
        table = (self.folder / "column.csv").read_bytes()
        self.succeed("relax", self.scene(COLUMN + RUN), "--output", self.folder)
        self.succeed("run", self.folder / "column-relaxed.h5")
        self.assertEqual((self.folder / "column.csv").read_bytes(), table)
        self.assertTrue((self.folder / "column-relaxed-column.csv").exists())

    @unittest.skipUnless(HAS_PETSC, "built without PETSc")
    def test_relax_finds_the_equilibrium_and_the_cycle_keeps_it(self):
        _, report = self.succeed("relax", self.scene(COLUMN), "--output", self.folder, "--tolerance", "1e-10")
        self.assertTrue(report["converged"])
        self.assertLessEqual(report["unbalanced"]["mean"], 1e-10)
        relaxed = self.folder / "column-relaxed.h5"
        _, run = self.succeed("run", relaxed, "--set", "run.steps=1000")
        self.assertEqual(run["steps"], 1000)
        self.assertLessEqual(run["unbalanced"]["mean"], 1e-10)
        _, timestep = self.succeed("timestep", relaxed)
        self.assertEqual(timestep["contacts"], 3)

    @unittest.skipUnless(HAS_PETSC, "built without PETSc")
    def test_relax_says_when_there_is_no_equilibrium(self):
        # A ball that nothing will ever stop: it falls beside the column.
        scene = self.scene(COLUMN.replace("walls:", "  - {position: [1, 0, 1], radius: 5 mm, material: glass}\nwalls:"))
        done = self.run_program("relax", scene, "--output", self.folder, "--max-steps", 2000)
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("no equilibrium", done.stderr)
        self.assertIn("1 unsupported", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
