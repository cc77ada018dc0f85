"""The CoM's offset against drawn ones, of a body on two soles that carry it as statics says."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from plantar.common.sides import SIDES, Side
from plantar.gait.estimate.com_offset import com_offset
from plantar.gait.estimate.estimator import Posture
from plantar.mechanics.rotation import level_rotation

WEIGHT, HEIGHT = 800.0, 0.8
FEET: dict[Side, tuple[float, float, float, float]] = {
    "left": (0.02, 0.1, 0.0, 0.1),
    "right": (-0.01, -0.1, 0.0, -0.05),
}
COM = np.array([0.01, 0.0, 0.05])


def carried(com: NDArray[np.float64]) -> dict[Side, NDArray[np.float64]]:
    """Wrench on each sole that carries a CoM above a point of the line between two points of the soles."""
    points = {s: np.array(FEET[s][:2]) + level_rotation(FEET[s][3])[:2, :2] @ np.array([0.02, 0.0]) for s in SIDES}
    share = (com[1] - points["right"][1]) / (points["left"][1] - points["right"][1])
    on_line = points["right"] + share * (points["left"] - points["right"])
    wrenches: dict[Side, NDArray[np.float64]] = {}
    for side, part in (("left", share), ("right", 1.0 - share)):
        x, y = level_rotation(FEET[side][3])[:2, :2].T @ (points[side] + com[:2] - on_line - np.array(FEET[side][:2]))
        wrenches[side] = part * WEIGHT * np.array([0.0, 0.0, 1.0, y, -x, 0.0])
    return wrenches


def standing(rotation: NDArray[np.float64]) -> Posture:
    base = np.array([0.0, 0.0, HEIGHT])
    places = {s: rotation.T @ (np.array(FEET[s][:3]) - base) for s in SIDES}
    return Posture(COM, places, {s: rotation.T @ level_rotation(FEET[s][3]) for s in SIDES})


@pytest.mark.parametrize("seed", range(10))
def test_recovers_an_offset(seed):
    rng = np.random.default_rng(seed)
    true = np.array([*rng.uniform(-0.02, 0.02, 2).tolist(), 0.0])
    rotation = np.asarray(Rotation.from_rotvec([*rng.uniform(-0.02, 0.02, 2).tolist(), 0.0]).as_matrix())
    com = np.array([0.0, 0.0, HEIGHT]) + rotation @ (COM + true)
    found = com_offset(standing(rotation), rotation, FEET, carried(com))
    np.testing.assert_allclose((rotation @ found)[:2], (rotation @ true)[:2], atol=1e-9)
    np.testing.assert_allclose(found, true, atol=5e-4)  # but for the height, which does not show


def test_is_none_at_nominal_and_without_load():
    level = np.eye(3)
    com = np.array([0.0, 0.0, HEIGHT]) + COM
    np.testing.assert_allclose(com_offset(standing(level), level, FEET, carried(com)), 0.0, atol=1e-12)
    nothing: dict[Side, NDArray[np.float64]] = {side: np.zeros(6) for side in SIDES}
    assert not com_offset(standing(level), level, FEET, nothing).any()
