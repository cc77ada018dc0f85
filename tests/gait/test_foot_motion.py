"""Footholds, swing and landing against made-up loads."""

from __future__ import annotations

import numpy as np
import pytest

from gait.command_frame import CommandFrame
from gait.compliance_gains import ComplianceGains
from gait.foot_motion import FootMotion, Landing, SoleSense
from gait.footsteps import straight_plan
from gait.phases import Timing, WalkSchedule
from gait.swing_compliance import SwingCompliance
from plantar import Percept, Reading, hex_layout
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


@pytest.mark.parametrize(
    ("height", "spike", "landed"),
    [(0.004, 35.0, False), (0.004, 90.0, True), (0.001, 35.0, True), (0.02, 60.0, False)],
    ids=["noise above the ground", "met something", "a touch", "noise high up"],
)
def test_a_small_load_is_a_touch_only_where_the_ground_is_seen(height: float, spike: float, landed: bool) -> None:
    """The taxels of a sole that comes down add up to a few newtons of noise, and now and then to a touch's load."""
    layout = hex_layout([[-0.1, -0.07], [0.1, -0.07], [0.1, 0.07], [-0.1, 0.07]])
    feet, steps = straight_plan(2)
    schedule = WalkSchedule(steps, Timing())
    compliance = {side: SwingCompliance(layout, ComplianceGains()) for side in feet}
    motion = FootMotion(feet, schedule, PERIOD, 0.05, LANDING, compliance)
    frame = CommandFrame(feet["left"].position, PERIOD, 0.3)
    force = np.zeros(len(layout))
    spikes = 0
    for k in range(round(2.2 / PERIOD)):
        time = k * PERIOD
        senses = {}
        for side in feet:
            position, _ = motion.footholds[side]
            seen = np.full(len(layout), max(0.0, float(position[2])))
            percept = Percept(layout, Reading(time=time, force=force, proximity=seen))
            senses[side] = SoleSense(percept, position, np.eye(3))
        down = motion.comes_down and motion.footholds["left"][0][2] < height
        spikes += down
        load = spike if down and spikes <= 2 else 0.0
        motion.update(schedule.at(time), time, {"left": load, "right": 800.0}, frame, senses)
        if spikes == 3:
            break
    assert spikes == 3
    assert motion.landed == landed


def test_a_foot_that_met_something_rises_first_in_its_next_step() -> None:
    """What a foot refused stands beside it when it goes on; a swing that moved at once would hit it."""
    feet, steps = straight_plan(3)
    schedule = WalkSchedule(steps, Timing())
    motion = FootMotion(feet, schedule, PERIOD, 0.05, Landing(approach_height=0.015))
    frame = CommandFrame(feet["left"].position, PERIOD, 0.3)
    ahead: dict[int, list[float]] = {0: [], 1: [], 2: []}
    for k in range(round(schedule.end / PERIOD)):
        time = k * PERIOD
        phase = schedule.at(time)
        began = motion.update(phase, time, {"left": 400.0, "right": 400.0}, frame)
        if began and phase.step == 0:
            motion.retake(time, phase.end - time, frame)
        if phase.swing is not None and time - phase.start < 0.13 * (phase.end - phase.start):
            ahead[phase.step].append(float(motion.ahead[0]))
    assert np.ptp(ahead[2]) == 0.0
    assert np.ptp(ahead[1]) > 0.005
