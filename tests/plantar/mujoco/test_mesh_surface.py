"""A mesh's corners and faces are those of its file."""

import mujoco
import numpy as np

from plantar.mujoco.mesh_surface import mesh_surface

TETRAHEDRON = "0 0 0  1 0 0  0 1 0  0 0 1"
TWO = f'''<mujoco><asset>
  <mesh name="first" vertex="0 0 0  2 0 0  0 2 0  0 0 2  2 2 2"/><mesh name="second" vertex="{TETRAHEDRON}"/>
</asset><worldbody><geom type="mesh" mesh="first"/><geom type="mesh" mesh="second"/></worldbody></mujoco>'''


def test_each_mesh_has_its_own_corners_and_a_closed_surface():
    model = mujoco.MjModel.from_xml_string(TWO)
    for geom, (count, volume) in enumerate(((5, 4.0), (4, 1.0 / 6.0))):
        corners, faces = mesh_surface(model, int(model.geom_dataid[geom]))
        a, b, c = np.moveaxis(corners[faces], 1, 0)
        assert corners.shape == (count, 3)
        assert abs(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0 - volume) < 1e-5
