"""Three balls, exported in each format that is read.   yade -n -x yade.py"""
from yade import *
from yade import export

O.materials.append(FrictMat(density=2500))
for centre, radius in (((0.01, 0.02, 0.03), 0.005), ((-0.05, 1 / 3, 0.03), 0.00625), ((1e-7, 0, 2.5), 0.25)):
    O.bodies.append(sphere(centre, radius))
export.text('yade_text.txt')
export.textExt('yade_matid.txt', format='x_y_z_r_matId', comment='three balls')
export.textExt('yade_attrs.txt', format='x_y_z_r_attrs', comment='mass vx vy vz', attrs=['b.state.mass', 'b.state.vel'])
export.textExt('yade_id.txt', format='id_x_y_z_r_matId')
