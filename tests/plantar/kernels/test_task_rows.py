"""The kernels of the tasks of inverse kinematics against numpy's cross products, and compiled against their source."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar.kernels import python_form
from plantar.kernels.joints import task_rows

FORMS = (task_rows, python_form("task_rows"))
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
