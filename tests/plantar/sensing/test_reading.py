import copy
import pickle

import numpy as np
import pytest

from plantar import Reading, ReadingError


def test_values_become_float64():
    reading = Reading(time=1.0, force=[1, 2], proximity=[0, np.inf], temperature=[30, 31])
    assert reading.force.dtype == reading.proximity.dtype == reading.temperature.dtype == np.float64


def test_members_that_were_not_measured_are_none():
    reading = Reading(time=0.0, force=np.zeros(3))
    assert reading.proximity is None
    assert reading.temperature is None
    assert reading.acceleration is None


def test_a_reading_without_taxels_is_one():
    assert Reading(time=0.0, force=[]).force.shape == (0,)


@pytest.mark.parametrize("time", [None, "0", np.nan, np.inf, [0.0]])
def test_a_time_is_a_finite_number(time):
    with pytest.raises(ReadingError, match="'time' is"):
        Reading(time=time, force=np.zeros(2))


FIELDS = {"force": (3,), "proximity": (3,), "temperature": (3,), "acceleration": (3, 3)}


def test_what_a_caller_does_with_its_buffers_afterwards_changes_nothing():
    given = {name: np.ones(shape) for name, shape in FIELDS.items()}
    reading = Reading(time=0.0, **given)
    for array in given.values():
        array[:] = 0.0
    assert all((getattr(reading, name) == 1.0).all() for name in FIELDS)


def test_a_view_of_a_larger_buffer_is_copied_too():
    buffer = np.ones((3, 4))
    reading = Reading(0.0, buffer[:, 1], acceleration=buffer[:, ::-1][:, :3])
    buffer[:] = 0.0
    assert reading.force.tolist() == [1.0, 1.0, 1.0]
    assert reading.acceleration.min() == 1.0


@pytest.mark.parametrize("again", [lambda r: r, copy.copy, copy.deepcopy, lambda r: pickle.loads(pickle.dumps(r))])
def test_a_reading_and_its_copies_are_read_only(again):
    reading = again(Reading(time=2.0, **{name: np.ones(shape) for name, shape in FIELDS.items()}))
    assert reading.time == 2.0
    for name in FIELDS:
        with pytest.raises(ValueError, match="read-only"):
            getattr(reading, name)[0] = 0.0
        assert getattr(reading, name).base is None  # no way round
