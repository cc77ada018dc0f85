"""Shares of a body: what they come to in SI, for which robot, and what is refused."""

import copy
import dataclasses
import math
import pickle

import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar.common.settings.body_scale import BODY_UNITS, REFERENCE_BODY, BodyScale, Quantity, si_unit
from plantar.common.settings.schema import Settings, number, share
from plantar.errors import InputError, SceneError

SMALL = BodyScale(mass=3.0, leg=0.22, sole=0.12, sole_width=0.07)


class Foot(Settings):
    """How a foot lands.

    Attributes:
        force: Force that counts.
        depth: Depth aimed for.
        rate: Turn for each moment.
        time: Time that counts, whatever the robot.
    """

    force: float = share(0.1, "weight", 0.0, 1000.0)
    depth: float = share(1 / 3, "leg", 0.0, 0.3)
    rate: float = share(2.0, "rad/beat/weight/sole", 0.0, 100.0)
    time: float = number(0.5, "s", 0.0, 10.0)


def test_a_share_is_the_same_part_of_every_body():
    for body in (REFERENCE_BODY, SMALL):
        foot = Foot().for_body(body)
        assert foot.body == body
        assert foot.force == pytest.approx(0.1 * body.mass * 9.81)
        assert foot.depth == pytest.approx(body.leg / 3.0)
        assert foot.rate == pytest.approx(2.0 / math.sqrt(body.leg / 9.81) / body.weight / body.sole)
        assert foot.time == 0.5
    assert Foot() == Foot().for_body(REFERENCE_BODY)


def test_a_pace_is_a_beat_unless_motors_are_slow():
    assert SMALL.in_si("pace") == SMALL.in_si("beat")
    slow = dataclasses.replace(SMALL, pace_beats=1.6)
    assert slow.in_si("pace") == pytest.approx(1.6 * SMALL.beat)
    assert slow.in_si("leg/pace") == pytest.approx(SMALL.in_si("leg/beat") / 1.6)
    assert slow.in_si("leg/beat") == SMALL.in_si("leg/beat")
    with pytest.raises(InputError, match="pace_beats"):
        dataclasses.replace(SMALL, pace_beats=0.0)


def test_a_number_is_in_si_and_stays():
    foot = Foot(force=70.0, time="2 beat").for_body(SMALL)
    assert foot.force == 70.0
    assert foot.time == pytest.approx(2.0 * SMALL.beat)
    assert foot.stated == {
        "depth": Quantity(1 / 3, "leg"),
        "rate": Quantity(2.0, "rad/beat/weight/sole"),
        "time": Quantity(2.0, "beat"),
    }


@pytest.mark.parametrize(
    ("text", "value"), [("70 N", 70.0), ("0.2 weight", 0.2 * SMALL.weight), ("3/4 mass m/s^2", 2.25), ("0 N", 0.0)]
)
def test_a_text_names_its_unit(text, value):
    assert Foot(force=text).for_body(SMALL).force == pytest.approx(value)


@pytest.mark.parametrize(
    ("name", "text", "problem"),
    [
        ("force", "1 leg", "leg is no unit of it; allowed: a number 0 to 1000, in N, or in weight"),
        ("force", "1 legs", "no unit 'legs'; known: 1, rad, kg"),
        ("force", "1 kg m s", "kg m s is no unit of it"),
        ("force", "70", "'force' is '70'; allowed"),
        ("force", "1/0 weight", "'force' is '1/0 weight'; allowed"),
        ("force", "2 weight", "'force' is '2 weight' = 1687 N; allowed: a number 0 to 1000$"),
        ("time", "1 weight", "allowed: a number 0 to 10, in s$"),
    ],
)
def test_a_text_that_means_no_such_number_is_refused(name, text, problem):
    with pytest.raises(SceneError, match=problem):
        Foot.from_table({name: text}, "[foot]", SceneError)


def test_a_share_that_a_body_makes_too_large_is_refused():
    tall = BodyScale(mass=86.0, leg=1.2, sole=0.3, sole_width=0.15)
    with pytest.raises(InputError, match=r"'depth' is '0.3333 leg' = 0.4 m; allowed: a number 0 to 0.3"):
        Foot().for_body(tall)


def test_settings_inside_settings_are_of_the_same_body():
    class Leg(Settings):
        """A leg.

        Attributes:
            foot: Its foot; no setting.
        """

        foot: Foot = Foot()

    assert Leg().for_body(SMALL).foot == Foot().for_body(SMALL)


def test_a_list_of_settings_says_share_and_number():
    told = {s.name: s for s in Foot.described(SMALL)}
    assert told["force"][1:4] == ("2.943", "N", "a number 0 to 1000")
    assert (told["force"].share, told["time"].share) == ("0.1 weight", "")
    assert told["rate"].unit == "rad/s/N/m"


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, lambda s: pickle.loads(pickle.dumps(s))])
def test_a_copy_keeps_body_and_shares(again):
    foot = again(Foot().for_body(SMALL))
    assert foot.body == SMALL
    assert foot.for_body(REFERENCE_BODY) == Foot()


@given(st.floats(0.1, 3.0), st.sampled_from(BODY_UNITS))
def test_units_scale_as_bodies_of_one_shape_do(s, unit):
    big = BodyScale(SMALL.mass * s**3, SMALL.leg * s, SMALL.sole * s, SMALL.sole_width * s)
    power = {"mass": 3.0, "weight": 3.0, "beat": 0.5, "pace": 0.5}.get(unit, 1.0)
    assert big.in_si(unit) == pytest.approx(SMALL.in_si(unit) * s**power)
    assert Quantity(1.0, unit).is_a(si_unit(unit))


@pytest.mark.parametrize("mass", [0.0, -1.0, math.nan, math.inf])
def test_a_body_has_a_size(mass):
    with pytest.raises(InputError, match="mass of a body is"):
        BodyScale(mass, 0.6, 0.2, 0.1)
