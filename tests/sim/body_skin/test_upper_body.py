"""Skin around a walking robot's upper body: a closed box in the base frame, as large on any robot as its shape."""

import mujoco
import numpy as np
import pytest

from plantar.common.gravity import GRAVITY
from plantar.errors import RobotError
from plantar.sensing.link_skin import BodySkin
from plantar.sim.body_skin.upper_body import FACES, upper_body_skin


def skin_of(scale: float = 1.0, mass: float = 80.0, shape: str = "") -> BodySkin:
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><worldbody><body name="trunk" pos="0.3 0.2 1" euler="0 0 40"><freejoint/>
        <geom type="box" size="{0.1 * scale} {0.15 * scale} {0.2 * scale}" pos="0 0 {0.1 * scale}" mass="{mass}"/>
        <body pos="0 {0.2 * scale} 0"><geom type="capsule" size="{0.05 * scale} {0.1 * scale}"/></body>
        <body pos="0 0 {-0.3 * scale}"><joint name="hip" axis="1 0 0"/><geom size="{0.5 * scale}"/></body>
        {shape}</body></worldbody></mujoco>"""
    )
    return upper_body_skin(model, 1, leg=0.6 * scale, weight=mass * GRAVITY)


def test_taxels_lie_on_the_faces_of_the_box_about_all_that_is_welded_and_look_outwards():
    skin = skin_of()
    assert skin.links == ("trunk",)
    assert set(skin.slices) == set(FACES)
    low, high = np.array([-0.1, -0.15, -0.15]), np.array([0.1, 0.25, 0.3])  # with the welded arm, without the leg
    for name, (forward, left) in FACES.items():
        at = skin.positions[skin.slices[name]]
        outward = np.array([forward, left, 0.0])
        np.testing.assert_allclose(skin.normals[skin.slices[name]], np.tile(-outward, (len(at), 1)))
        face = np.where(outward > 0.0, high, low)[np.abs(outward) > 0.0]
        np.testing.assert_allclose(at[:, np.abs(outward) > 0.0], np.tile(face, (len(at), 1)))
        assert (at >= low - 1e-12).all()
        assert (at <= high + 1e-12).all()


def test_taxels_cover_the_faces():
    skin = skin_of()
    for name, area in {"front": 0.4 * 0.45, "left": 0.2 * 0.45}.items():
        assert skin.areas[skin.slices[name]].sum() == pytest.approx(area, rel=0.1)


def test_a_robot_of_another_size_has_the_same_taxels():
    whole, half = skin_of(), skin_of(0.5, 10.0)
    np.testing.assert_allclose(half.positions, 0.5 * whole.positions, atol=1e-12)
    np.testing.assert_allclose(half.areas, 0.25 * whole.areas)
    np.testing.assert_allclose(half.thresholds, whole.thresholds / 8.0)


def test_a_push_on_all_of_one_face_turns_nothing_about_the_middle_of_it():
    skin = skin_of()
    front = skin.slices["front"]
    wrench = skin.unit_wrenches[front].sum(axis=0)
    assert wrench[0] == pytest.approx(-float(len(skin.positions[front])))
    middle = skin.positions[front].mean(axis=0)
    np.testing.assert_allclose(wrench[3:], np.cross(middle, wrench[:3]), atol=1e-9)


def test_a_body_without_extent_is_refused():
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><worldbody><body name="stick"><freejoint/><geom type="capsule" size=".001 .3" mass="1"/></body>
        </worldbody></mujoco>"""
    )
    with pytest.raises(RobotError, match="'stick' measures"):
        upper_body_skin(model, 1, leg=0.6, weight=10.0)


def test_links_without_shapes_count_with_the_boxes_of_their_inertias():
    edges = np.array([0.2, 0.3, 0.4])
    inertia = 8.0 / 12.0 * (edges @ edges - edges**2)
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><worldbody><body name="trunk" euler="0 0 40"><freejoint/>
        <inertial pos="0 0 .1" mass="8" diaginertia="{inertia[0]} {inertia[1]} {inertia[2]}"/>
        <body><joint name="hip"/><geom size=".5"/></body></body></worldbody></mujoco>"""
    )
    skin = upper_body_skin(model, 1, leg=0.6, weight=80.0)
    faces = [skin.positions[skin.slices[name]] for name in ("front", "left")]
    assert faces[0][:, 0] == pytest.approx(0.1)
    assert faces[1][:, 1] == pytest.approx(0.15)
    assert -0.1 <= skin.positions[:, 2].min() < skin.positions[:, 2].max() <= 0.3
