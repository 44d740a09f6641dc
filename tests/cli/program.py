"""The program under test, and a folder of its own for each test."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = sys.argv[1]


class ProgramTest(unittest.TestCase):
    scene_name = "scene.yaml"

    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self._folder.name)

    def tearDown(self):
        self._folder.cleanup()

    def scene(self, text):
        file = self.folder / self.scene_name
        file.write_text(text)
        return file

    def run_program(self, *arguments):
        return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)

    def succeed(self, *arguments):
        """What the program prints, and its JSON; it must succeed."""
        result = self.folder / "result.json"
        done = self.run_program(*arguments, "--json", result)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout, json.loads(result.read_text())

    def fail_with(self, *arguments):
        """What the program says where it has to fail, for the scene's or a solver's sake."""
        done = self.run_program(*arguments)
        self.assertEqual(done.returncode, 1, done.stdout)
        return done.stderr
