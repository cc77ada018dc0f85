"""Limits of every walk, on either side of each."""

import pytest

from plantar.sim.judging.run_limits import limit_reasons
from plantar.sim.terrain import Ground, Solid


@pytest.mark.parametrize(
    ("impacts", "level", "held", "failed"),
    [
        ((), True, 0.0, []),
        ((0.3, 1.0), True, 0.1, []),
        ((0.3, 1.01), True, 0.0, [("impact", 1.01, 1.0)]),
        ((1.5,), False, 0.0, []),
        ((1.51, 0.2), False, 0.0, [("impact", 1.51, 1.5)]),
        ((0.1,), True, 0.11, [("torque_limit", 0.11, 0.1)]),
    ],
)
def test_hard_landings_and_motors_at_their_limits_fail(impacts, level, held, failed):
    assert [(r["criterion"], r["value"], r["limit"]) for r in limit_reasons(impacts, level, held)] == failed


def box(top: float, lean: float = 0.0) -> Solid:
    import numpy as np

    from plantar.mechanics.rotation import rotation_from_angles

    return Solid("box", (0.1, 0.1, 0.05), np.array([0.0, 0.0, top - 0.05]), rotation_from_angles(0.3, lean))


def test_ground_is_level_where_all_faces_are_level_at_one_height():
    assert Ground((), 0.0, 0.8).level_at(0.0)
    assert Ground((box(0.0), box(0.0)), -0.3, 0.8).level_at(0.0)
    assert not Ground((box(0.03),), 0.0, 0.8).level_at(0.0)
    assert not Ground((box(0.0), box(0.0, 0.1)), -0.3, 0.8).level_at(0.0)
    assert not Ground((Solid("sphere", (0.1, 0, 0), box(0.0).position),), 0.0, 0.8).level_at(0.0)
