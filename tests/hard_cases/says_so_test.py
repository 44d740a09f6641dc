#!/usr/bin/env python3
"""Where the default step of a hard case is above the limit, the program says so, and what it advises is stable."""
import pathlib
import sys
import unittest

from program import ProgramTest

SCENES = pathlib.Path(sys.argv[2]) / "scenes" / "hard_cases"
TOO_LONG = {"root_three_clumps": 1.3856, "overdamped_lattice": 1.0848}


class HardCases(ProgramTest):
    def run_scene(self, name, *arguments):
        return self.run_program("run", SCENES / f"{name}.yaml", "--set", "run={steps: 200}", "--output", self.folder,
                                *arguments)

    def test_timestep_says_by_how_much_the_default_is_too_long(self):
        for name, ratio in TOO_LONG.items():
            with self.subTest(name):
                text, report = self.succeed("timestep", SCENES / f"{name}.yaml")
                self.assertFalse(report["policy"]["safe"])
                self.assertAlmostEqual(report["policy"]["ratio_to_limit"], ratio, places=4)
                self.assertIn("WARNING", text)

    def test_run_warns_before_it_starts(self):
        for name in TOO_LONG:
            with self.subTest(name):
                done = self.run_scene(name)
                self.assertIn("WARNING", done.stdout + done.stderr)
                self.assertIn("policy: bound", done.stdout + done.stderr)

    def test_what_it_advises_runs(self):
        for name in TOO_LONG:
            with self.subTest(name):
                done = self.run_scene(name, "--set", "timestep.policy=bound")
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertNotIn("WARNING", done.stdout + done.stderr)

    def test_ten_contacts_at_once_end_the_run_and_not_with_a_bound(self):
        done = self.run_scene("ten_contacts_at_once")
        self.assertEqual(done.returncode, 1)
        self.assertIn("blew up", done.stderr)
        self.assertEqual(self.run_scene("ten_contacts_at_once", "--set", "timestep.policy=bound").returncode, 0)

    def test_the_limit_by_running(self):
        text, report = self.succeed("timestep", SCENES / "oblique_pair.yaml", "--empirical")
        found = report["empirical"]
        self.assertTrue(found["linear"])
        self.assertEqual(found["reservations"], [])
        self.assertLess(found["stable"], found["growing"])
        self.assertAlmostEqual(found["ratio_to_limit"], 1, places=3)
        self.assertIn("By running", text)
        self.assertNotIn("of this state only", text)

    def test_the_limit_by_running_where_k_is_not_all(self):
        text, report = self.succeed("timestep", SCENES / "taut_chain.yaml", "--empirical")
        found = report["empirical"]
        self.assertFalse(found["linear"])
        self.assertAlmostEqual(found["ratio_to_true"], (1 + 0.2 / 2.2) ** -0.5, places=3)
        self.assertIn("of this state only", text)
        self.assertIn("what that adds to the stiffness is not in K", text)

    def test_the_limit_by_running_of_nothing(self):
        text, report = self.succeed("timestep", SCENES / "ten_contacts_at_once.yaml", "--empirical")
        self.assertNotIn("empirical", report)
        self.assertIn("no timestep is critical", text)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
