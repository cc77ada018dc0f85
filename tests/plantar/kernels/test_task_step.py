"""The kernel of a step in both forms: it is taken where all of its parts agree, and only there."""

import importlib

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar import kernels
from plantar.kernels import python_form
from plantar.kernels.joints import task_step
from plantar.kernels.mechanics import rotations
from plantar.mechanics.rotation import rotation_error

FORMS = (task_step, python_form("task_step"))
WAYS, SPEEDS, TURNS, RATES = (np.array(a) for a in ([0, 1, 2, 7, 12], [0, 1, 2, 6, 10], [3, 8], [3, 7]))


def moved(module, start, velocity):
    """Where a free body, a hinge, a ball and a slide are after one unit of time."""
    there = start.copy()
    module.Configuration(WAYS, SPEEDS, TURNS, RATES, there, velocity).move()
    return there


@pytest.mark.parametrize("seed", range(20))
def test_ways_add_and_quaternions_turn_in_their_own_frame(seed):
    rng = np.random.default_rng(seed)
    start, velocity = rng.normal(size=13), rng.normal(size=11) * 10.0 ** rng.integers(-17, 1)
    there = moved(task_step, start, velocity)
    assert np.array_equal(there[WAYS], start[WAYS] + velocity[SPEEDS])
    for place, rate in zip(TURNS, RATES, strict=True):
        before = Rotation.from_quat(start[place : place + 4], scalar_first=True)
        after = (before * Rotation.from_rotvec(velocity[rate : rate + 3])).as_quat(scalar_first=True)
        found = there[place : place + 4]
        np.testing.assert_allclose(found * np.sign(found @ after), after, atol=1e-14)
    assert np.array_equal(moved(FORMS[1], start, velocity), there)


@pytest.mark.parametrize("module", FORMS)
def test_a_quaternion_of_no_length_is_no_turn(module):
    there = moved(module, np.zeros(13), np.zeros(11))
    assert np.array_equal(there, np.isin(np.arange(13), TURNS).astype(float))


COMPILED = {n.rpartition(".")[2]: importlib.import_module(f"plantar.kernels.{n}") for n in kernels.KERNELS}


@pytest.mark.parametrize("form", [COMPILED.__getitem__, python_form])
def test_a_slide_and_a_hinge_go_to_their_target_in_one_step(form):
    """A slide along x and a hinge about z: a turn and the way of a point on the hinge's axis."""
    motions = np.array([[0.0, 0.0, 0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0, 0.0, 0.0]])
    q, velocity, step, error, jacobian, used = (
        np.zeros(2),
        np.zeros(2),
        np.zeros(2),
        *map(np.zeros, (6, (6, 2), (6, 2))),
    )
    target, wanted, actual, none = np.array([0.3, 0.0, 0.0]), np.eye(3), np.eye(3), np.zeros(3)
    chain, ones = np.array([0, 1]), np.ones(6)
    com = form("task_step").ComRows(
        *(np.array([0]), np.array([1]), np.ones(1), 1.0, motions, np.zeros((1, 3)), np.array([0]), np.zeros((1, 3))),
        *(target, none, error[:3], jacobian[:3]),
    )
    turn = form("task_step").TurnRows(chain, motions, wanted, actual, error[3:], jacobian[3:])
    newton = form("task_step").NewtonStep(
        *(chain, ones, np.ones(2), chain, chain, np.zeros(2), np.ones(2), 0.0, 1e-3),
        *((jacobian, error, q), used, step, velocity),
    )
    empty = np.empty(0, dtype=np.intp)
    configuration = form("task_step").Configuration(chain, chain, empty, empty, q, velocity)
    kernel = form("task_step").TaskStep([com, turn], newton, configuration)
    sine, cosine = 0.6, 0.8
    wanted[:2, :2] = [[cosine, -sine], [sine, cosine]]
    assert kernel.step(1.0)
    assert kernel.near
    np.testing.assert_allclose(q, [0.3, 0.6], rtol=1e-12)
    assert not kernel.step(0.5)  # the hinge would go 0.6 once more
    assert kernel.near
    np.testing.assert_allclose(q, [0.3, 0.6], rtol=1e-12)
    kernel.move()  # as it stands
    np.testing.assert_allclose(q, [0.6, 1.2], rtol=1e-12)
    wanted[:2, :2] *= -1.0
    assert not kernel.step(9.0)
    assert not kernel.near
    np.testing.assert_allclose(q, [0.6, 1.2], rtol=1e-12)


ROUNDING, LEAST = 1e-8, 0.04


def problem(seed):
    """A leg-like problem: six velocities of a base and joints of which two are held, in units of 0.7 m."""
    rng = np.random.default_rng(seed)
    rows, nv = int(rng.integers(10, 19)), 20
    columns = np.setdiff1d(np.arange(nv), rng.choice(np.arange(6, nv), 2, replace=False))
    jacobian = rng.normal(size=(rows, nv)) * (rng.random((rows, nv)) < 0.7)
    row_units, column_units = rng.choice([1.0 / 0.7, 1.0], rows), np.where(np.arange(nv) < 3, 0.7, 1.0)
    return jacobian, 0.1 * rng.normal(size=rows), rng.normal(size=nv), columns, row_units, column_units


def solved(module, given, half=10.0, largest=1e9, least=0.0):
    """What a form says, its step, its Jacobian, the error in units and the velocity."""
    jacobian, error, configuration, columns, row_units, column_units = given
    movable, error = np.arange(6, len(columns)), error.copy()
    used, step, velocity = np.zeros((len(error), len(columns))), np.zeros(len(columns)), np.zeros(jacobian.shape[1])
    middle, halves = np.zeros(len(movable)), np.full(len(movable), half)
    kernel = module.NewtonStep(
        *(columns, row_units, column_units, movable, columns[movable], middle, halves, ROUNDING, least),
        *((jacobian, error, configuration), used, step, velocity),
    )
    for _ in range(2):  # nothing stays of the step before
        error[:] = given[1]
        stays = kernel.solve(largest)
    np.testing.assert_equal(kernel.worst(), np.abs(error).max())
    kernel.write()
    return stays, step, used, error, velocity


@pytest.mark.parametrize("seed", range(12))
def test_a_step_is_that_of_the_normal_equations(seed):
    given = problem(seed)
    jacobian, error, _, columns, row_units, column_units = given
    stays, step, used, in_units, velocity = solved(task_step, given, np.inf)
    scaled = (jacobian * row_units[:, None] * column_units)[:, columns]
    np.testing.assert_allclose(used, scaled, rtol=1e-15)
    np.testing.assert_allclose(in_units, error * row_units, rtol=1e-15)
    normal = scaled.T @ scaled + ROUNDING * np.eye(len(columns))
    # Backward stable: what is left of the equations is rounding of their size.
    left = normal @ step - scaled.T @ in_units
    assert np.abs(left).max() <= 1e-13 * np.abs(normal).max() * max(1.0, np.abs(step).max())
    if len(error) >= len(columns):
        np.testing.assert_allclose(step, np.linalg.solve(normal, scaled.T @ in_units), rtol=1e-9)
    assert stays
    np.testing.assert_array_equal(velocity[columns], step * column_units[columns])
    assert not np.delete(velocity, columns).any()
    for a, b in zip(solved(FORMS[1], given, np.inf), (stays, step, used, in_units, velocity), strict=True):
        assert np.array_equal(a, b)


@pytest.mark.parametrize("module", FORMS)
def test_a_step_stays_only_where_nothing_forbids_it(module):
    given = problem(3)
    _, step, *_ = solved(module, given, np.inf)
    size = float(np.abs(step).max())
    assert solved(module, given, np.inf, largest=size)[0]
    assert not solved(module, given, np.inf, largest=np.nextafter(size, 0.0))[0]
    _, error, configuration, columns, *_ = given
    reach = float(np.abs(configuration[columns[6:]] + step[6:]).max())
    assert solved(module, given, reach)[0]
    assert not solved(module, given, np.nextafter(reach, 0.0))[0]
    scaled = solved(module, given, np.inf)[2]
    pivot = float(np.linalg.cholesky(scaled.T @ scaled + ROUNDING * np.eye(len(columns))).diagonal().min())
    assert solved(module, given, np.inf, least=pivot * (1.0 - 1e-6))[0]
    assert not solved(module, given, np.inf, least=pivot * (1.0 + 1e-6))[0]
    error[2] = np.nan
    assert not solved(module, given, np.inf)[0]


@pytest.mark.parametrize("angle", [0.0, 1e-8, 0.4, 1.57, 1.58, 2.9, np.pi])
def test_the_missing_pose_is_the_error_of_its_rotation_up_to_a_quarter_turn(angle):
    rng = np.random.default_rng(5)
    actual = Rotation.from_rotvec(rng.normal(size=3))
    axis = rng.normal(size=3)
    wanted = (Rotation.from_rotvec(angle * axis / np.linalg.norm(axis)) * actual).as_matrix()
    place, at = rng.normal(size=(2, 3))
    for module in (rotations, python_form("rotations")):
        out = np.empty(6)
        near = module.missing_pose(place, wanted, at, actual.as_matrix(), out)
        assert near == (angle <= np.pi / 2)
        np.testing.assert_array_equal(out[:3], place - at)
        if near:
            np.testing.assert_allclose(out[3:], rotation_error(wanted, actual.as_matrix()), rtol=1e-13, atol=1e-15)


NV = 11


def tree(rng):
    """Unit motions, two centers, and the chain of each of four bodies, the last of which no velocity moves."""
    chains = [rng.permutation(NV)[: rng.integers(1, NV)] for _ in range(3)]
    return rng.normal(size=(NV, 6)), rng.normal(size=(2, 3)), [*chains, np.empty(0, dtype=np.intp)]


def velocity(motions, chain, arm):
    """Velocity (3, nv) of a point at an arm from the center."""
    out = np.zeros((3, NV))
    out[:, chain] = (motions[chain, 3:] + np.cross(motions[chain, :3], arm)).T
    return out


def turning(motions, chain):
    out = np.zeros((3, NV))
    out[:, chain] = motions[chain, :3].T
    return out


@pytest.mark.parametrize("seed", range(8))
def test_points_turns_and_poses_move_by_their_chain(seed):
    rng = np.random.default_rng(seed)
    motions, (center, _), (chain, *_) = tree(rng)
    for _ in range(4):
        at, position = rng.normal(size=(2, 3))
        actual = Rotation.from_rotvec(rng.normal(size=3))
        angle = rng.uniform(0.0, 3.0)
        axis = rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        wanted = (Rotation.from_rotvec(angle * axis) * actual).as_matrix()
        found = []
        for module in FORMS:
            lever, error, both = np.zeros((3, NV)), np.zeros(6), np.zeros((6, NV))
            turn, turns = np.zeros(3), np.zeros((3, NV))
            module.PointRows(chain, motions, center, lever).write(*position.tolist())
            near = module.TurnRows(chain, motions, wanted, actual.as_matrix(), turn, turns).write()
            pose = module.PoseRows(chain, motions, center, position, wanted, at, actual.as_matrix(), error, both)
            assert pose.write() == near == (angle <= np.pi / 2)
            found.append((lever, error, both, turn, turns))
        for a, b in zip(*found, strict=True):
            assert np.array_equal(a, b)
        assert np.array_equal(lever, velocity(motions, chain, position - center))
        assert np.array_equal(both, np.vstack([velocity(motions, chain, at - center), turning(motions, chain)]))
        assert np.array_equal(error, [*(position - at), *turn])
        assert np.array_equal(turns, turning(motions, chain))
        if near:
            np.testing.assert_allclose(turn, np.sin(angle) * axis, atol=1e-14)


@pytest.mark.parametrize("seed", range(8))
def test_a_com_moves_as_its_bodies_do_by_their_mass(seed):
    rng = np.random.default_rng(seed)
    motions, centers, chains = tree(rng)
    trees, masses = rng.integers(0, 2, len(chains)), rng.uniform(0.0, 3.0, len(chains))
    places, com, target = rng.normal(size=(len(chains), 3)), rng.normal(size=3), np.zeros(3)
    results = [(np.zeros(3), np.zeros((3, NV))) for _ in FORMS]
    kernels = [
        module.ComRows(
            *(np.concatenate(chains), np.cumsum([len(c) for c in chains]), masses, 1.0 / masses.sum()),
            *(motions, centers, trees, places, target, com, *out),
        )
        for module, out in zip(FORMS, results, strict=True)
    ]
    for _ in range(2):
        places[:], target[:] = rng.normal(size=places.shape), rng.normal(size=3)
        moved = np.zeros((3, NV))
        for chain, mass, t, place in zip(chains, masses, trees, places, strict=True):
            moved += velocity(motions, chain, place - centers[t]) * mass
        for kernel, (error, jacobian) in zip(kernels, results, strict=True):
            assert kernel.write()
            assert np.array_equal(error, target - com)
            assert np.array_equal(jacobian, moved * (1.0 / masses.sum()))
