"""How high a leg stands for its knee, and how far it reaches from there."""

import math

import pytest

from plantar.gait.contact.standing_leg import StandingLeg

# Of H1's size: thigh and shank of 0.3 m, crouched by 30 mm, with the weight at the knee's limit 0.16 m from it.
LEG = StandingLeg(0.3, 0.3, 0.534, 0.03, 0.0, 1.0, 0.16, 0.12, 0.075, (0.0, 0.075, 0.0))


def knee_lever(leg: StandingLeg, place: float, rise: float) -> float:
    """Of the weight about the knee of a leg whose hip is above a place, by the two circles that meet in the knee."""
    apart = leg.apart + rise
    along, up = (place - leg.ankle) / apart, 1.0
    # The model turns hip, knee and ankle's triangle by its horizontal shear, as for small angles.
    foot = (apart**2 + leg.shank**2 - leg.thigh**2) / (2.0 * apart)
    knee = leg.ankle + along * foot + leg.ahead * up * math.sqrt(leg.shank**2 - foot**2)
    return abs(place - knee)


@pytest.mark.parametrize("place", [-0.08, -0.05, 0.0, 0.1])
@pytest.mark.parametrize("rise", [0.0, 0.02])
def test_at_the_edge_of_the_strip_the_knee_is_at_its_limit(place, rise):
    middle, half = LEG.strip(rise)
    edge = middle - half
    assert knee_lever(LEG, edge, rise) == pytest.approx(LEG.lever)
    assert (knee_lever(LEG, place, rise) <= LEG.lever) == (abs(place - middle) <= half)


def test_it_rises_as_little_as_the_knee_needs():
    assert LEG.rise_for(0.0, 0.95) == 0.0
    rise = LEG.rise_for(-0.055, 0.95)
    assert 0.0 < rise < LEG.rise
    assert knee_lever(LEG, -0.055, rise) == pytest.approx(0.95 * LEG.lever, abs=1e-4)
    assert LEG.rise_for(-0.055, 0.9) > rise


def test_it_rises_no_more_than_it_has_crouched():
    assert LEG.rise_for(-0.2, 0.95) == pytest.approx(LEG.rise, abs=1e-5)


@pytest.mark.parametrize(("aside", "rise"), [(0.0, 0.0), (0.05, 0.01), (0.17, 0.03)])
def test_a_leg_that_reaches_as_far_as_it_can_is_almost_straight(aside, rise):
    far = LEG.spread(aside, rise)
    long = math.hypot(far, LEG.apart + rise, max(aside - LEG.aside, 0.0))
    assert 2.0 * math.degrees(math.acos(long / 0.6)) == pytest.approx(19.9, abs=0.1)


def test_a_leg_that_is_too_high_reaches_nowhere():
    assert LEG.spread(0.0, 0.1) == 0.0


def test_a_knee_with_torque_to_spare_lets_the_leg_come_down_to_its_limit():
    low = LEG.lowest_for(0.0, 1.0)
    assert low < 0.0
    assert knee_lever(LEG, 0.0, low) == pytest.approx(LEG.lever, abs=1e-4)
    assert LEG.lowest_for(0.0, 0.9) > low
    assert LEG.lowest_for(-0.055, 1.0) > low  # a heel leaves it less


@pytest.mark.parametrize("away", [0.0, 0.15, 0.3])
def test_a_hip_is_as_high_as_a_leg_reaches(away):
    tallest = LEG.tallest(away) - LEG.high
    assert 2.0 * math.degrees(math.acos(math.hypot(away, tallest) / 0.6)) == pytest.approx(19.9, abs=0.1)
    assert LEG.tallest(0.7) == LEG.high
