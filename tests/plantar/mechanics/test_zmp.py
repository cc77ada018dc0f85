import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from plantar import InputError
from plantar.mechanics.lip import divergent_component
from plantar.mechanics.wrench import wrench_at
from plantar.mechanics.zmp import centroidal_moment_pivot, zero_moment_wrench, zmp_in_plane, zmp_of_feet
from plantar.percepts.sole_pose import SolePose, wrench_of_feet

seeds = st.integers(0, 2**32 - 1)


def random_wrench(rng):
    return np.concatenate([rng.normal(0, 50, 2), rng.uniform(10, 900, 1), rng.normal(0, 20, 3)])


@given(seeds)
def test_about_the_zmp_the_wrench_has_no_tipping_moment(seed):
    rng = np.random.default_rng(seed)
    wrench, height = random_wrench(rng), rng.uniform(-0.5, 0.5)
    point, moved = zero_moment_wrench(wrench, height)
    assert point[2] == height
    assert point[:2].tolist() == zmp_in_plane(wrench, height).tolist()
    assert moved == pytest.approx(wrench_at(wrench, point), abs=1e-10)
    assert moved[3:5].tolist() == [0.0, 0.0]
    assert moved[:3].tolist() == wrench[:3].tolist()


@pytest.mark.parametrize("fz", [0.0, -300.0, math.nan, math.inf])
def test_no_load_has_no_point(fz):
    wrench = np.array([1.0, 0, fz, 1.0, 1.0, 0])
    assert zmp_in_plane(wrench) is None
    assert zero_moment_wrench(wrench) is None
    assert centroidal_moment_pivot(wrench, [0, 0, 0.8]) is None
    assert zmp_in_plane(np.array([1.0, 0, 0.99, 1.0, 1.0, 0]), minimum_force=1.0) is None


def test_a_wrench_that_is_not_finite_has_no_point():
    assert zmp_in_plane([0, 0, 100.0, math.nan, 0, 0]) is None
    assert centroidal_moment_pivot([math.nan, 0, 100.0], [0, 0, 0.8]) is None


@given(seeds)
def test_the_pivot_is_the_zmp_where_the_wrench_passes_through_the_com(seed):
    rng = np.random.default_rng(seed)
    force, com, height = random_wrench(rng)[:3], rng.uniform(-1, 1, 3), rng.uniform(-0.5, 0.0)
    through = np.concatenate([force, np.cross(com, force)])
    assert centroidal_moment_pivot(through, com, height) == pytest.approx(zmp_in_plane(through, height), abs=1e-9)
    # Away from it by the tipping moment about the CoM over the vertical force (Popovic et al. 2005, eq. 7).
    tipped = through + np.array([0, 0, 0, 4.0, -6.0, 0])
    gap = centroidal_moment_pivot(tipped, com, height) - zmp_in_plane(tipped, height)
    assert gap == pytest.approx(np.array([-6.0, -4.0]) / force[2], abs=1e-9)


def test_the_dcm_is_where_a_pendulum_comes_to_rest():
    omega, x, v = 3.5, 0.02, 0.3
    xi = divergent_component([x], [v], omega)[0]
    t, position = 5.0, x
    # x'' = omega^2 (x - xi) from (x, v): x(t) = xi + (x - xi) cosh + v / omega sinh
    position = xi + (x - xi) * math.cosh(omega * t) + v / omega * math.sinh(omega * t)
    assert position == pytest.approx(xi, abs=1e-6)
    assert divergent_component(np.zeros((4, 3)), np.ones((4, 3)), 2.0).tolist() == [[0.5] * 3] * 4
    for bad in (0.0, -1.0, math.nan, math.inf):
        with pytest.raises(InputError, match="pendulum frequency"):
            divergent_component([0.0], [0.0], bad)


def random_pose(rng, tilt=1.0):
    return SolePose(Rotation.from_rotvec(rng.uniform(-tilt, tilt, 3)).as_matrix(), rng.uniform(-1, 1, 3))


@given(seeds)
def test_wrench_of_feet_is_forces_and_their_points_in_the_world(seed):
    rng = np.random.default_rng(seed)
    poses = [random_pose(rng), random_pose(rng)]
    expected, wrenches = np.zeros(6), []
    for pose in poses:
        points, forces = rng.uniform(-0.1, 0.1, (4, 3)), rng.normal(0, 100, (4, 3))
        wrenches.append(np.concatenate([forces.sum(axis=0), np.cross(points, forces).sum(axis=0)]))
        for p, f in zip(points, forces, strict=True):
            world_force = pose.rotation_sole_to_world @ f
            expected += np.concatenate([world_force, np.cross(pose.to_world(p), world_force)])
    assert wrench_of_feet(wrenches, poses) == pytest.approx(expected, abs=1e-9)
    frames = [np.stack([w, 2 * w]) for w in wrenches]
    assert wrench_of_feet(frames, poses) == pytest.approx(np.stack([expected, 2 * expected]), abs=1e-9)


@given(seeds)
def test_on_level_soles_the_composite_zmp_is_the_weighted_mean_as_printed(seed):
    rng = np.random.default_rng(seed)
    wrenches = [random_wrench(rng) * [0, 0, 1, 1, 1, 1] for _ in range(2)]
    poses = [SolePose.flat(*rng.uniform(-0.3, 0.3, 2), yaw=rng.uniform(-3, 3)) for _ in range(2)]
    points = [p.to_world([*zmp_in_plane(w), 0.0])[:2] for w, p in zip(wrenches, poses, strict=True)]
    expected = zmp_of_feet(points, [w[2] for w in wrenches])
    assert zmp_in_plane(wrench_of_feet(wrenches, poses)) == pytest.approx(expected, abs=1e-9)


@given(seeds)
def test_turning_the_world_turns_the_composite_zmp(seed):
    rng = np.random.default_rng(seed)
    wrenches = [random_wrench(rng) for _ in range(2)]
    poses = [random_pose(rng, 0.2) for _ in range(2)]
    yaw = rng.uniform(-3, 3)
    turn = SolePose.flat(*rng.uniform(-1, 1, 2), yaw=yaw)
    turned = [
        SolePose(turn.rotation_sole_to_world @ p.rotation_sole_to_world, turn.to_world(p.position_in_world))
        for p in poses
    ]
    before = zmp_in_plane(wrench_of_feet(wrenches, poses), height=0.1)
    if before is None:
        return
    expected = turn.to_world([*before, 0.1])[:2]
    assert zmp_in_plane(wrench_of_feet(wrenches, turned), height=0.1) == pytest.approx(expected, rel=1e-9, abs=1e-7)


def test_feet_in_the_air_have_no_zmp_and_one_foot_has_its_own():
    poses = [SolePose.flat(0.0, 0.1), SolePose.flat(0.0, -0.1)]
    assert zmp_in_plane(wrench_of_feet([np.zeros(6), np.zeros(6)], poses)) is None
    one = wrench_of_feet([np.zeros(6), [0, 0, 80.0, 0, 0, 0]], poses)
    assert zmp_in_plane(one).tolist() == [0.0, -0.1]
    with pytest.raises(InputError, match="one pose a wrench"):
        wrench_of_feet([np.zeros(6)], poses)
    with pytest.raises(InputError, match="one pose a wrench"):
        wrench_of_feet([], [])


def test_a_pose_keeps_its_own_copy_and_refuses_what_is_none():
    rotation = np.eye(3)
    pose = SolePose(rotation, np.zeros(3))
    rotation[0, 0] = 5.0
    assert pose.rotation_sole_to_world[0, 0] == 1.0
    with pytest.raises(ValueError, match="read-only"):
        pose.position_in_world[0] = 1.0
    for bad in (np.diag([1.0, 1.0, -1.0]), 2 * np.eye(3), np.full((3, 3), np.nan), np.eye(2)):
        with pytest.raises(InputError, match="sole pose"):
            SolePose(bad, np.zeros(3))


def test_a_polygon_in_the_world_is_its_points_in_the_world():
    rng = np.random.default_rng(3)
    pose, ring = random_pose(rng, 0.3), rng.uniform(-0.1, 0.1, (5, 2))
    points = pose.to_world(np.column_stack([ring, np.zeros(5)]))
    assert pose.polygon_to_world(ring) == pytest.approx(points[:, :2])
    assert pose.polygon_to_world(np.empty((0, 2))).shape == (0, 2)
