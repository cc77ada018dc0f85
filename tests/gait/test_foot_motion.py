"""Footholds, swing and landing against made-up loads."""

from __future__ import annotations

import numpy as np
import pytest

from gait.command_frame import CommandFrame
from gait.foot_motion import FootMotion, Landing
from gait.footsteps import straight_plan
from gait.phases import Timing, WalkSchedule
from plantar.layout import Side

PERIOD = 0.005
LANDING = Landing()


def walked(ground: float, until: float) -> tuple[FootMotion, list[tuple[float, float]]]:
    """The first step over ground at a height; the foot feels a stiff spring. Times and commanded sole heights."""
    feet, steps = straight_plan(2)
    schedule = WalkSchedule(steps, Timing())
    motion = FootMotion(feet, schedule, PERIOD, 0.05, LANDING)
    frame = CommandFrame(feet["left"].position, PERIOD, 0.3)
    track = []
    for k in range(round(until / PERIOD)):
        time = k * PERIOD
        depth = ground - motion.footholds["left"][0][2]
        loads: dict[Side, float] = {"left": max(0.0, 2e5 * depth), "right": 800.0}
        motion.update(schedule.at(time), time, loads, frame)
        track.append((time, float(motion.footholds["left"][0][2])))
    return motion, track


def test_on_the_expected_ground_the_foot_lands_where_and_when_it_is_planned() -> None:
    motion, track = walked(0.0, 2.3)
    assert motion.footholds["left"][0][:2] == pytest.approx([0.2, 0.085])
    assert max(z for _, z in track) == pytest.approx(0.05, abs=1e-3)
    assert motion.landed


def test_an_early_contact_stops_the_swing() -> None:
    motion, track = walked(0.02, 2.1)
    landed = [(t, z) for t, z in track if t > 1.2 + 0.6]
    assert motion.landed
    assert min(z for _, z in landed) > 0.02 - 0.002  # not pushed into the obstacle


def test_a_late_contact_is_reached_slowly() -> None:
    _, track = walked(-0.008, 2.395)
    heights = np.array([z for t, z in track if t >= 2.1])
    assert heights[-1] < -0.006
    assert np.diff(heights).min() >= -LANDING.speed * PERIOD - 1e-12


def test_no_ground_is_not_followed_for_ever() -> None:
    _, track = walked(-1.0, 3.2)
    assert min(z for _, z in track) > -LANDING.reach - 2e-3


def test_a_standing_foot_stays_where_it_is() -> None:
    motion, _ = walked(0.0, 2.3)
    position, yaw = motion.footholds["right"]
    assert position.tolist() == [0.0, -0.085, 0.0]
    assert yaw == 0.0
