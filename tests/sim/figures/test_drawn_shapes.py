"""Shapes of a model as a viewer draws them, against MuJoCo's own."""

import mujoco
import numpy as np
import pytest
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate

from plantar.recordings.foxglove import Template
from plantar.sim.figures.drawn_shapes import body_entity, coarse_mesh, drawn_bodies, frame_name

MODEL = """
<mujoco>
  <asset>
    <material name="blue" rgba="0 0 1 0.5"/>
    <texture name="checker" type="2d" builtin="checker" rgb1="1 1 1" rgb2="0 0 0" width="64" height="64"/>
    <material name="checker" texture="checker" rgba="1 1 0.5 1"/>
    <mesh name="wedge" vertex="0 0 0  1 0 0  0 1 0  0 0 1"/>
  </asset>
  <worldbody>
    <geom type="plane" size="0 0 1" euler="0 90 0" pos="2 0 0" material="checker"/>
    <body name="arm">
      <geom type="box" size="0.1 0.2 0.3" pos="1 2 3" euler="90 0 0" material="blue"/>
      <geom type="sphere" size="0.1" rgba="1 0 0 1"/>
      <geom type="ellipsoid" size="0.1 0.2 0.3"/>
      <geom type="cylinder" size="0.1 0.4"/>
      <geom type="capsule" size="0.1 0.4" pos="0 0 1" euler="90 0 0"/>
      <geom type="mesh" mesh="wedge" pos="0 0 5"/>
      <geom type="box" size="1 1 1" group="3"/>
      <geom type="box" size="1 1 1" rgba="1 1 1 0"/>
    </body>
    <body><geom type="sphere" size="0.1"/></body>
    <body name="bare"><geom type="box" size="1 1 1" group="4"/></body>
  </worldbody>
</mujoco>
"""


def test_every_visible_shape_is_drawn_as_large_and_there_where_it_is():
    model = mujoco.MjModel.from_xml_string(MODEL)
    assert [frame_name(model, body) for body in drawn_bodies(model)] == ["arm", "body_2"]
    world, arm = (SceneUpdate.FromString(Template(body_entity(model, body)).filled(0.0)).entities[0] for body in (0, 1))
    (floor,) = world.cubes
    assert (world.frame_id, floor.size.x, floor.size.y) == ("world", 20.0, 20.0)
    assert floor.pose.position.x == pytest.approx(2.0 - 1e-3)  # its upper face lies in the plane, whose normal is x
    # Black and white squares are grey from afar, and half as blue as the material says.
    assert [floor.color.r, floor.color.g, floor.color.b] == pytest.approx([0.5, 0.5, 0.25], abs=0.01)
    (box,), (cylinder, shaft), (mesh,) = arm.cubes, arm.cylinders, arm.triangles
    assert [box.size.x, box.size.y, box.size.z] == [0.2, 0.4, 0.6]
    assert [box.color.b, box.color.a] == [1.0, 0.5]
    assert [box.pose.position.y, box.pose.orientation.x] == pytest.approx([2.0, 0.5**0.5])
    assert [cylinder.size.x, cylinder.size.z, shaft.size.z] == pytest.approx([0.2, 0.8, 0.8])
    ball, ellipsoid, *ends = arm.spheres
    assert [ball.color.r, ball.size.x, ellipsoid.size.z] == [1.0, 0.2, 0.6]
    # The capsule's axis, z, is turned to -y.
    assert sorted(round(end.pose.position.y, 9) for end in ends) == [-0.4, 0.4]
    assert all(end.pose.position.z == pytest.approx(1.0) for end in ends)
    corners = np.array([[p.x, p.y, p.z] for p in mesh.points])
    assert sorted(map(tuple, corners.round(4).tolist())) == [(0, 0, 5), (0, 0, 6), (0, 1, 5), (1, 0, 5)]
    assert len(mesh.indices) == 12


@pytest.mark.parametrize(("most", "radius"), [(4, 1.0), (100, 0.02), (700, 3.0), (3000, 1.0)])
def test_a_coarse_mesh_has_few_faces_and_lies_near_the_fine_one(most, radius):
    turns = np.linspace(0.0, 2.0 * np.pi, 41)[:-1]
    heights = np.linspace(-1.0, 1.0, 21)
    ring = np.sqrt(1.0 - heights**2)
    vertices = radius * np.stack(
        [np.outer(ring, np.cos(turns)), np.outer(ring, np.sin(turns)), np.outer(heights, np.ones(40))], axis=-1
    ).reshape(-1, 3)
    index = np.arange(21 * 40).reshape(21, 40)
    a, b = index[:-1], index[1:]
    quads = np.stack([a, np.roll(a, -1, 1), np.roll(b, -1, 1), b], axis=-1).reshape(-1, 4)
    faces = np.concatenate([quads[:, :3], quads[:, [0, 2, 3]]])
    coarse, kept = coarse_mesh(vertices, faces, most)
    assert len(kept) <= most
    if most >= len(faces):
        assert np.array_equal(kept, faces)
    if most >= 100:
        assert len(kept) > 0.3 * min(most, len(faces))
        distances = np.linalg.norm(coarse[np.unique(kept)], axis=1) / radius
        assert (distances <= 1 + 1e-9).all()
        assert (distances > 0.8).all()
