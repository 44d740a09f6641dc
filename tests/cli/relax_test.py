#!/usr/bin/python3
"""`relax` and `compare relaxation` as a user meets them. Arguments: the program, the examples."""
import csv
import signal
import subprocess
import sys
import unittest

from program import PROGRAM, ProgramTest

EXAMPLES = sys.argv[2]

# A layer of balls on the floor of a box, a little apart, that fall by half a millimetre.
BED = """
gravity: [0, 0, -9.81]
materials: [{name: grain, density: 2500}]
contacts: [{between: [grain, grain], law: linear, kn: 1e5, ks: 5e4, friction: 0.5}]
balls:
  - {lattice: sc, radius: 5 mm, spacing: 10.4 mm, material: grain, box: {min: [0, 0, 0.1 mm], max: [42 mm, 42 mm, 32 mm]}}
walls: [{box: {min: [0, 0, 0], max: [42 mm, 42 mm, 1], open: [+z]}, material: grain}]
damping: {local: 0.7}
"""
CELL = """
materials: [{name: grain, density: 2500}]
contacts: [{between: [grain, grain], law: linear, kn: 1e5, ks: 5e4, friction: 0.5}]
periodic: {box: [40 mm, 40 mm, 40 mm]}
balls: [{fill: dense, mean_overlap: 5e-3, radius: 4 mm, seed: 1, material: grain}]
damping: {local: 0.7}
"""


class RelaxTest(ProgramTest):
    scene_name = "bed.yaml"

    def relax(self, text, *arguments):
        return self.succeed("relax", self.scene(text), "--output", self.folder, *arguments)

    def press(self, servo):
        lid = f", {{plane: {{point: [0, 0, 32 mm], normal: [0, 0, -1]}}, material: grain, {servo}}}]"
        return BED.replace("open: [+z]}, material: grain}]", "open: [+z]}, material: grain}" + lid)

    def test_takes_methods_by_name(self):
        for method in ["hybrid", "explicit", "tracked", "scaled", "fire"]:
            _, report = self.relax(BED, "--method", method, "--tolerance", "1e-8")
            self.assertTrue(report["converged"], method)
            if method != "hybrid":
                self.assertEqual(report["method"], method)
                self.assertEqual([stage["name"] for stage in report["stages"]], [method])
        said = self.fail_with("relax", self.scene(BED), "--method", "trakced")
        self.assertIn('did you mean "tracked"', said)

    def test_reports_statuses_reactions_and_stages(self):
        printed, report = self.relax(BED)
        statuses = report["statuses"]
        self.assertGreater(statuses["sticking"], 0)
        self.assertEqual(statuses["sticking"] + statuses["slipping"], report["contacts"])
        self.assertIn("contacts: ", printed)
        # The floor bears the weight.
        weight = sum(reaction["force"][2] for reaction in report["reactions"])
        self.assertLess(weight, 0)
        self.assertEqual(sum(stage["steps"] for stage in report["stages"]), report["steps"] + report["part_steps"])
        self.assertEqual(sum(stage["iterations"] for stage in report["stages"]), report["iterations"])

    def test_says_how_far_another_method_ends(self):
        printed, report = self.relax(BED, "--against", "tracked", "--tolerance", "1e-9")
        self.assertEqual(report["against"]["method"], "tracked")
        self.assertGreaterEqual(report["against"]["forces"], 0)
        self.assertIn("from the end of tracked", printed)

    def test_names_what_no_equilibrium_can_hold(self):
        free = BED[:BED.index("walls:")]
        self.assertIn("neither a wall nor a body that is fixed", self.fail_with("relax", self.scene(free), "--output", self.folder))
        beside = BED[:BED.index("walls:")] + """
  - {position: [0, 0, 1000], radius: 5 mm, material: grain}
walls: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: grain}]
damping: {local: 0.7}
"""
        said = self.fail_with("relax", self.scene(beside), "--output", self.folder, "--max-steps", "2000")
        self.assertIn("1 group of bodies that neither a wall nor a held body touches moves", said)
        self.assertIn("bed-relaxed.h5", said)
        soft = BED.replace("kn: 1e5", "kn: 0")
        self.assertIn("kn", self.fail_with("relax", self.scene(soft)))
        fixed = BED.replace("material: grain, box", "material: grain, fix: [all], box")
        _, report = self.relax(fixed)
        self.assertTrue(report["converged"])  # nothing is free: nothing is left to balance

    def test_an_interrupt_leaves_the_last_good_state(self):
        scene = self.scene(BED.replace("spacing: 10.4 mm", "spacing: 10.2 mm"))
        done = subprocess.Popen([PROGRAM, "relax", str(scene), "--output", str(self.folder), "--method", "explicit",
                                 "--tolerance", "1e-300", "--max-steps", "100000000"], stderr=subprocess.PIPE,
                                stdout=subprocess.DEVNULL, text=True)
        done.stderr.readline()  # it runs
        done.send_signal(signal.SIGINT)
        _, _ = done.communicate(timeout=60)
        self.assertEqual(done.returncode, 128 + signal.SIGINT)
        self.succeed("check", self.folder / "bed-relaxed.h5")

    def test_servo_walls_push_as_they_are_asked_to(self):
        _, report = self.relax(self.press("servo: {force: 20, max_speed: 0.1}"))
        self.assertTrue(report["converged"])
        self.assertLessEqual(report["missing_force"], 1e-10)
        self.assertAlmostEqual(report["reactions"][-1]["force"][2], 20, delta=20e-10)

    def test_an_impossible_servo_target_is_named(self):
        away = self.press("servo: {force: 20, max_speed: 0.1, direction: [0, 0, 1]}")
        said = self.fail_with("relax", self.scene(away), "--output", self.folder, "--max-steps", "3000")
        self.assertIn("a servo wall misses", said)

    def table(self):
        with open(self.folder / "bed-load.csv", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_follows_a_path_of_a_key(self):
        self.relax(BED, "--load", "gravity=[0, 0, -9.81]..[1, 0, -9.75]", "--increments", "4", "--tolerance", "1e-8")
        lines = self.table()
        self.assertEqual([line["part"] for line in lines], ["0.25", "0.5", "0.75", "1"])
        self.assertTrue(all(float(line["ratio"]) <= 1e-8 for line in lines))
        last = self.folder / "bed-load-0004.h5"
        _, report = self.succeed("relax", last, "--tolerance", "1e-8", "--output", self.folder)
        self.assertEqual(report["steps"], 0)

    def test_a_path_goes_on_where_it_was_left(self):
        load = ["--load", "gravity=[0, 0, -9.81]..[1, 0, -9.75]", "--increments", "3", "--tolerance", "1e-8"]
        self.relax(BED, *load)
        whole = self.table()
        for k in [2, 3]:
            (self.folder / f"bed-load-{k:04}.h5").unlink()
        printed, _ = self.relax(BED, *load, "--continue")
        self.assertIn("continues behind", printed)
        self.assertEqual(self.table(), whole)
        said = self.fail_with("relax", self.scene(BED), "--output", self.folder, *load[:2], "--increments", "5",
                              "--continue")
        self.assertIn("as many increments as before", said)
        # Anew: nothing of the longer path stays.
        self.relax(BED, *load[:2], "--increments", "2", "--tolerance", "1e-8")
        self.assertFalse((self.folder / "bed-load-0003.h5").exists())
        self.assertEqual(len(self.table()), 2)

    def test_strains_the_cell(self):
        self.relax(CELL, "--load", "strain=[[-0.002, 0, 0], [0, -0.002, 0], [0, 0, -0.002]]", "--increments", "2",
                   "--tolerance", "1e-8")
        lines = self.table()
        self.assertAlmostEqual(float(lines[-1]["volume [m3]"]), 0.04**3 * (1 - 0.002)**3, delta=1e-12)
        self.assertLess(float(lines[1]["stress_xx [Pa]"]), float(lines[0]["stress_xx [Pa]"]))
        self.assertLess(float(lines[0]["stress_xx [Pa]"]), 0)  # compression is negative

    def test_moves_a_wall(self):
        self.relax(self.press("velocity: [0, 0, 0]"), "--load", "displacement.5=[0, 0, -2.2e-3]", "--increments", "2",
                   "--tolerance", "1e-8")
        lines = self.table()
        self.assertGreater(float(lines[-1]["wall_5_fz [N]"]), float(lines[0]["wall_5_fz [N]"]))
        said = self.fail_with("relax", self.scene(BED), "--load", "displacement.0=[0, 0, 1e-4]", "--output", self.folder)
        self.assertIn("velocity: [0, 0, 0]", said)

    def test_names_what_is_wrong_with_a_path(self):
        for load, said in [("gravity=[0, 0, -9.81]", "no FROM..TO"), ("gravity=[0, 0]..[1, 0, -9.75]", "as many"),
                           ("strain=[[1, 2], [3, 4]]", "three rows"), ("displacement.x=[0, 0, 1]", "not a number"),
                           ("displacement.9=[0, 0, 1]", "no such wall"), ("gravity=down..up", "numbers"),
                           ("strain=[[0, 0, 0], [0, 0, 0], [0, 0, 0]]", "no periodic cell")]:
            self.assertIn(said, self.fail_with("relax", self.scene(BED), "--load", load, "--output", self.folder), load)

    def test_compares_ways(self):
        page = self.folder / "ways.html"
        printed, report = self.succeed("compare", "relaxation", self.scene(BED), "--tolerance", "1e-8", "--output", page)
        (scene,) = report["scenes"]
        runs = {run["method"]: run for run in scene["runs"]}
        self.assertEqual(set(runs), {"hybrid", "explicit", "tracked", "scaled", "fire", "newton"})
        for name in ["hybrid", "explicit", "tracked", "scaled", "fire"]:
            self.assertTrue(runs[name]["converged"], name)
            self.assertLessEqual(runs[name]["mean"], 1e-8)
            self.assertEqual([moment["sweeps"] for moment in runs[name]["course"]],
                             sorted(moment["sweeps"] for moment in runs[name]["course"]))
        html = page.read_text()
        self.assertEqual(html.count("<svg"), 3)
        self.assertIn("unbalanced ratio", html)
        self.assertNotIn("http", html.replace("http://www.w3.org", ""))
        self.assertIn("hybrid", printed)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
