"""Plain ground is one level face under a foot and around it."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.mechanics.rotation import level_rotation
from plantar.sim.judging.plain_ground import PlainGround
from plantar.sim.terrain import Ground, Motion, Solid

SOLE = np.array([[-0.1, -0.05], [0.15, -0.05], [0.15, 0.05], [-0.1, 0.05]])
TILTED = np.array([[np.cos(0.1), 0.0, np.sin(0.1)], [0.0, 1.0, 0.0], [-np.sin(0.1), 0.0, np.cos(0.1)]])


def plain(*solids: Solid) -> PlainGround:
    return PlainGround(Ground(solids, 0.0, 0.8), {"left": SOLE, "right": SOLE}, 0.1)


def test_the_bare_floor_is_plain() -> None:
    assert plain().under("left", 3.0, -2.0, 1.0)


def test_what_lies_within_reach_is_not() -> None:
    ground = plain(Solid("box", (0.05, 0.05, 0.02), np.array([1.0, 0.0, 0.02])))
    assert not ground.under("left", 1.0, 0.0, 0.0)
    assert not ground.under("left", 0.72, 0.0, 0.0)  # its toe ends 0.08 m before it
    assert ground.under("left", 0.65, 0.0, 0.0)  # 0.15 m before it
    assert ground.under("left", 0.72, 0.0, np.pi)  # its heel does so 0.13 m before it
    assert not ground.under("left", 1.25, 0.0, np.pi)


@pytest.mark.parametrize(
    ("solid", "is_plain"),
    [
        (Solid("box", (1.0, 1.0, 0.1), np.array([0.0, 0.0, 0.1])), True),
        (Solid("box", (1.0, 1.0, 0.1), np.array([0.0, 0.0, 0.1]), level_rotation(0.4)), True),
        (Solid("box", (1.0, 0.06, 0.1), np.array([0.0, 0.0, 0.1])), False),
        (Solid("box", (1.0, 1.0, 0.1), np.array([0.0, 0.0, 0.1]), TILTED), False),
        (Solid("sphere", (1.0, 1.0, 1.0), np.array([0.0, 0.0, -0.9])), False),
        (Solid("box", (1.0, 1.0, 0.1), np.zeros(3), motions=(Motion(1.0, 1.0, np.ones(3)),)), False),
    ],
    ids=["a large level box", "a turned one", "a beam", "a slope", "a sphere", "ground that moves"],
)
def test_only_a_level_face_that_stays_is_plain(solid: Solid, is_plain: bool) -> None:
    assert plain(solid).under("right", 0.0, 0.0, 0.0) == is_plain
