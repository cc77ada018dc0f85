"""Tests of what holds a shoe, by hand."""

from __future__ import annotations

from dataclasses import replace

import pytest

from shoes.parameters import ShoeParameters
from shoes.plan.pull_off import clip_force, needed_force, pull_off

P = ShoeParameters()


def test_a_clip_holds_as_a_cantilever_with_a_slope_of_45_degrees() -> None:
    bend = 3.0 * 1700.0 * (14.0 * 2.5**3 / 12.0) * 1.5 / 20.0**3
    assert clip_force(20.0, P) == pytest.approx(bend * 1.3 / 0.7)
    assert clip_force(40.0, P) == pytest.approx(clip_force(20.0, P) / 8.0)
    assert clip_force(20.0, replace(P, material="PLA")) == pytest.approx(clip_force(20.0, P) * 3000.0 / 1700.0)


def test_forces_add_up_and_moments_turn_about_the_heel() -> None:
    held = pull_off("clips", ((-40.0, 20.0), (60.0, 20.0)), 14.0, -100.0, 0.4, 60.0, P)
    each = clip_force(20.0, P)
    assert held.force == pytest.approx(2.0 * each, abs=1e-3)
    assert held.moment == pytest.approx(1e-3 * each * (60.0 + 160.0), abs=1e-3)
    assert held.swing == pytest.approx(5.0 * 9.81 * 0.4, rel=1e-3) == pytest.approx(needed_force(0.4), rel=1e-3)
    assert held.scuff == pytest.approx(1e-3 * 0.03 * 60.0 * 9.81 * (P.thickness + 4.0), rel=1e-2)


def test_two_straps_hold_more_than_four_long_clips() -> None:
    places = tuple((x, 45.0) for x in (-50.0, -50.0, 60.0, 60.0))
    straps = pull_off("straps", places, 20.0, -100.0, 0.4, 60.0, P)
    clips = pull_off("clips", places, 14.0, -100.0, 0.4, 60.0, P)
    assert straps.force == pytest.approx(2.0 * 2.0 * 0.5**0.5 * 0.07 * 20.0 * 50.0, rel=1e-3)
    assert clips.force < clips.swing < straps.force
