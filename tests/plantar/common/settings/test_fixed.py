"""Constants of a class of settings that grow with the robot: no file sets them."""

import pytest

from plantar.common.settings.body_scale import REFERENCE_BODY, BodyScale
from plantar.common.settings.schema import Settings, fixed, number
from plantar.errors import InputError


class _Step(Settings):
    """A step.

    Attributes:
        length: Length in m.
    """

    length: float = number(0.2, "m")
    near: float = fixed(0.5, "leg")


def test_a_fixed_value_grows_with_the_robot_and_is_no_setting():
    body = BodyScale(30.0, 0.4, 0.2, 0.1)
    assert _Step().near == pytest.approx(0.5 * REFERENCE_BODY.leg)
    assert _Step(length=0.3).for_body(body).near == pytest.approx(0.2)
    assert _Step.names() == ("length",)
    assert [setting.name for setting in _Step.described()] == ["length"]
    with pytest.raises(InputError, match="unknown key 'near'"):
        _Step.from_table({"near": 0.1}, "[step]")
