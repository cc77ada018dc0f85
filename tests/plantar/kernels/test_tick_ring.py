"""The ring of the last ticks' numbers, against a list of all; both forms."""

from types import MappingProxyType, SimpleNamespace

import numpy as np
import pytest

from plantar.kernels import python_form
from plantar.kernels.safety import tick_ring

FORMS = pytest.mark.parametrize("form", [tick_ring, python_form("tick_ring")], ids=["compiled", "python"])


@FORMS
@pytest.mark.parametrize("ticks", [0, 1, 6, 7, 8, 25])
def test_the_last_ticks_are_kept_in_order(form, ticks):
    rng = np.random.default_rng(ticks)
    ring = form.TickRing(7, (3, 1))
    rows = []
    for _ in range(ticks):
        numbers = rng.normal(size=4).tolist()
        fields = (rng.normal(size=3), rng.normal(size=1))
        ring.add(*numbers, fields)
        rows.append(np.concatenate([numbers, *fields]))
    assert np.array_equal(ring.kept(), np.array(rows[-7:]).reshape(-1, 8))


@FORMS
def test_what_is_no_array_of_its_size_is_kept_as_nan(form):
    given = [np.array([1, 2], dtype=np.int32), np.array([1.0, 2.0], dtype=np.float32), np.arange(4.0)[1::2] + 0.0]
    others = [None, 3.0, [1.0, 2.0], np.zeros(3), np.zeros((2, 1)), np.array(["a", "b"]), np.zeros(2, dtype=complex)]
    ring = form.TickRing(20, (2,))
    for field in (*given, *others):
        ring.add(0.0, 0.0, 0.0, 0.0, (field,))
    found = ring.kept()[:, 4:]
    assert np.array_equal(found[:3], [[1.0, 2.0], [1.0, 2.0], [1.0, 3.0]])
    assert np.isnan(found[3:]).all()
    assert len(found) == 10


@FORMS
def test_a_tick_is_kept_by_what_was_measured_and_commanded(form):
    rng = np.random.default_rng(2)
    joints, gyro, accelerometer, left, right, com = (rng.normal(size=n) for n in (4, 3, 3, 5, 6, 3))
    feet = {side: SimpleNamespace(position=rng.normal(size=3)) for side in ("left", "right")}
    readings = {"left": SimpleNamespace(force=left), "right": SimpleNamespace(force=right)}
    sensors = SimpleNamespace(joint_positions=joints, gyro=gyro, accelerometer=accelerometer, readings=readings)
    command = SimpleNamespace(com=com, feet=feet, stiffness=0.5, phase=SimpleNamespace(kind=2, step=7))
    ring = form.TickRing(3, (4, 3, 3, 5, 6, 3, 3, 3))
    ring.add_tick(0.25, sensors, command)
    places = feet["left"].position, feet["right"].position
    expected = np.concatenate([[0.25, 0.5, 2, 7], joints, gyro, accelerometer, left, right, com, *places])
    assert np.array_equal(ring.kept(), expected[None])
    for lacking in (None, {}, {"left": None, "right": SimpleNamespace()}, [left, right]):
        sensors.readings = lacking
        ring.add_tick(0.5, sensors, command)
        assert np.isnan(ring.kept()[-1][14:25]).all()
    sensors.readings = MappingProxyType(readings)
    ring.add_tick(0.75, sensors, command)
    assert np.array_equal(ring.kept()[-1][4:], expected[4:])
