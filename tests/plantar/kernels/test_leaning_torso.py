"""The kernel of the leaning torso against rotations multiplied by numpy; both forms."""

import math

import numpy as np
import pytest

from plantar.kernels import python_form
from plantar.kernels.gait import leaning_torso
from plantar.mechanics.rotation import rotation_from_angles

FORMS = pytest.mark.parametrize("form", [leaning_torso, python_form("leaning_torso")], ids=["compiled", "python"])
REACH = 0.08
LEAN = 1.5
ROUNDED = 0.2


@FORMS
def test_it_leans_by_the_way_aside_within_its_reach_and_no_farther_beyond(form):
    rng = np.random.default_rng(2)
    for _ in range(50):
        yaw = float(rng.uniform(-3.0, 3.0))
        middle = rng.normal(size=3)
        along = np.array([math.cos(yaw), math.sin(yaw), 0.0])
        across = np.array([-math.sin(yaw), math.cos(yaw), 0.0])
        left = middle + 0.1 * across + 0.2 * along
        right = middle - 0.1 * across - 0.2 * along
        for aside, wanted in ((0.5 * REACH, 0.5), (0.94 * REACH, 0.94), (1.2 * REACH, 1.05), (3.0 * REACH, 1.05)):
            for sign in (-1.0, 1.0):
                com = middle + sign * aside * across + 0.3 * along
                found = form.leaning_torso(com, left, right, yaw, REACH, LEAN, ROUNDED)
                roll = -sign * LEAN * wanted * REACH
                np.testing.assert_allclose(found, rotation_from_angles(yaw, 0.0, roll), atol=1e-12)


@FORMS
def test_it_leans_without_a_kink(form):
    feet = np.array([0.0, 0.1, 0.0]), np.array([0.0, -0.1, 0.0])
    asides = np.linspace(-2.0 * REACH, 2.0 * REACH, 2001)
    turns = [form.leaning_torso(np.array([0.0, y, 0.8]), *feet, 0.0, REACH, LEAN, ROUNDED) for y in asides]
    rates = np.diff([math.atan2(turn[2, 1], turn[2, 2]) for turn in turns]) / (asides[1] - asides[0])
    assert np.abs(np.diff(rates)).max() < 0.02 * LEAN
