"""Tests of what holds a shoe, by hand."""

from dataclasses import replace

import numpy as np
import pytest

from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.pull_off import clip_force, pull_off

P = ShoeParameters()


def test_a_clip_holds_as_a_cantilever_with_a_slope_of_45_degrees():
    bend = 3.0 * 1700.0 * (14.0 * 2.5**3 / 12.0) * 1.5 / 20.0**3
    assert clip_force(20.0, P) == pytest.approx(bend * 1.3 / 0.7)
    assert clip_force(40.0, P) == pytest.approx(clip_force(20.0, P) / 8.0)
    assert clip_force(20.0, replace(P, material="PLA")) == pytest.approx(clip_force(20.0, P) * 3000.0 / 1700.0)


def test_the_force_of_a_clip_is_that_of_a_beam_of_elements_and_of_forces_on_its_slope():
    """Another way: stiffness of 20 beam elements, then a body on a slope that slides, as a system of two equations."""
    arm, count = 24.0, 20
    size, stiffness = arm / count, 1700.0 * P.clip_width * P.clip_thickness**3 / 12.0
    a, b = 6.0 * size, size**2
    element = np.array([[12, a, -12, a], [a, 4 * b, -a, 2 * b], [-12, -a, 12, -a], [a, 2 * b, -a, 4 * b]])
    whole = np.zeros((2 * count + 2, 2 * count + 2))
    for i in range(count):
        whole[2 * i : 2 * i + 4, 2 * i : 2 * i + 4] += stiffness / size**3 * element
    bend = np.linalg.inv(whole[2:, 2:])[-2, -2]  # way of the tip by a unit force, the root held
    side, along = 0.5**0.5, 0.5**0.5  # of the face: its normal's part across the arm and along it
    # normal force n and friction 0.3 n: across the arm they bend it by the hook's reach, along it they are the pull
    n = P.clip_hook / bend / (side - 0.3 * along)
    assert clip_force(arm, P) == pytest.approx(n * (along + 0.3 * side), rel=1e-6)


def test_forces_add_up_and_moments_turn_about_the_heel():
    held = pull_off("clips", ((-40.0, 20.0), (60.0, 20.0)), 14.0, -100.0, 0.4, 60.0, P)
    each = clip_force(20.0, P)
    assert held.force == pytest.approx(2.0 * each, abs=1e-3)
    assert held.snap == pytest.approx(each, abs=1e-3)
    assert held.moment == pytest.approx(1e-3 * each * (60.0 + 160.0), abs=1e-3)
    assert held.swing == pytest.approx(5.0 * 9.81 * 0.4, rel=1e-3)
    assert held.scuff == pytest.approx(1e-3 * 0.03 * 60.0 * 9.81 * (P.thickness + 4.0), rel=1e-2)


def test_two_straps_hold_more_than_four_long_clips():
    places = tuple((x, 45.0) for x in (-50.0, -50.0, 60.0, 60.0))
    straps = pull_off("straps", places, 20.0, -100.0, 0.4, 60.0, P)
    clips = pull_off("clips", places, 14.0, -100.0, 0.4, 60.0, P)
    assert straps.force == pytest.approx(2.0 * 2.0 * 0.5**0.5 * 0.07 * 20.0 * 50.0, rel=1e-3)
    assert clips.force < clips.swing < straps.force
    assert straps.snap == 0.0
