"""Foam that an obstacle sinks into, by both forms of the kernel, against the same laws written with numpy."""

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar.kernels import python_form
from plantar.kernels.contacts.foam_patch import FoamPatch

FORMS = {"compiled": FoamPatch, "python": python_form("contacts.foam_patch").FoamPatch}
STIFFNESS, DAMPING, FRICTION, SLIP = FOAM = np.array([1e7, 3e4, 0.5, 0.02])
DEPTH, RANGE = 0.03, 0.05


def expected(points, normals, areas, depths, link, obstacle):
    """Forces (m, 3) of the world on the link, by spin (3,), velocity (3,) and place (3,) of each in (9,)."""
    sliding = obstacle[3:6] + np.cross(obstacle[:3], points - obstacle[6:])
    sliding = sliding - link[3:6] - np.cross(link[:3], points - link[6:])
    rates = (sliding * normals).sum(axis=1)
    forces = np.maximum(areas * (STIFFNESS * depths + DAMPING * rates), 0.0)
    sliding -= rates[:, None] * normals
    drag = FRICTION / np.hypot(np.linalg.norm(sliding, axis=1), SLIP)
    return forces, forces[:, None] * (normals + drag[:, None] * sliding)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("number", range(20))
def test_foam_presses_back_by_depth_rate_and_sliding(form: str, number: int) -> None:
    rng = np.random.default_rng([number, 65])
    count = 12
    starts = rng.normal(0.0, 0.1, (count, 3))
    ways = rng.normal(size=(count, 3))
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    areas = rng.uniform(1e-4, 1e-3, count)
    limits = np.array([np.full(count, DEPTH), np.full(count, DEPTH + RANGE)])
    turn, origin = Rotation.random(random_state=number).as_matrix(), rng.normal(size=3)
    link, obstacle = rng.normal(0.0, 0.3, (2, 9))
    lengths = rng.uniform(0.8 * DEPTH, DEPTH + 1.5 * RANGE, count)
    lengths[:5] = rng.uniform(0.5 * DEPTH, DEPTH, 5)
    lengths[5] = -1.0
    patch: Any = FORMS[form](starts, ways, areas, limits, FOAM)
    patch.place(turn.ravel(), origin)
    near, values, vectors = np.full(count, np.inf), np.zeros((2, count)), np.zeros((count, 3))
    assert patch.press(lengths, link, obstacle, near, values, vectors)

    met = (lengths >= 0.0) & (lengths <= limits[1])
    assert near == pytest.approx(np.where(met, lengths - DEPTH, np.inf))
    pressed = met & (lengths < DEPTH)
    points = (starts @ turn.T + origin + lengths[:, None] * (ways @ turn.T))[pressed]
    depths = (DEPTH - lengths)[pressed]
    forces, pushes = expected(points, -(ways @ turn.T)[pressed], areas[pressed], depths, link, obstacle)
    assert (forces > 0.0).any()
    assert values[0, pressed] == pytest.approx(forces, rel=1e-9)
    assert values[1, pressed] == pytest.approx(depths)
    assert not values[:, ~pressed].any()
    assert vectors[pressed] == pytest.approx(pushes @ turn, rel=1e-9, abs=1e-9)
    total = pushes.sum(axis=0)
    about = np.cross(points, pushes).sum(axis=0)
    assert patch.wrench == pytest.approx(np.concatenate([total, about]), rel=1e-9, abs=1e-9)

    place = rng.normal(size=3)
    row = np.ones(6)
    patch.add(row, place, -1.0)
    assert row == pytest.approx(1.0 - np.concatenate([total, about - np.cross(place, total)]), rel=1e-9, abs=1e-9)
    row = np.zeros(6)
    patch.add_to_link(row)
    moment = about - np.cross(origin, total)
    assert row == pytest.approx(np.concatenate([total @ turn, moment @ turn]), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("form", FORMS)
def test_foam_that_nothing_meets_has_no_force(form: str) -> None:
    patch: Any = FORMS[form](np.zeros((2, 3)), np.eye(3)[:2], np.ones(2), np.full((2, 2), 0.1), FOAM)
    patch.place(np.eye(3).ravel(), np.zeros(3))
    near, values, vectors = np.full(2, np.inf), np.zeros((2, 2)), np.zeros((2, 3))
    assert not patch.press(np.array([-1.0, 0.2]), np.zeros(9), np.zeros(9), near, values, vectors)
    assert not values.any()
    assert np.isinf(near).all()
    assert not patch.wrench.any()
