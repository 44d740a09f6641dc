"""The command line as a user meets it: exit codes, messages, JSON. Usage: cli_test.py PROGRAM EXAMPLES"""
import math
import pathlib
import subprocess
import sys
import unittest

from program import PROGRAM, ProgramTest

EXAMPLES = pathlib.Path(sys.argv[2])
HAS_TIMESTEP = "timestep" in subprocess.run([PROGRAM, "--help"], capture_output=True, text=True).stdout

# Two equal frictionless spheres along (1, 1, 1), R = 5 mm, that just overlap.
PAIR = """
materials: [{name: glass, density: 2500}]
contacts: [{between: [glass, glass], law: linear, kn: 1e5}]
balls:
  - {position: [0, 0, 0], radius: 5 mm, material: glass}
  - {position: [5.7735 mm, 5.7735 mm, 5.7735 mm], radius: 5 mm, material: glass}
"""
WRONG = """
gravty: [0, 0, -9.81]
materials: [{name: glass, density: 2500 kg}]
contacts: [{between: [glas, glass], law: linear, kn: 1e5}]
balls:
  - {position: [0, 0, 0], radius: -5 mm, material: glass}
"""


class CommandLine(ProgramTest):
    def test_check_says_what_the_model_consists_of(self):
        text, report = self.succeed("check", EXAMPLES / "scenes" / "packing_10k.yaml")
        self.assertIn("25,781 ball-ball, linear", text)
        self.assertIn("left out, as nothing here needs it: periodic images", text)
        self.assertEqual(report["contacts"], 27440)
        self.assertEqual(report["unknowns"], 60000)
        self.assertEqual(report["passes"], ["search", "ball-ball linear forces", "ball-wall linear forces", "gravity",
                                            "local damping", "translation", "rotation"])

    def test_check_leaves_out_what_nothing_needs(self):
        _, report = self.succeed("check", self.scene(PAIR))
        self.assertEqual(report["rotations"], 0)
        self.assertEqual(report["groups"][0]["history_bytes"], 0)
        self.assertTrue(any("rotations" in part for part in report["left_out"]))

    def test_check_notes_walls_that_coincide(self):
        wall = "  - {plane: {point: [0, 0, -1], normal: [0, 0, 1]}, material: glass}\n"
        text, report = self.succeed("check", self.scene(PAIR + "walls:\n" + wall + wall))
        self.assertIn("note: wall 1 (plane) and wall 2 (plane) lie in one plane", text)
        self.assertEqual(len(report["notes"]), 1)

    def test_every_mistake_is_reported_at_once(self):
        done = self.run_program("check", self.scene(WRONG))
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stdout, "")
        for line, what in ((2, 'did you mean "gravity"'), (3, "is a mass"), (4, 'did you mean "glass"'),
                           (6, "out of range")):
            self.assertRegex(done.stderr, rf"scene\.yaml:{line}: .*{what}")

    def test_overrides_act_and_are_named_when_wrong(self):
        _, report = self.succeed("check", self.scene(PAIR), "--set", "contacts.0.ks=1e4",
                                 "--set", "contacts.0.friction=0.5")
        self.assertEqual(report["rotations"], 2)
        done = self.run_program("check", self.scene(PAIR), "--set", "contacts.0.kn=soft")
        self.assertEqual(done.returncode, 1)
        self.assertIn("--set contacts.0.kn=soft", done.stderr)

    def test_wrong_command_lines(self):
        done = self.run_program("tmestep", "x.yaml")
        self.assertEqual(done.returncode, 2)
        self.assertIn('no verb "tmestep"', done.stderr)
        self.assertEqual(self.run_program().returncode, 2)
        self.assertEqual(self.run_program("check").returncode, 2)
        missing = self.run_program("check", self.folder / "nothing.yaml")
        self.assertEqual(missing.returncode, 1)
        self.assertIn("nothing.yaml", missing.stderr)

    def test_json_that_cannot_be_written_is_an_error(self):
        done = self.run_program("check", self.scene(PAIR), "--json", self.folder / "no" / "folder.json")
        self.assertEqual(done.returncode, 1)
        self.assertIn("cannot write", done.stderr)

    def test_generate_writes_balls_that_the_reader_takes_back_to_the_bit(self):
        made = self.scene(PAIR.split("balls:")[0] + """
periodic: {box: [0.1, 0.1, 0.1]}
balls: [{fill: dense, fraction: 0.5, sizes: {distribution: uniform, min: 4 mm, max: 6 mm}, material: glass}]
""")
        packing, again = self.folder / "packing.txt", self.folder / "again.txt"
        text, report = self.succeed("generate", made, "--output", packing)
        self.assertIn("910 balls at a solid fraction of 0.49985", text)  # half a ball of 6 mm is 0.00045
        self.assertIn("none overlap", text)
        rows = [line for line in packing.read_text().splitlines() if not line.startswith("#")]
        self.assertEqual(report["balls"], len(rows))
        self.succeed("generate", made, "--output", again, "--threads", 1)
        self.assertEqual(packing.read_bytes(), again.read_bytes())
        self.succeed("generate", made, "--output", again, "--set", "balls.0.seed=2")
        self.assertNotEqual(packing.read_bytes(), again.read_bytes())
        self.succeed("generate", made, "--output", again, "--set", "balls=[{file: packing.txt, material: glass}]")
        self.assertEqual(rows, [line for line in again.read_text().splitlines() if not line.startswith("#")])

    def test_generate_writes_a_state_that_run_continues_from(self):
        lattice = PAIR.split("balls:")[0] + """
balls: [{lattice: sc, radius: 5 mm, box: {min: [0, 0, 0], max: [0.03, 0.03, 0.03]}, material: glass}]
"""
        state = self.folder / "lattice.h5"
        self.succeed("generate", self.scene(lattice), "--output", state)
        _, report = self.succeed("run", state, "--set", "run.steps=2", "--output", self.folder)
        self.assertEqual(report["step"], 2)
        done = self.run_program("generate", state, "--output", self.folder / "x.txt")
        self.assertEqual(done.returncode, 1)
        self.assertIn("a state has its balls already", done.stderr)

    def test_generate_says_what_a_packing_file_cannot_hold(self):
        scene = self.scene(PAIR)
        text, report = self.succeed("generate", scene, "--output", self.folder / "a.txt", "--set", "balls.0.fix=[x]")
        self.assertIn("fixed components are not in it", text)
        done = self.run_program("generate", scene)
        self.assertEqual(done.returncode, 2)
        done = self.run_program("generate", scene, "--output", self.folder / "no" / "a.txt")
        self.assertEqual(done.returncode, 1)
        self.assertIn("a.txt", done.stderr)

    def test_help_and_version_succeed(self):
        for arguments in (["--help"], ["--version"], ["check", "--help"], ["schema"]):
            self.assertEqual(self.run_program(*arguments).returncode, 0, arguments)

    @unittest.skipUnless(HAS_TIMESTEP, "built without PETSc")
    def test_timestep_tells_the_unsafe_estimate_of_the_oblique_pair(self):
        text, report = self.succeed("timestep", self.scene(PAIR))
        mass = 4 / 3 * math.pi * 5e-3 ** 3 * 2500
        self.assertAlmostEqual(report["true"]["dt"] / (2 * math.sqrt(mass / 2e5)), 1, delta=1e-10)
        self.assertAlmostEqual(report["true"]["limit"] / report["true"]["dt"], 1 / math.sqrt(1.7), delta=1e-12)
        self.assertLess(report["true"]["residual"], 1e-8)
        self.assertTrue(report["true"]["certified"])
        self.assertEqual(report["true"]["proof"]["by"], "bound")
        self.assertAlmostEqual(report["true"]["proof"]["dt"] / report["true"]["dt"], 1, delta=1e-6)
        by_name = {estimate["name"]: estimate for estimate in report["estimates"]}
        self.assertAlmostEqual(by_name["diagonal"]["ratio_to_true"], math.sqrt(1.5), delta=1e-9)
        self.assertFalse(by_name["diagonal"]["safe"])
        self.assertTrue(by_name["block-bound"]["safe"] and by_name["block-bound"]["claim"] == "proven")
        self.assertAlmostEqual(by_name["yade-global-stiffness"]["ratio_to_true"], 1.41044 * math.sqrt(1.5), delta=1e-9)
        self.assertEqual(by_name["lanczos-probable-20"]["claim"], "probable")
        self.assertEqual(by_name["lanczos-probable-20"]["failure"], 1e-6)
        least, largest = by_name["diagonal-turned"]["range"]
        self.assertLess(least, by_name["diagonal-turned"]["dt"])
        self.assertLessEqual(largest, by_name["diagonal"]["dt"] * (1 + 1e-9))  # no frame is worse than this one
        self.assertEqual([none["name"] for none in report["left_out"]], ["rayleigh", "p-wave"])
        self.assertIn("p-wave                 none: material glass has no young", text)
        self.assertFalse(report["policy"]["safe"])
        self.assertIn("UNSAFE", text)
        self.assertIn("WARNING", text)

    @unittest.skipUnless(HAS_TIMESTEP, "built without PETSc")
    def test_timestep_tells_what_the_elastic_stiffness_leaves_out(self):
        text, report = self.succeed("timestep", self.scene(PAIR), "--tangent", "--certify")
        tangent = report["tangent"]
        self.assertAlmostEqual(tangent["elastic"]["largest"]["real"] / report["true"]["lambda_max"], 1, delta=1e-9)
        self.assertEqual((tangent["contacts"], tangent["sliding"], tangent["complex_pairs"]), (1, 0, 0))
        self.assertIn("0 of 1 contacts slip", text)
        _, report = self.succeed("timestep", self.scene(PAIR))
        self.assertNotIn("tangent", report)

    @unittest.skipUnless(HAS_TIMESTEP, "built without PETSc")
    def test_policy_bound_obeys_the_damped_limit(self):
        _, report = self.succeed("timestep", self.scene(PAIR), "--set", "timestep.policy=bound")
        self.assertAlmostEqual(report["policy"]["ratio_to_limit"], 0.8, delta=1e-9)
        self.assertTrue(report["policy"]["safe"])

    @unittest.skipUnless(HAS_TIMESTEP, "built without PETSc")
    def test_timestep_says_that_masses_are_scaled(self):
        text, report = self.succeed("timestep", self.scene(PAIR), "--set", "mass_scaling={dt: 2 s}",
                                    "--set", "damping.local=0")
        self.assertIn("masses are scaled: all that follows is of the scaled system", text)
        self.assertEqual(report["mass_scaling"], "differential")
        self.assertEqual(report["policy"]["dt"], 2)
        # One spring and no friction: the block is the whole truth, and 2 s is 0.8 of it.
        self.assertAlmostEqual(report["policy"]["ratio_to_limit"], 0.8, delta=1e-10)

    @unittest.skipUnless(HAS_TIMESTEP, "built without PETSc")
    def test_timestep_tells_what_limits_the_step_and_what_would_lift_it(self):
        shapes = self.folder / "modes.vtu"
        limit = 2 * math.sqrt(4 / 3 * math.pi * 5e-3 ** 3 * 2500 / 2e5 / 1.7)
        text, report = self.succeed("timestep", self.scene(PAIR), "--modes", "3", "--modes-to", shapes, "--lift", 1.2 * limit)
        mode, = report["limits"]["modes"]  # one spring
        self.assertEqual(sorted(body["ball"] for body in mode["bodies"]), [0, 1])
        self.assertAlmostEqual(mode["participation"], 2, delta=1e-12)
        self.assertEqual(mode["contacts"][0]["kn"], 1e5)
        self.assertAlmostEqual(report["limits"]["heavier"]["dt"] / mode["dt"], math.sqrt(2), delta=1e-12)
        self.assertIn("with twice the mass of 2 carrying bodies", text)
        head = shapes.read_bytes()
        for name in (b"mode_1_displacement", b"mode_1_rotation", b"mode_1_energy"):
            self.assertIn(name, head)
        lift = report["lift"]
        self.assertEqual([body["ball"] for body in lift["bodies"]], [0, 1])
        # All alike here, so that every form has (1.2² - 1) of the mass to add.
        for body in lift["bodies"]:
            self.assertAlmostEqual(body["factor"], 1.44, delta=1e-9)
        for kind in ("added", "added_by_weights", "added_differential", "added_uniform"):
            self.assertAlmostEqual(lift[kind] / lift["mass"], 0.44, delta=1e-9)
        self.assertIn(lift["proof"], ("bound", "weights"))  # the same to rounding
        self.assertAlmostEqual(lift["slow_modes"][0]["frequency_change"], 1 / 1.2 - 1, delta=1e-9)
        self.assertIn("2 bodies have to become heavier, by 1.44 times at most: 44% of mass is added", text)
        _, report = self.succeed("timestep", self.scene(PAIR))
        self.assertFalse({"limits", "lift"} & set(report))

    @unittest.skipUnless(HAS_TIMESTEP, "built without PETSc")
    def test_timestep_refuses_steps_that_need_no_mass(self):
        for step, message in (("1e-9", "is within the true limit of this scene as it is"), ("-1", "-1 s is no step"),
                              ("inf", "inf s is no step")):
            done = self.run_program("timestep", self.scene(PAIR), f"--lift={step}")
            self.assertEqual(done.returncode, 1)
            self.assertIn(message, done.stderr)
        done = self.run_program("timestep", self.scene(PAIR), "--lift=1", "--set", "mass_scaling={dt: 2 s}")
        self.assertEqual(done.returncode, 1)
        self.assertIn("--lift: beside mass_scaling", done.stderr)
        self.assertEqual(self.run_program("timestep", self.scene(PAIR), "--modes", "0").returncode, 2)
        self.assertEqual(self.run_program("timestep", self.scene(PAIR), "--modes-to", "a.vtu").returncode, 2)

    def test_a_run_says_which_masses_it_has_scaled(self):
        limit = 2 * math.sqrt(4 / 3 * math.pi * 5e-3 ** 3 * 2500 / 2e5 / 1.7)
        text, report = self.succeed("run", self.scene(PAIR + "run: {steps: 3}\n"), "--output", self.folder, "--set",
                                    f"mass_scaling={{form: selective, dt: {1.2 * limit}}}", "--set", "timestep.safety=1")
        masses = report["mass_scaling"]
        self.assertEqual((masses["form"], masses["bodies"], masses["heavier"]), ("selective", 2, 2))
        self.assertAlmostEqual(masses["added_part"], 0.44, delta=1e-9)
        self.assertAlmostEqual(report["dt"] / limit, 1.2, delta=1e-12)
        self.assertIn("masses: 2 of 2 bodies are heavier, by 1.44 times at most; +44% of mass in all", text)
        self.assertIn("note: some bodies are made heavier where a step of", text)

    @unittest.skipUnless(HAS_TIMESTEP, "built without PETSc")
    def test_no_contact_means_no_limit(self):
        text, report = self.succeed("timestep", self.scene(PAIR), "--set", "balls.1.position=[1, 1, 1]")
        self.assertIn("no timestep is critical", text)
        self.assertIsNone(report["true"]["dt"])
        self.assertEqual(report["set_aside"], 2)

    @unittest.skipUnless(HAS_TIMESTEP, "built without PETSc")
    def test_petsc_options_reach_the_eigensolver(self):
        larger = EXAMPLES / "scenes" / "packing_10k.yaml"  # small systems are dense
        done = self.run_program("timestep", larger, "--petsc", "-eps_type no_such_solver")
        self.assertEqual(done.returncode, 1)
        self.assertIn("no_such_solver", done.stderr)
        done = self.run_program("timestep", self.scene(PAIR), "--petsc", "-eps_ncw 40")
        self.assertEqual(done.returncode, 1)
        self.assertIn("-eps_ncw", done.stderr)
        self.assertIn("48 unknowns", done.stderr)

    @unittest.skipUnless(HAS_TIMESTEP, "built without PETSc")
    def test_a_loose_eigenpair_does_not_pass_for_the_truth(self):
        done = self.run_program("timestep", EXAMPLES / "scenes" / "packing_10k.yaml", "--petsc", "-eps_tol 1e-1")
        self.assertEqual(done.returncode, 1)
        self.assertIn("residual", done.stderr)

    @unittest.skipUnless(HAS_TIMESTEP, "built without PETSc")
    def test_overflow_is_an_error_and_not_an_unlimited_step(self):
        done = self.run_program("timestep", self.scene(PAIR), "--set", "contacts.0.kn=1e300",
                                "--set", "materials.0.density=1e-300")
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertNotIn("no timestep is critical", done.stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
