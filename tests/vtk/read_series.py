"""Frames for ParaView as VTK reads them: equal to what was written, to the last bit. Usage: read_series.py WRITER"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

try:
    import numpy
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkObject
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
except ImportError as missing:
    print(f"skipped, as VTK cannot be imported ({missing}); apt install python3-vtk9 python3-numpy")
    sys.exit(77)

WRITER = sys.argv.pop(1)
STEPS = {"sliding": [0, 1, 2], "turning & more": [0, 10, 20, 30, 12345678901]}


def same_bits(array, wanted):
    """Whether two arrays of numbers are the same to the bit, signs of zeros included."""
    wanted = numpy.array(wanted, dtype=array.dtype)
    return array.shape == wanted.shape and array.tobytes() == wanted.tobytes()


class Series(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls._folder = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls._folder.name)
        subprocess.run([WRITER, cls.folder], check=True)
        expected = json.loads((cls.folder / "expected.json").read_text())
        cls.stiffness = expected["stiffness"]
        cls.expected = expected["series"]

    @classmethod
    def tearDownClass(cls):
        cls._folder.cleanup()

    def listed(self, stem):
        """(time, file) of every frame that the .pvd names."""
        root = xml.etree.ElementTree.parse(self.folder / f"{stem}.pvd").getroot()
        self.assertEqual((root.tag, root.get("type")), ("VTKFile", "Collection"))
        (collection,) = root
        return [(float(each.get("timestep")), self.folder / each.get("file")) for each in collection]

    def frame(self, file):
        errors = []
        reader = vtkXMLUnstructuredGridReader()
        reader.AddObserver("ErrorEvent", lambda *_: errors.append(str(file)))
        reader.SetFileName(str(file))
        reader.Update()
        self.assertEqual(errors, [])
        return reader.GetOutput()

    def frames(self):
        """(grid, what it must say) of every frame."""
        for stem, steps in STEPS.items():
            for step, (_, file) in zip(steps, self.listed(stem)):
                yield self.frame(file), self.expected[stem][str(step)]

    def test_lists_have_every_frame_once(self):
        for stem, steps in STEPS.items():
            times, files = zip(*self.listed(stem))
            self.assertEqual([file.name for file in files], [f"{stem}_{step:010}.vtu" for step in steps])
            self.assertEqual(list(times), [self.expected[stem][str(step)]["time"] for step in steps])
            self.assertEqual(times[0], 0)
            folder = sorted(file.name for file in (self.folder / f"{stem}_series").iterdir())
            self.assertEqual(folder, sorted(file.name for file in files), "nothing else lies around")

    def test_points_and_arrays_are_equal_to_the_bit(self):
        names = {"radius", "identity", "velocity", "force"}
        for grid, wanted in self.frames():
            self.assertTrue(same_bits(vtk_to_numpy(grid.GetPoints().GetData()), wanted["position"]))
            data = grid.GetPointData()
            found = {data.GetArrayName(k) for k in range(data.GetNumberOfArrays())}
            self.assertEqual(found, names | {"contacts"} | ({"spin", "stress"} if "spin" in wanted else set()))
            for name in found - {"contacts", "stress"}:
                self.assertTrue(same_bits(vtk_to_numpy(data.GetArray(name)), wanted[name]), name)
            self.assertEqual(data.GetScalars().GetName(), "radius")

    def test_time_and_step(self):
        for grid, wanted in self.frames():
            field = grid.GetFieldData()
            self.assertTrue(same_bits(vtk_to_numpy(field.GetArray("TimeValue")), [wanted["time"]]))
            self.assertTrue(same_bits(vtk_to_numpy(field.GetArray("Step")), [wanted["step"]]))

    def test_every_ball_is_a_vertex_cell(self):
        for grid, wanted in self.frames():
            count = len(wanted["radius"])
            self.assertEqual((grid.GetNumberOfPoints(), grid.GetNumberOfCells()), (count, count))
            for ball in range(count):
                self.assertEqual(grid.GetCellType(ball), 1)
                self.assertEqual(grid.GetCell(ball).GetPointId(0), ball)

    def test_contacts_and_forces_are_those_of_the_overlaps(self):
        """Counted anew from positions and radii: the clusters are frictionless, so F = k_n U along the centres."""
        for grid, _ in self.frames():
            x = vtk_to_numpy(grid.GetPoints().GetData())
            data = grid.GetPointData()
            radius = vtk_to_numpy(data.GetArray("radius"))
            count = numpy.zeros(len(x), dtype=int)
            force = numpy.zeros_like(x)
            stress = numpy.zeros((len(x), 3, 3))  # f ⊗ R, R from the centre to the contact point
            for i in range(len(x)):
                for j in range(len(x)):
                    distance = numpy.linalg.norm(x[i] - x[j])
                    if i != j and distance < radius[i] + radius[j]:
                        count[i] += 1
                        overlap = radius[i] + radius[j] - distance
                        push = self.stiffness * overlap * (x[i] - x[j]) / distance
                        force[i] += push
                        stress[i] += numpy.outer(push, (radius[i] - overlap / 2) * (x[j] - x[i]) / distance)
                overlap = radius[i] - (x[i][2] + 1.5)  # with the wall at z = -1.5
                if overlap > 0:
                    count[i] += 1
                    force[i][2] += self.stiffness * overlap
                    stress[i][2][2] -= self.stiffness * overlap * (radius[i] - overlap / 2)
            self.assertEqual(list(vtk_to_numpy(data.GetArray("contacts"))), list(count))
            self.assertGreater(count.sum(), 0)
            # Sums in another order: off by a few roundings of the largest force.
            scale = numpy.abs(force).max()
            numpy.testing.assert_allclose(vtk_to_numpy(data.GetArray("force")), force, rtol=0, atol=1e-12 * scale)
            if data.GetArray("stress") is not None:
                stress /= (4 / 3 * math.pi * radius ** 3)[:, None, None]
                found = vtk_to_numpy(data.GetArray("stress")).reshape(-1, 3, 3)
                numpy.testing.assert_allclose(found, stress, rtol=0, atol=1e-12 * numpy.abs(stress).max())

    def test_bonds_that_broke_are_points(self):
        (_, before), (_, after) = self.listed("cracks")
        self.assertEqual(self.frame(before).GetNumberOfPoints(), 0)
        grid = self.frame(after)
        self.assertEqual((grid.GetNumberOfPoints(), grid.GetNumberOfCells()), (2, 2))
        self.assertTrue(same_bits(vtk_to_numpy(grid.GetPoints().GetData()), [[1, 2, 3], [-0.1, 0, 1e-30]]))
        wanted = {"time": [0.25, 1 / 3], "step": [3, 5], "mode": [0, 1], "ball_a": [7, 12345678901], "ball_b": [1, 2],
                  "normal": [[0, 0, 1], [0.6, -0.8, 0]]}
        data = grid.GetPointData()
        self.assertEqual({data.GetArrayName(k) for k in range(data.GetNumberOfArrays())}, set(wanted))
        for name, values in wanted.items():
            self.assertTrue(same_bits(vtk_to_numpy(data.GetArray(name)), values), name)


if __name__ == "__main__":
    vtkObject.GlobalWarningDisplayOff()  # errors are seen by the observer
    unittest.main()
