"""Poses, mirrors and permutations change results as they must, on flat, curved and mixed soles."""

from dataclasses import fields, replace

import numpy as np
import pytest

from plantar import FeetPercept, Percept, Reading, SolePose, hex_layout, laid_over, layout_of_cells, mirrored
from plantar.geometry.outline import concave_outline
from plantar.geometry.polygon import area
from plantar.mechanics.zmp import zmp_in_plane
from plantar.percepts.sole_pose import wrench_of_feet

OUTLINE = [[-0.08, -0.04], [0.15, -0.05], [0.16, 0.03], [-0.08, 0.04]]
FLAT = hex_layout(OUTLINE)
ROCKER = laid_over(FLAT, lambda x, y: 0.3 - np.sqrt(0.3**2 - x**2))
MIXED = layout_of_cells([
    [[0.0, 0.0], [0.03, 0.0], [0.03, 0.03], [0.0, 0.03]], [[0.03, 0.0], [0.05, 0.0], [0.05, 0.03], [0.03, 0.03]],
    [[-0.04, 0.0], [-0.02, 0.01], [-0.04, 0.02]],
])  # fmt: skip
SOLES = [FLAT, ROCKER, MIXED]
FLIP = np.array([1.0, -1.0, 1.0])
FLIP_WRENCH = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])


def random_pose(rng, tilt=np.pi):
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    cross = np.cross(np.eye(3), axis)
    angle = rng.uniform(-tilt, tilt)
    turn = np.eye(3) - np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross
    return SolePose(turn, rng.normal(size=3))


def random_force(rng, layout):
    force = rng.uniform(0.0, 40.0, len(layout)) * (rng.random(len(layout)) < rng.uniform(0.1, 1.0))
    force[rng.random(len(layout)) < 0.05] = rng.choice([np.nan, 900.0, -5.0, 1.0])
    return force


def permuted(layout, order):
    place = np.argsort(order)
    return replace(
        layout,
        **{
            f.name: getattr(layout, f.name)[order]
            for f in fields(layout)
            if f.name in ("positions", "rotations", "areas", "ids")
        },
        corners=tuple(layout.corners[i] for i in order),
        neighbours=tuple(tuple(int(place[j]) for j in layout.neighbours[i]) for i in order),
    )


def check(count, start=0):
    mirrors = [mirrored(layout) for layout in SOLES]
    for seed in range(start, start + count):
        rng = np.random.default_rng(seed)
        which = seed % 3
        layout, force = SOLES[which], random_force(rng, SOLES[which])
        percept = Percept(layout, Reading(0.0, force))
        wrench, cop = percept.wrench_in_sole, percept.position_cop_in_sole
        size = max(1.0, np.abs(wrench).max())

        # mirror and order
        other = Percept(mirrors[which], Reading(0.0, force))
        assert np.allclose(other.wrench_in_sole, wrench * FLIP_WRENCH, atol=1e-9 * size)
        assert other.contact_area == pytest.approx(percept.contact_area, abs=1e-12)
        order = rng.permutation(len(layout))
        mixed = Percept(permuted(layout, order), Reading(0.0, force[order]))
        assert np.allclose(mixed.wrench_in_sole, wrench, atol=1e-9 * size)
        for same, flip in ((mixed, np.ones(3)), (other, FLIP)):
            if cop is not None:
                assert np.allclose(same.surface_cop_in_sole, percept.surface_cop_in_sole * flip, atol=1e-9)
            assert area(same.support_polygon_in_sole) == pytest.approx(percept.support_area, abs=1e-9)

        # poses: of both feet together, and of the world as a whole
        poses = [random_pose(rng, 0.6), random_pose(rng, 0.6)]
        second = SOLES[(which + 1) % 3]
        soles = [percept, Percept(second, Reading(0.0, random_force(rng, second)))]
        feet = FeetPercept(soles, poses)
        yaw, shift = rng.uniform(-3.0, 3.0), np.array([*rng.normal(size=2), 0.0])
        c, s = np.cos(yaw), np.sin(yaw)
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        moved = FeetPercept(
            soles, [SolePose(turn @ p.rotation_sole_to_world, turn @ p.position_in_world + shift) for p in poses]
        )
        total = np.zeros(6)
        for p, pose in zip(soles, poses, strict=True):
            f = pose.rotation_sole_to_world @ p.wrench_in_sole[:3]
            total[:3] += f
            total[3:] += pose.rotation_sole_to_world @ p.wrench_in_sole[3:] + np.cross(pose.position_in_world, f)
        assert np.allclose(feet.wrench_in_world, total, atol=1e-9 * max(1.0, np.abs(total).max()))
        zmp = feet.position_zmp_in_world
        if all(
            p.vertical_force == 0.0 or (pose.rotation_sole_to_world @ p.wrench_in_sole[:3])[2] > 0
            for p, pose in zip(soles, poses, strict=True)
        ):
            again = zmp_in_plane(wrench_of_feet([p.wrench_in_sole for p in soles], poses))
            assert (again is None) == (zmp is None)
            assert zmp is None or np.allclose(again, zmp, atol=1e-9 * max(1.0, np.abs(zmp).max()))
        if zmp is not None:
            expected = turn[:2, :2] @ zmp + shift[:2]
            assert np.allclose(moved.position_zmp_in_world, expected, atol=1e-9 * max(1.0, np.abs(expected).max()))
        assert moved.support_area == pytest.approx(feet.support_area, rel=1e-9, abs=1e-9)
        for before, after in zip(feet.positions_cop_in_world, moved.positions_cop_in_world, strict=True):
            assert (before is None) == (after is None)
            assert before is None or np.allclose(turn @ before + shift, after, atol=1e-9)


def test_a_thousand_draws():
    check(600)


@pytest.mark.long
def test_ten_thousand_draws():
    check(10_000, start=1000)


@pytest.mark.parametrize("degrees", [-10.0, -6.0, 0.0, 12.0, 18.0])
def test_a_rocker_that_rolls_has_its_contact_on_its_surface(degrees):
    """A circle of 0.3 m that rolls on the floor touches it where its centre is above, whatever it is turned by."""
    angle = np.radians(degrees)
    turn = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
    fine = laid_over(hex_layout(OUTLINE, cell_area=2e-5), lambda x, y: 0.3 - np.sqrt(0.3**2 - x**2))
    centre = np.array([0.0, 0.0, 0.3])
    pose = SolePose(turn, np.array([0.0, 0.0, 0.3]) - turn @ centre)
    place = pose.to_world(fine.positions)
    touched = place[:, 2] < 0.001
    force = np.where(touched, 10.0, 0.0)
    feet = FeetPercept([Percept(fine, Reading(0.0, force))], [pose])
    cop = feet.positions_cop_in_world[0]
    assert abs(np.hypot(cop[0], cop[2] - 0.3) - 0.3) < 1e-4
    assert abs(cop[2]) < 1e-3
    assert abs(cop[0]) < 4e-3  # the centre is above x = 0
    ring = feet.support_polygon_in_world
    corners = pose.to_world(fine.vertices[sorted({v for i in np.flatnonzero(touched) for v in fine.corners[i]})])
    assert np.allclose(ring.max(axis=0), corners[:, :2].max(axis=0))
    assert np.allclose(ring.min(axis=0), corners[:, :2].min(axis=0))
    seen = feet.outlines_in_world[0]
    assert seen.area <= area(ring) + 1e-9
    assert np.allclose(np.vstack(seen.rings).max(axis=0), ring.max(axis=0), atol=1e-9)


@pytest.mark.parametrize("bend", [0.0, 1.5])
def test_an_outline_from_above_is_that_of_its_cells(bend):
    rim = [[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]]  # straight over several cells
    sole = laid_over(hex_layout(rim), lambda x, y: bend * x**2)
    rng = np.random.default_rng(8)
    for roll in (-0.4, 0.3, np.pi):  # the last one from below
        pose = SolePose([[1, 0, 0], [0, np.cos(roll), -np.sin(roll)], [0, np.sin(roll), np.cos(roll)]], [1, 2, 3])
        on = rng.random(len(sole)) < 0.6
        cells = [pose.to_world(sole.vertices[list(sole.corners[i])])[:, :2] for i in np.flatnonzero(on)]
        seen = pose.outline_to_world(concave_outline(sole, on), sole)
        assert abs(seen.area) == pytest.approx(sum(abs(area(cell)) for cell in cells), rel=1e-12)


def test_the_height_of_the_cop_is_exact_on_a_surface_of_second_order():
    bowl = laid_over(FLAT, lambda x, y: 2.0 * x**2 + 0.5 * x * y + 3.0 * y**2)
    force = random_force(np.random.default_rng(5), bowl)
    x, y, z = Percept(bowl, Reading(0.0, force)).surface_cop_in_sole
    assert z == pytest.approx(2.0 * x**2 + 0.5 * x * y + 3.0 * y**2, abs=1e-4)
