"""The verbs modes, rigidity, moduli and export as a user meets them."""
import csv
import math
import sys
import unittest

from program import ProgramTest

EXAMPLES = sys.argv[2]

# FCC, four balls of radius 1 m a cell of 2√2 m less a little, two cells wide; k_n = 1, k_s = 0.5, m = 1.
EDGE = 4 * math.sqrt(2) * (1 - 1e-12)
FCC = f"""
materials: [{{name: grain, density: {3 / (4 * math.pi)!r}}}]
contacts: [{{between: [grain, grain], law: linear, kn: 1, ks: 0.5, friction: 0.5}}]
periodic: {{box: [{EDGE!r}, {EDGE!r}, {EDGE!r}]}}
balls: [{{lattice: fcc, radius: 1, spacing: {EDGE / 4 * math.sqrt(2)!r}, box: {{min: [0, 0, 0], max: [{EDGE!r}, {EDGE!r}, {EDGE!r}]}}, material: grain}}]
"""


class Spectrum(ProgramTest):
    def test_modes(self):
        text, report = self.succeed("modes", self.scene(FCC), "--lowest", 3, "--highest", 2, "--density", "--bins", 4,
                                    "--moments", 64, "--shapes", self.folder / "modes.vtu")
        self.assertEqual(report["unknowns"], 6 * 32)
        self.assertEqual([len(report["lowest"]), len(report["highest"])], [3, 2])
        self.assertAlmostEqual(report["highest"][0]["lambda"], 20, delta=1e-6)  # max(8(1 + s), 40 s)
        self.assertAlmostEqual(sum(report["density"]["count"]), 6 * 32, delta=1e-6)
        self.assertIn("participation", text)
        self.assertGreater((self.folder / "modes.vtu").stat().st_size, 1000)
        _, report = self.succeed("modes", self.scene(FCC), "--all")
        self.assertEqual(len(report["all"]), 6 * 32)
        self.assertAlmostEqual(report["all"][-1], 20, delta=1e-9)

    def test_rigidity(self):
        _, report = self.succeed("rigidity", self.scene(FCC))
        self.assertEqual(report["springs"], 3 * 6 * 32)
        self.assertEqual(report["trivial"], 3)
        self.assertTrue(report["counts_agree"])
        self.assertEqual(report["unknowns"] - report["springs"], report["floppy"] - report["self_stress"])
        _, report = self.succeed("rigidity", self.scene(FCC), "--springs", "normal", "--without-rattlers")
        self.assertEqual(report["springs"], 6 * 32)

    def test_moduli(self):
        text, report = self.succeed("moduli", self.scene(FCC))
        self.assertAlmostEqual(report["stiffness"][0][0], math.sqrt(2) * 1.5 / 2, delta=1e-10)
        self.assertAlmostEqual(report["stiffness"][0][1], math.sqrt(2) * 0.5 / 4, delta=1e-10)
        self.assertAlmostEqual(report["stiffness"][3][3], math.sqrt(2) * 1.5 / 4, delta=1e-10)
        self.assertIn("bulk modulus", text)
        self.assertIn("repeats along all axes", self.fail_with("moduli", f"{EXAMPLES}/scenes/three_balls.yaml"))

    def test_export(self):
        text, report = self.succeed("export", self.scene(FCC), "--output", self.folder / "out", "--format", "csv,mtx,petsc,h5")
        self.assertEqual(len(report["files"]), 3 + 4 + 4 + 1)
        for file in report["files"]:
            self.assertIn(file, text)
        with open(self.folder / "out" / "contacts.csv", newline="") as table:
            self.assertEqual(len(list(csv.DictReader(table))), 6 * 32)
        head = (self.folder / "out" / "K.mtx").read_text().splitlines()[0]
        self.assertEqual(head, "%%MatrixMarket matrix coordinate real symmetric")
        self.assertIn('did you mean "mtx"', self.fail_with("export", self.scene(FCC), "--format", "mtz"))

    def test_words_that_mean_nothing(self):
        done = self.run_program("rigidity", self.scene(FCC), "--springs", "some")
        self.assertEqual(done.returncode, 2)
        self.assertIn("moments 4", self.fail_with("modes", self.scene(FCC), "--density", "--moments", 4))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
