"""Encoders and IMU that say nothing, or what is no number."""

import math

import numpy as np
import pytest

from plantar import InputError
from plantar.gait.estimate.body_sensors import BodySensors

SOUND = (np.full(12, -0.3), np.array([0.1, -0.2, 0.0]), np.array([0.0, 0.0, 9.81]))


@pytest.mark.parametrize("where", range(3))
@pytest.mark.parametrize("values", [(math.nan,), (math.inf,), (-math.inf,), (math.inf, -math.inf)])
def test_one_value_that_is_no_number_silences_all_three(where, values):
    body, silent = BodySensors(0.005, 0.01), [x.copy() for x in SOUND]
    silent[where][-len(values) :] = values
    joints, gyro, accelerometer = silent
    with pytest.raises(InputError, match="the first reading has to be sound"):
        body.usable((joints, gyro, accelerometer))
    assert body.usable(SOUND) is SOUND
    assert [body.usable((joints, gyro, accelerometer)) is SOUND for _ in range(3)] == [True, True, False]
    assert body.blind
    assert body.usable(SOUND) is None  # it stays so
