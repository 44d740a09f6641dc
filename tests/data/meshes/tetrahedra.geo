// 20 mm × 10 mm × 5 mm, a few quadratic tetrahedra.
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 20, 10, 5};
Mesh.MeshSizeMin = 20;
Mesh.MeshSizeMax = 20;
Mesh.ElementOrder = 2;
