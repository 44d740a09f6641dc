#!/usr/bin/env bash
# Writes the samples anew: needs gmsh, python3-meshio and python3-vtk9.
set -euo pipefail
cd "$(dirname "$0")"
for body in bricks tetrahedra; do
  gmsh "$body.geo" -3 -format msh41 -o "${body}_41.msh"
  gmsh "$body.geo" -3 -format msh22 -o "${body}_22.msh"
  gmsh "$body.geo" -3 -format inp -o "$body.inp"
done
python3 - <<'PYTHON'
import meshio
import vtk

whole = meshio.read("tetrahedra_41.msh")
meshio.write("tetrahedra.vtu", meshio.Mesh(whole.points, {"tetra10": whole.cells_dict["tetra10"]}), binary=False)

points = vtk.vtkPoints()
for z in (0, 5):
    for y in (0, 10):
        for x in (0, 10, 20):
            points.InsertNextPoint(x, y, z)
grid = vtk.vtkUnstructuredGrid()
grid.SetPoints(points)
for first in (0, 1):
    bottom = [first, first + 1, first + 4, first + 3]
    grid.InsertNextCell(vtk.VTK_HEXAHEDRON, 8, bottom + [point + 6 for point in bottom])
writer = vtk.vtkXMLUnstructuredGridWriter()
writer.SetInputData(grid)
writer.SetFileName("bricks.vtu")
writer.SetDataModeToAscii()
writer.Write()
PYTHON
