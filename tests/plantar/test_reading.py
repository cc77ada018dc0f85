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


@pytest.mark.parametrize("field", ["proximity", "temperature"])
@pytest.mark.parametrize("value", [np.zeros(2), np.zeros((3, 1)), 0.0])
def test_a_wrong_shape_names_the_field(field, value):
    with pytest.raises(ReadingError, match=rf"'{field}' has shape .*; expected \(3,\)"):
        Reading(time=0.0, force=np.zeros(3), **{field: value})


def test_acceleration_has_three_axes():
    assert Reading(time=0.0, force=np.zeros(4), acceleration=np.zeros((4, 3))).acceleration.shape == (4, 3)
    with pytest.raises(ReadingError, match=r"'acceleration' has shape \(4,\); expected \(4, 3\)"):
        Reading(time=0.0, force=np.zeros(4), acceleration=np.zeros(4))


@pytest.mark.parametrize("force", [1.0, np.zeros((2, 2))])
def test_force_is_one_number_a_taxel(force):
    with pytest.raises(ReadingError, match="'force' has shape"):
        Reading(time=0.0, force=force)


@pytest.mark.parametrize(("field", "value"), [("force", ["a", "b"]), ("force", None), ("proximity", ["x", "y"])])
def test_text_names_the_field(field, value):
    with pytest.raises(ReadingError, match=f"'{field}'"):
        Reading(**{"time": 0.0, "force": np.zeros(2), field: value})
