"""What of a foothold an ankle bears the robot on, and where it is loaded."""

import numpy as np
import pytest

from plantar.gait.contact.ankle_reach import borne_part, loaded_middle

SOLE = np.array([[-0.07, -0.04], [0.18, -0.04], [0.18, 0.04], [-0.07, 0.04]])


def ground(rear: float, front: float) -> np.ndarray:
    """A foothold on ground from x = `rear` to `front` in m."""
    return np.array([[rear, -0.04], [front, -0.04], [front, 0.04], [rear, 0.04]])


@pytest.mark.parametrize(
    ("rear", "front", "part", "middle"),
    [
        (-0.07, 0.18, (-0.07, 0.08), 0.04),
        (-0.02, 0.05, (-0.02, 0.05), 0.015),
        (-0.01, 0.11, (-0.01, 0.08), 0.04),
        (0.06, 0.18, (0.06, 0.08), 0.07),
        (-0.2, -0.1, (-0.1, -0.1), -0.1),
        (-0.2, 0.02, (-0.08, 0.02), -0.04),
    ],
)
def test_a_weak_ankle_bears_the_robot_on_a_part(rear, front, part, middle):
    borne = borne_part(ground(rear, front), 0.08)
    assert (borne[:, 0].min(), borne[:, 0].max()) == pytest.approx(part)
    assert loaded_middle(ground(rear, front), 0.08) == pytest.approx([middle, 0.0])


def test_a_strong_ankle_bears_it_everywhere():
    assert borne_part(SOLE, 0.2) is SOLE
    assert loaded_middle(SOLE, float("inf")) == pytest.approx([0.055, 0.0])
