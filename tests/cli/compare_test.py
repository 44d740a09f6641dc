#!/usr/bin/env python3
"""`compare timesteps` and `compare steps`: table, JSON and page. Arguments: the program, the examples."""
import json
import pathlib
import re
import sys
import unittest
import xml.etree.ElementTree

from program import ProgramTest

EXAMPLES = pathlib.Path(sys.argv[2]).resolve()

# Two frictionless balls along (1,1,1): PFC3D's estimate is sqrt(3/2) times the true step.
OBLIQUE = """
materials: [{name: grain, density: 2500}]
contacts: [{between: [grain, grain], law: linear, kn: 1e5}]
balls:
  - {position: [0, 0, 0], radius: 5 mm, material: grain}
  - {position: [5.7 mm, 5.7 mm, 5.7 mm], radius: 5 mm, material: grain}
damping: {local: 0}
"""
# The same along x, with a name that is markup.
STRAIGHT = OBLIQUE.replace("[5.7 mm, 5.7 mm, 5.7 mm]", "[9.9 mm, 0, 0]")
APART = OBLIQUE.replace("[5.7 mm, 5.7 mm, 5.7 mm]", "[20 mm, 0, 0]")


class Page:
    """A page, as an XML parser and a reader see it."""

    def __init__(self, file):
        self.source = file.read_text(encoding="utf-8")
        self.tree = xml.etree.ElementTree.fromstring(self.source)
        self.text = " ".join(self.tree.itertext())

    def tags(self):
        return {element.tag.rsplit("}", 1)[-1] for element in self.tree.iter()}

    def attributes(self):
        return [(name.rsplit("}", 1)[-1], value) for element in self.tree.iter()
                for name, value in element.attrib.items()]

    def texts_of_pictures(self):
        svg = "{http://www.w3.org/2000/svg}"
        return [["".join(text.itertext()) for text in picture.iter(svg + "text")]
                for picture in self.tree.iter(svg + "svg")]


class CompareTimesteps(ProgramTest):
    def write(self, name, text):
        file = self.folder / name
        file.parent.mkdir(exist_ok=True)
        file.write_text(text)
        return file

    def folder_of_scenes(self):
        self.write("scenes/a&b.yaml", STRAIGHT)
        self.write("scenes/oblique.yaml", OBLIQUE)
        self.write("scenes/apart.yaml", APART)
        self.write("scenes/notes.txt", "no scene")
        return self.folder / "scenes"

    def compare(self, *arguments):
        page = self.folder / "report.html"
        printed, result = self.succeed("compare", "timesteps", *arguments, "--output", page)
        return printed, result, Page(page)

    def test_a_folder_is_all_its_scenes_in_order(self):
        printed, result, _ = self.compare(self.folder_of_scenes())
        self.assertEqual([scene["name"] for scene in result["scenes"]], ["a&b", "apart", "oblique"])
        self.assertIn("nothing touches", result["scenes"][1]["skipped"])
        self.assertIn("apart: left out", printed)

    def test_ratios_are_those_of_the_closed_forms(self):
        _, result, page = self.compare(self.folder_of_scenes())
        straight, _, oblique = result["scenes"]

        def ratio(scene, name):
            return next(e for e in scene["estimates"] if e["name"] == name)["ratio_to_true"]

        self.assertAlmostEqual(ratio(straight, "diagonal"), 2**-0.5, places=9)
        self.assertAlmostEqual(ratio(oblique, "diagonal"), 1.5**0.5, places=9)
        self.assertAlmostEqual(ratio(oblique, "block-bound"), 1, places=9)
        standing = next(e for e in result["estimates"] if e["name"] == "diagonal")
        self.assertEqual((standing["scenes"], standing["unsafe"]), (2, 1))
        self.assertEqual(standing["largest_in"], "oblique")
        self.assertIn("▲1.225", page.text)
        # 0.98 of the truth against 0.8 of 0.7071 of it, and of 1.2247
        bound = next(e for e in result["relative_steps"] if e["name"] == "block-bound")
        self.assertEqual([s["name"] for s in bound["scenes"]], ["a&b", "oblique"])
        self.assertAlmostEqual(bound["scenes"][0]["relative_steps"], 0.8 * 2**-0.5 / 0.98, places=9)
        self.assertAlmostEqual(bound["scenes"][1]["relative_steps"], 0.8 * 1.5**0.5 / 0.98, places=9)
        self.assertTrue(all(s["safe"] for s in bound["scenes"]))

    def test_the_page_holds_every_estimate_of_the_json(self):
        _, result, page = self.compare(self.folder_of_scenes())
        pictures = page.texts_of_pictures()
        for scene in result["scenes"]:
            if "skipped" in scene:
                continue
            names = {e["name"] for e in scene["estimates"]}
            self.assertTrue(names)
            self.assertTrue(any(names <= set(texts) for texts in pictures), scene["name"])
            for estimate in scene["estimates"]:
                self.assertIn(estimate["source"], page.text)
        for policy in ("policy: estimate", "policy: bound"):
            self.assertTrue(any(policy in texts for texts in pictures))

    def test_the_page_needs_nothing_beside_itself(self):
        _, _, page = self.compare(self.folder_of_scenes(), "--sizes", "30,100")
        self.assertFalse(page.tags() & {"script", "link", "img", "iframe", "object", "embed", "image", "use"})
        self.assertFalse([a for a in page.attributes() if a[0] in ("src", "href") or a[0].startswith("on")])
        self.assertNotRegex(page.source, r"url\(|@import")
        namespaces = {"http://www.w3.org/2000/svg", "http://www.w3.org/1999/xhtml"}
        self.assertEqual(set(re.findall(r"https?://[^\"<> ]+", page.source)), namespaces)

    def test_names_are_text_and_not_markup(self):
        _, _, page = self.compare(self.folder_of_scenes())
        self.assertIn("a&b", page.text)
        self.assertIn("a&amp;b", page.source)

    def test_one_scene_is_told_estimate_by_estimate(self):
        printed, result, page = self.compare(self.scene(OBLIQUE))
        for estimate in result["scenes"][0]["estimates"]:
            self.assertIn(estimate["name"], printed)
            self.assertIn(estimate["source"], page.text)
        self.assertRegex(printed, r"diagonal .*UNSAFE")

    def test_cost_by_size(self):
        printed, result, page = self.compare(self.scene(OBLIQUE), "--sizes", "400,50")
        small, large = result["sizes"]
        self.assertLess(small["bodies"], large["bodies"])
        self.assertAlmostEqual(large["bodies"] / 400, 1, delta=0.3)  # whole cells of 4
        self.assertGreater(large["contacts"], 2 * large["bodies"])
        names = {e["name"] for e in large["estimates"]} | {"truth", "one product with K"}
        self.assertEqual({g["name"] for g in result["growth"]}, names)
        self.assertTrue(any(names <= set(texts) for texts in page.texts_of_pictures()))
        self.assertIn("exponent", printed)

    def test_overrides_hold_for_all_scenes(self):
        _, result, _ = self.compare(self.folder_of_scenes(), "--set", "contacts.0.kn=4e5")
        _, softer, _ = self.compare(self.folder_of_scenes())
        self.assertAlmostEqual(result["scenes"][0]["true"]["dt"] / softer["scenes"][0]["true"]["dt"], 0.5, places=9)

    def test_equal_names_are_told_apart_by_their_folders(self):
        first = self.write("one/scene.yaml", OBLIQUE)
        second = self.write("two/scene.yaml", STRAIGHT)
        _, result, _ = self.compare(first, second)
        self.assertEqual([s["name"] for s in result["scenes"]], ["one/scene", "two/scene"])

    def test_mistakes_of_all_scenes_are_told_before_anything_is_computed(self):
        self.write("scenes/a.yaml", OBLIQUE.replace("kn: 1e5", "kn: -1"))
        self.write("scenes/b.yaml", OBLIQUE.replace("radius: 5 mm", "radius: 5 kg"))
        page = self.folder / "report.html"
        said = self.fail_with("compare", "timesteps", self.folder / "scenes", "--output", page)
        self.assertIn("a.yaml:3", said)
        self.assertIn("b.yaml:5", said)
        self.assertFalse(page.exists())

    def test_what_is_not_there(self):
        (self.folder / "empty").mkdir()
        said = self.fail_with("compare", "timesteps", self.folder / "gone.yaml", self.folder / "empty")
        self.assertRegex(said, r"gone.yaml: there is no such file or folder")
        self.assertRegex(said, r"empty: no scene \(\*\.yaml\)")

    def test_nothing_to_compare_is_a_failure(self):
        self.assertIn("no scene has a critical step", self.fail_with("compare", "timesteps", self.scene(APART)))

    def test_a_page_that_cannot_be_written(self):
        said = self.fail_with("compare", "timesteps", self.scene(OBLIQUE), "--output", self.folder / "no" / "r.html")
        self.assertIn("name a file in a folder that exists", said)

    def test_sizes_that_are_no_packing(self):
        self.assertIn("--sizes 3", self.fail_with("compare", "timesteps", self.scene(OBLIQUE), "--sizes", "100,3"))

    def test_a_subject_that_does_not_exist(self):
        done = self.run_program("compare", "timestep", self.scene(OBLIQUE))
        self.assertEqual(done.returncode, 2)
        self.assertIn('did you mean "timesteps"?', done.stderr)


class CompareSteps(ProgramTest):
    def compare(self, *arguments):
        page = self.folder / "report.html"
        printed, result = self.succeed("compare", "steps", *arguments, "--output", page)
        return printed, result, Page(page)

    def test_a_bouncing_ball(self):
        printed, result, page = self.compare(EXAMPLES / "scenes" / "bouncing_ball.yaml", "--fractions", "0.05,0.1,0.4")
        self.assertEqual(len(result["runs"]), 3)
        # Falls for 64 ms, then touches every 128 ms and half a period of the contact, 1.1 ms: in 0.6 s five times.
        self.assertEqual(result["impacts"], 5)
        self.assertAlmostEqual(result["reference"]["mean_restitution"], 1, delta=1e-4)
        errors = [run["energy"] for run in result["runs"]]
        self.assertEqual(errors, sorted(errors))
        for run in result["runs"]:
            self.assertAlmostEqual(run["dt"] * run["steps"], 0.6, places=9)
            self.assertAlmostEqual(run["dt"] / result["limit"], run["fraction"], places=12)
        for word in ("trajectory", "final state", "energy balance", "restitution", "order 2"):
            self.assertTrue(any(word in texts for texts in page.texts_of_pictures()), word)
        self.assertIn("restitution", printed)

    def test_time_and_scene_have_to_say_how_long(self):
        scene = self.scene(OBLIQUE)
        self.assertIn("--time 0.1", self.fail_with("compare", "steps", scene))
        _, result, _ = self.compare(scene, "--time", "0.01", "--fractions", "0.1,0.2")
        self.assertEqual(result["time"], 0.01)

    def test_bad_input(self):
        scene = self.scene(OBLIQUE)
        self.assertIn("up to 2", self.fail_with("compare", "steps", scene, "--time", "1", "--fractions", "0.1,3"))
        self.assertIn("less than one critical step", self.fail_with("compare", "steps", scene, "--time", "1e-9"))
        staged = self.scene(OBLIQUE + "stages: [{run: {steps: 10}}]\n")
        self.assertIn("stages", self.fail_with("compare", "steps", staged, "--time", "1"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
