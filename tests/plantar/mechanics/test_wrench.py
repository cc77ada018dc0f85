"""Wrenches in frames against sums of cross products and the axioms of moving them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from plantar.mechanics.contact import Contact
from plantar.mechanics.wrench import wrench_at, wrench_in_frame
from plantar.mechanics.wrench_cone import Rectangle

seeds = st.integers(0, 2**32 - 1)


def random_pose(rng: np.random.Generator) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    return Rotation.random(None, rng).as_matrix(), rng.uniform(-2.0, 2.0, 3)


@given(seeds)
def test_a_moved_wrench_is_that_of_the_moved_forces(seed):
    rng = np.random.default_rng(seed)
    points, forces = rng.uniform(-1.0, 1.0, (2, 5, 3))
    rotation, position = random_pose(rng)
    wrench = np.concatenate([forces.sum(axis=0), np.cross(points, forces).sum(axis=0)])
    there, pushes = points @ rotation.T + position, forces @ rotation.T
    expected = np.concatenate([pushes.sum(axis=0), np.cross(there, pushes).sum(axis=0)])
    assert wrench_in_frame(wrench, rotation, position) == pytest.approx(expected, abs=1e-13)


@given(seeds)
def test_moves_follow_each_other_and_lead_back(seed):
    rng = np.random.default_rng(seed)
    wrench = rng.normal(size=(4, 6))
    (r, p), (s, q) = random_pose(rng), random_pose(rng)
    both = wrench_in_frame(wrench_in_frame(wrench, r, p), s, q)
    assert both == pytest.approx(wrench_in_frame(wrench, s @ r, s @ p + q), abs=1e-12)
    assert wrench_in_frame(wrench_in_frame(wrench, r, p), r.T, -r.T @ p) == pytest.approx(wrench, abs=1e-12)
    assert np.array_equal(wrench_in_frame(wrench, np.eye(3), np.zeros(3)), wrench)
    assert wrench_in_frame(wrench, np.eye(3), -p) == pytest.approx(wrench_at(wrench, p), abs=1e-13)


@given(seeds)
def test_power_does_not_depend_on_the_frame(seed):
    """A wrench and a twist move contragrediently: f . v + tau . w is the same number in every frame."""
    rng = np.random.default_rng(seed)
    wrench, velocity, rate = rng.normal(size=6), rng.normal(size=3), rng.normal(size=3)
    rotation, position = random_pose(rng)
    turned = rotation @ rate
    there = np.concatenate([rotation @ velocity - np.cross(turned, position), turned])
    moved = wrench_in_frame(wrench, rotation, position)
    assert moved @ there == pytest.approx(wrench @ np.concatenate([velocity, rate]), abs=1e-12)


@given(seeds)
def test_a_contact_knows_its_wrench_and_its_centre_in_the_world(seed):
    rng = np.random.default_rng(seed)
    rotation, position = random_pose(rng)
    contact = Contact(position, rotation, Rectangle(-0.1, 0.16, -0.04, 0.06))
    assert contact.center_in_world == pytest.approx(rotation @ [0.03, 0.01, 0.0] + position)
    pushed = np.array([3.0, -2.0, 50.0])
    about_origin = contact.wrench_in_world([*pushed, *np.cross([0.03, 0.01, 0.0], pushed)])
    assert wrench_at(about_origin, np.array(contact.center_in_world))[3:] == pytest.approx(np.zeros(3), abs=1e-12)
