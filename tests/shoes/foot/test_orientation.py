"""Tests of how a foot stands: rotations, flat planes, tilt and toes."""

from collections.abc import Callable

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from plantar.errors import FootError
from plantar.shoes.foot.foot_mesh import Link, foot_from_triangles
from plantar.shoes.foot.orientation import (
    AXES,
    check_level,
    check_one_body,
    check_upright,
    flat_share,
    forward_axis,
    levelled,
    rotation_forward,
    rotation_up,
    straightened,
)

from ..foot_family import turned as in_pose

Shape = Callable[..., NDArray[np.float64]]


@pytest.mark.parametrize("axis", AXES)
def test_rotations_bring_their_axis_where_it_should_be(axis):
    direction = np.zeros(3)
    direction["xyz".index(axis[-1])] = -1.0 if axis[0] == "-" else 1.0
    up = rotation_up(axis)
    np.testing.assert_array_equal(up @ direction, [0, 0, 1])
    assert np.linalg.det(up) == pytest.approx(1.0)
    if axis[-1] != "z":
        forward = rotation_forward(axis)
        np.testing.assert_array_equal(forward @ direction, [1, 0, 0])
        np.testing.assert_array_equal(forward[2], [0, 0, 1])
        assert np.linalg.det(forward) == pytest.approx(1.0)


def test_flat_soles_are_told_from_round_ones(box):
    assert flat_share(box((0, 200), (0, 90), (0, 40))) == pytest.approx(1.0)
    assert flat_share(trimesh.creation.icosphere(radius=60.0).triangles) < 0.1
    assert flat_share(np.zeros((4, 3, 3))) == 0.0


@pytest.mark.parametrize("tilt", [-12.0, 3.0, 20.0])
def test_a_tilt_is_taken_out_and_small_and_large_ones_are_left(box, tilt):
    body = np.concatenate([box((-50, 150), (-40, 40), (0, 30)), box((-20, 20), (-20, 20), (30, 80))])

    def turned(degrees: float) -> NDArray[np.float64]:
        turn = trimesh.transformations.rotation_matrix(np.radians(degrees), [0.3, 1.0, 0.0])[:3, :3]
        return np.asarray(body @ turn.T)

    flat, taken = levelled(turned(tilt))
    assert taken == pytest.approx(abs(tilt), abs=1e-6)
    z = flat[..., 2]
    assert np.ptp(z) == pytest.approx(80.0, abs=1e-6)
    for small in (0.5, 40.0):
        same, none = levelled(turned(small))
        assert none == 0.0
        np.testing.assert_array_equal(same, turned(small))


def test_toes_are_along_x_or_where_the_foot_is_longer(box):
    assert forward_axis(box((0, 200), (0, 90), (0, 40)))[0] == "x"
    assert forward_axis(box((-45, 45), (-50, 150), (0, 40)))[0] == "y"
    assert forward_axis(box((-45, 45), (-150, 50), (0, 40)))[0] == "-y"
    assert forward_axis(box((-45, 45), (-100, 100), (0, 40)))[0] == "y"  # nothing tells: said so
    assert "or give the forward axis" in forward_axis(box((-45, 45), (-100, 100), (0, 40)))[1]


def test_a_foot_that_points_backwards_is_seen_by_its_ankle(box):
    backwards = box((-150, 50), (-40, 40), (0, 40))
    assert forward_axis(backwards)[0] == "-x"
    column = box((60, 90), (-20, 20), (40, 90))  # over the toes, by the origin
    centred = np.concatenate([box((-100, 100), (-40, 40), (0, 40)), column])
    assert forward_axis(centred)[0] == "-x"
    with pytest.raises(FootError, match="near opposite ends of the foot; give the forward axis"):
        forward_axis(np.concatenate([backwards, box((-130, -90), (-20, 20), (40, 90))]))


@pytest.mark.parametrize("pitch", [-0.8, 0.5, 0.8])
def test_the_upper_end_of_a_plate_that_is_tilted_a_little_is_no_ankle(box, pitch):
    plate = in_pose(box((-90.0, 150.0), (-45.0, 45.0), (0.0, 2.0)), 0.3, pitch, 0.0)
    assert forward_axis(plate)[0] == "x"


@pytest.mark.parametrize("yaw", [30.0, -40.0, 100.0, 3.0])
def test_a_turned_foot_is_straightened_by_its_symmetry(prism, yaw):
    outline = np.array([[-80, -32], [60, -46], [130, -25], [140, 0], [130, 25], [60, 46], [-80, 32]], dtype=float)
    foot = prism(outline, 0, 40)
    turn = trimesh.transformations.rotation_matrix(np.radians(yaw), [0, 0, 1])[:3, :3]
    straight, notes = straightened(foot @ turn.T)
    size = np.sort(np.ptp(straight.reshape(-1, 3), axis=0)[:2])
    if abs(yaw) < 5.0:
        assert notes == []
        np.testing.assert_array_equal(straight, foot @ turn.T)
    else:
        assert size == pytest.approx([92.0, 220.0], abs=3.0)
        assert "degrees past an axis" in notes[0]


def test_what_stands_askew_above_the_sole_turns_nothing(prism, box):
    sole = prism(np.array([[-80, -45], [140, -45], [140, 45], [-80, 45]], dtype=float), 0.0, 15.0)
    c = np.cos(np.radians(20.0))
    s = np.sin(np.radians(20.0))
    motor = box((-95, 150), (-48, 48), (15, 60)) @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]).T
    foot = np.concatenate([sole, motor])
    same, notes = straightened(foot)
    assert notes == []
    np.testing.assert_array_equal(same, foot)


def test_a_links_frame_is_not_turned_where_a_mesh_would_be(prism):
    outline = np.array([[-80, -32], [60, -46], [130, -25], [140, 0], [130, 25], [60, 46], [-80, 32]], dtype=float)
    turned = in_pose(prism(outline, 0.0, 40.0), 0.0, 0.0, 12.0)
    mesh = foot_from_triangles("a", turned, where="a")
    assert any("12.0 degrees past an axis of the mesh, by the symmetry of its sole" in note for note in mesh.notes)
    link = foot_from_triangles("a", turned, where="a", link=Link("a.xml", "foot", np.eye(3)))
    np.testing.assert_allclose(link.triangles.reshape(-1, 3).min(axis=0), turned.reshape(-1, 3).min(axis=0), atol=1e-9)
    assert not any("past an axis" in note for note in link.notes)


def test_two_feet_are_told_from_a_foot_and_a_loose_part(box):
    foot = box((-50, 150), (-40, 40), (0, 40))
    check_one_body(np.concatenate([foot, box((-20, 20), (-20, 20), (45, 60))]), "a.stl")
    check_one_body(np.concatenate([foot, box((160, 170), (-20, 20), (0, 20))]), "a.stl")
    with pytest.raises(FootError, match="holds 2 bodies apart from each other, two feet maybe"):
        check_one_body(np.concatenate([foot, foot + np.array([0.0, 120.0, 0.0])]), "a.stl")


def test_a_foot_that_lies_on_its_side_is_refused_and_a_slender_one_is_not(box):
    foot = np.concatenate([box((-80, 150), (-45, 45), (0, 40)), box((-20, 20), (-20, 20), (40, 70))])
    assert check_upright(foot, "foot") == []
    for up in ("x", "-x", "y", "-y"):
        with pytest.raises(FootError, match=rf"seems to lie on its side: .* \({up} up\)"):
            check_upright(foot @ rotation_up(up), "foot")
    slanted = trimesh.transformations.rotation_matrix(np.radians(40.0), [1, 0, 0])[:3, :3]
    with pytest.raises(FootError, match="a slanted one"):
        check_upright(foot @ slanted.T, "foot")
    slender = np.concatenate([box((-80, 170), (-12.5, 12.5), (0, 20)), box((-10, 10), (-10, 10), (15, 60))])
    assert check_upright(slender, "foot") == []
    deck = np.concatenate([box((-60, 90), (-35, 35), (0, 20)), box((-80, 150), (-60, 60), (20, 40))])
    assert check_upright(deck, "foot") == []


def rocker(radius: float, prism: Shape) -> NDArray[np.float64]:
    """A foot with a sole of a radius along it and a flat upper side."""
    x = np.linspace(-115.0, 115.0, 40)
    side = np.column_stack([x, radius - np.sqrt(radius**2 - x**2)])
    solid = prism(np.vstack([side, [[115.0, 45.0], [-115.0, 45.0]]]), -45.0, 45.0)
    return np.asarray(solid[..., [0, 2, 1]][:, ::-1] + np.array([30.0, 0.0, 0.0]))


@pytest.mark.parametrize("radius", [400.0, 800.0])
def test_a_rounded_sole_that_is_tilted_with_its_foot_is_refused(prism, radius):
    foot = rocker(radius, prism)
    assert "level as the mesh's axes" in check_level(foot, "foot")[0]
    for tilt in (4.0, 8.0, -8.0, 15.0):
        c = np.cos(np.radians(tilt))
        s = np.sin(np.radians(tilt))
        tilted = foot @ np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]]).T
        with pytest.raises(FootError, match=rf"tilted by {abs(tilt):.1f} degrees, .*--up z"):
            check_level(tilted, "foot")


def test_what_could_stand_on_either_side_is_told(box):
    plate = box((-80, 150), (-45, 45), (0, 30))
    assert "upper side as well" in check_level(plate, "foot")[0]
    assert check_level(np.concatenate([plate, box((-20, 20), (-20, 20), (30, 80))]), "foot") == []


@pytest.mark.parametrize("turn", [(1.0, -1.0, -1.0), (-1.0, 1.0, -1.0)])
def test_a_wedge_turned_by_180_degrees_is_refused_and_stands_by_the_axis_that_is_given(prism, turn):
    side = np.array([[-75.0, 0.0], [135.0, 0.0], [135.0, 15.0], [-75.0, 45.0]])
    wedge = prism(side, -45.0, 45.0)[..., [0, 2, 1]][:, ::-1]
    assert any("upper side as well" in note for note in foot_from_triangles("a", wedge, where="a").notes)
    with pytest.raises(FootError, match=r"stand on its upper side: .* tilted by 8\.1 degrees.*--up -z"):
        foot_from_triangles("a", wedge * turn, where="a")
    turned = foot_from_triangles("a", wedge * turn, where="a", up="-z")
    assert turned.height == pytest.approx(45.0)
    assert turned.sole.area == pytest.approx(210.0 * 90.0)


@pytest.mark.parametrize("yaw", [8.0, 20.0, -25.0, 40.0, 5.0])
def test_a_foot_about_as_wide_as_long_is_straightened_where_its_sides_tell(box, yaw):
    foot = box((-60, 100), (-78, 78), (0, 25))
    c = np.cos(np.radians(yaw))
    s = np.sin(np.radians(yaw))
    turned = foot @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]).T
    if yaw == 40.0:
        with pytest.raises(FootError, match=r"askew by 40 degrees.* forward axis"):
            straightened(turned)
        return
    back, notes = straightened(turned)
    assert f"{yaw:.1f} degrees past" in notes[0]
    assert np.allclose(back, turned if yaw == 5.0 else foot, atol=1e-6)
