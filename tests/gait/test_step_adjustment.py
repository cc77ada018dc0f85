import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gait.footsteps import Footstep
from gait.step_adjustment import AdjustmentLimits, adjusted_step, remaining_error

OMEGA = 3.5
LIMITS = AdjustmentLimits()
STANCE = Footstep("right", 0.0, -0.085)
STEP = Footstep("left", 0.2, 0.085)


def test_remaining_error_is_the_solution_of_its_equation() -> None:
    error, held, time = 0.06, 0.02, 0.35
    value, dt = error, 1e-6
    for _ in range(round(time / dt)):
        value += dt * OMEGA * (value - held)
    predicted = remaining_error(np.array([error, 0.0]), np.array([held, 0.3]), OMEGA, time)
    assert predicted == pytest.approx([value, 0.0], rel=1e-5)


def test_what_the_stance_foot_can_hold_moves_no_step() -> None:
    assert not remaining_error(np.array([0.0, 0.03]), np.array([0.0, 0.05]), OMEGA, 0.5).any()
    assert not remaining_error(np.zeros(2), np.zeros(2), OMEGA, 0.5).any()
    assert adjusted_step(STEP, STANCE, np.array([0.0, 0.9 * LIMITS.deadband]), LIMITS) is STEP


@given(st.floats(-2, 2), st.floats(-2, 2), st.floats(-math.pi, math.pi))
def test_moved_steps_keep_every_limit(x: float, y: float, yaw: float) -> None:
    c, s = math.cos(yaw), math.sin(yaw)

    def turned(f: Footstep) -> Footstep:
        return Footstep(f.side, c * f.x - s * f.y, s * f.x + c * f.y, yaw)

    step, stance = turned(STEP), turned(STANCE)
    moved = adjusted_step(step, stance, np.array([c * x - s * y, s * x + c * y]), LIMITS)
    dx, dy = moved.x - step.x, moved.y - step.y
    forward, left = c * dx + s * dy, -s * dx + c * dy
    assert abs(forward) <= LIMITS.forward + 1e-12
    assert left <= LIMITS.outward + 1e-12
    separation = -s * (moved.x - stance.x) + c * (moved.y - stance.y)
    assert separation >= LIMITS.separation - 1e-12
    assert moved.yaw == step.yaw


def test_the_move_is_continuous_at_the_deadband() -> None:
    just = adjusted_step(STEP, STANCE, np.array([LIMITS.deadband * (1 + 1e-6), 0.0]), LIMITS)
    assert just.x == pytest.approx(STEP.x, abs=1e-7)
