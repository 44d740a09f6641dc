// 20 mm × 10 mm × 5 mm, two bricks.
Point(1) = {0, 0, 0};
line[] = Extrude {20, 0, 0} { Point{1}; Layers{2}; };
face[] = Extrude {0, 10, 0} { Line{line[1]}; Layers{1}; Recombine; };
body[] = Extrude {0, 0, 5} { Surface{face[1]}; Layers{1}; Recombine; };
