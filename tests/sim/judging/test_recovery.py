import math

import numpy as np
import pytest

from plantar.sim.judging.recovery import Recovery
from plantar.sim.model.shove import Shove

SHOVES = [
    Shove(1.0004, 2.0004, np.array([0.7, 20.004, 0.0]), smooth=True),
    Shove(5.0, 6.0, np.array([-10.0, 0.0, 0.0]), smooth=True),
]
ORIGIN = np.zeros(2)


def run(zmp_at, com_at, end: float = 9.0) -> dict:
    recovery = Recovery(SHOVES)
    for time in np.arange(0.0, end, 0.005):
        recovery.update(time, zmp_at(time), com_at(time), ORIGIN, ORIGIN)
    return recovery.summary([s.impulse for s in SHOVES])


def test_a_push_is_over_when_zmp_and_com_stay_near_the_plan():
    def zmp(time: float) -> np.ndarray:
        return np.array([0.08004, 0.0]) if 1.2 < time < 2.5 else ORIGIN

    summary = run(zmp, lambda time: np.array([0.02, 0.0]) if 5.5 < time < 7.0 else ORIGIN)
    first, second = summary["pushes"]
    rounded = {"time_s": 1.0, "impulse_Ns": 20.02, "direction_deg": 88.0, "zmp_off_max_m": 0.08, "recovered_s": 0.495}
    assert first == rounded
    assert summary["zmp_off_max_m"] == 0.08
    assert second["recovered_s"] == pytest.approx(1.0, abs=0.01)
    assert abs(second["direction_deg"]) == 180.0
    assert summary["recovered"] == 2


def test_a_robot_that_stays_off_sways_on_or_falls_has_not_recovered():
    away = run(lambda time: np.array([0.05, 0.0]) if time > 5.2 else ORIGIN, lambda time: ORIGIN)
    assert [p["recovered_s"] is None for p in away["pushes"]] == [False, True]
    sway = run(lambda time: np.array([0.03 * math.sin(9.0 * time), 0.0]), lambda time: ORIGIN)
    assert sway["recovered"] == 0
    air = run(lambda time: None if time > 5.2 else ORIGIN, lambda time: ORIGIN)
    assert air["recovered"] == 1
    # A run that ends in the fall never saw the robot at rest.
    recovery = Recovery(SHOVES)
    recovery.update(1.1, ORIGIN, ORIGIN, ORIGIN, ORIGIN)
    cut = recovery.summary([0.5 * SHOVES[0].impulse])
    assert cut["recovered"] == 0
    assert [p["impulse_Ns"] for p in cut["pushes"]] == [10.01, None]
    assert [p["zmp_off_max_m"] for p in cut["pushes"]] == [0.0, None]
