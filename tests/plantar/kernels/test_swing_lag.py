"""The lag of a foot that follows its command late, in both forms of its kernel."""

import numpy as np
import pytest

from plantar.kernels import python_form
from plantar.kernels.gait import swing_lag

PERIOD = 0.005
TIMES = np.arange(0.0, 0.8, PERIOD)
HEIGHTS = 0.08 * np.sin(np.pi * TIMES / 0.8) ** 2


def both() -> list:
    return [module.SwingLag(PERIOD, 2.43) for module in (swing_lag, python_form("swing_lag"))]


@pytest.mark.parametrize("delay", [0.0, 0.02, 0.0325, 0.06])
@pytest.mark.parametrize("offset", [0.0, -0.004])
def test_a_delay_is_found_whatever_the_offset(delay: float, offset: float) -> None:
    real = np.interp(TIMES - delay, TIMES, HEIGHTS) + offset
    forms = both()
    for commanded, measured in zip(HEIGHTS, real, strict=True):
        for lag in forms:
            lag.update(commanded, measured)
    assert forms[0].time == pytest.approx(delay, abs=0.1 * delay + 1e-9)
    # What is still to come is what the foot is above its command.
    assert forms[0].to_come == pytest.approx(real[-1] - offset - HEIGHTS[-1], abs=4e-4)
    assert (forms[0].time, forms[0].to_come) == (forms[1].time, forms[1].to_come)


def test_a_foot_that_hardly_moves_shows_no_lag() -> None:
    noise = np.random.default_rng(0).normal(0.0, 1e-3, len(TIMES))
    for lag in both():
        for k, error in enumerate(noise):
            lag.update(1e-5 * k, 1e-5 * k + error)
            assert lag.time == 0.0
            assert lag.to_come == 0.0


def test_a_swing_remembers_the_last_ones_lag() -> None:
    real = np.interp(TIMES - 0.03, TIMES, HEIGHTS)
    for lag in both():
        for commanded, measured in zip(HEIGHTS, real, strict=True):
            lag.update(commanded, measured)
        lag.begin()
        assert lag.to_come == 0.0
        lag.update(0.05, 0.05)
        assert lag.time == pytest.approx(0.03, abs=3e-3)


def test_a_long_lag_is_bounded_by_what_is_kept() -> None:
    for lag in both():
        for k in range(100):
            lag.update(-0.01 * k, -0.01 * k + (0.5 if k % 2 else 0.0))
        for k in range(200):
            lag.update((-1) ** k * 0.05, (-1) ** k * 1.0)
        assert 0.0 <= lag.time <= 30 * PERIOD
        assert np.isfinite(lag.to_come)
