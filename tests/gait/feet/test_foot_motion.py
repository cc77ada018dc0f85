"""Footholds, swing and landing against made-up loads."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from plantar import Percept, Reading, hex_layout
from plantar.gait.contact.ground_map import GroundMap, GroundMapSettings
from plantar.gait.feet.compliance_gains import ComplianceGains, TouchdownGains
from plantar.gait.feet.foot_motion import FootMotion, SoleSense
from plantar.gait.feet.landing import Landing
from plantar.gait.feet.swing_compliance import SwingCompliance
from plantar.gait.feet.swing_fit import SwingFitRules
from plantar.gait.plan.footsteps import Footstep, straight_plan
from plantar.gait.plan.phases import Phase, PhaseKind, Timing, WalkSchedule
from plantar.kernels.gait.command_frame import CommandFrame
from plantar.layouts.layout import Side

PERIOD = 0.005
LANDING = Landing()


def taken(steps: Sequence[Footstep], phase: Phase) -> Footstep | None:
    return steps[phase.step] if phase.swing is not None else None


def walked(ground, until, fit=None, climb=0.0):
    """The first step over ground at a height; the foot feels a stiff spring. Times and commanded sole heights."""
    feet, steps = straight_plan(2, climb=climb)
    schedule = WalkSchedule.of([step.side for step in steps], Timing())
    motion = FootMotion(feet, PERIOD, 0.05, LANDING, swing=fit)
    frame = CommandFrame(feet["left"].position, PERIOD, 0.3)
    track = []
    for k in range(round(until / PERIOD)):
        time = k * PERIOD
        depth = ground - motion.footholds["left"][0][2]
        loads: dict[Side, float] = {"left": max(0.0, 2e5 * depth), "right": 800.0}
        motion.update(schedule.at(time), time, taken(steps, schedule.at(time)), loads, frame)
        track.append((time, float(motion.footholds["left"][0][2])))
    return motion, track


def test_on_the_expected_ground_the_foot_lands_where_and_when_it_is_planned():
    motion, track = walked(0.0, 2.3)
    assert motion.footholds["left"][0][:2] == pytest.approx([0.2, 0.085])
    assert max(z for _, z in track) == pytest.approx(0.05, abs=1e-3)
    assert motion.landed


def test_a_fitted_swing_gets_there_too_rising_once_and_falling_once():
    motion, track = walked(0.0, 2.3, SwingFitRules())
    # It has landed a tick before the end, when the sole met the ground.
    assert motion.footholds["left"][0][:2] == pytest.approx([0.2, 0.085], abs=1e-4)
    heights = np.array([z for _, z in track])
    top = int(heights.argmax())
    assert 0.05 <= heights[top] < 0.07
    assert (np.diff(heights[: top + 1]) >= 0.0).all()
    assert (np.diff(heights[top:]) <= 0.0).all()
    assert motion.landed


def test_a_fitted_swing_follows_a_plan_that_changes_without_a_jump():
    feet, steps = straight_plan(2)
    schedule = WalkSchedule.of([step.side for step in steps], Timing())
    motion = FootMotion(feet, PERIOD, 0.05, LANDING, swing=SwingFitRules())
    frame, loads = CommandFrame(feet["left"].position, PERIOD, 0.3), {"left": 0.0, "right": 800.0}
    phase = schedule.phases[2]
    places = []
    for k in range(round((phase.end - phase.start) / PERIOD)):
        time, target = phase.start + k * PERIOD, steps[0] if k < 80 else replace(steps[0], y=steps[0].y + 0.05)
        motion.update(phase, time, target, loads, frame)
        motion.aim(phase, time, target, frame)
        places.append(motion.footholds["left"][0])
    assert places[-1][1] == pytest.approx(steps[0].y + 0.05, abs=1e-3)
    fastest = float(np.abs(np.diff(places, axis=0)).max()) / PERIOD
    assert fastest < 2.5 * 0.2 / (phase.end - phase.start)  # a minimum-jerk motion over the step's length has 1.9


@pytest.mark.parametrize("climb", [0.05, -0.05])
def test_a_step_that_is_planned_higher_or_lower_is_swung_there(climb):
    motion, track = walked(climb, 2.3, climb=climb)
    assert max(z for _, z in track) == pytest.approx(max(0.0, climb) + 0.05, abs=1e-3)
    assert motion.footholds["left"][0][2] == pytest.approx(climb, abs=2e-3)
    assert motion.surprise == pytest.approx(0.0, abs=2e-3)


def test_an_early_contact_stops_the_swing():
    motion, track = walked(0.02, 2.1)
    landed = [(t, z) for t, z in track if t > 1.2 + 0.6]
    assert motion.landed
    assert min(z for _, z in landed) > 0.02 - 0.002  # not pushed into the obstacle


def test_a_late_contact_is_reached_slowly():
    _, track = walked(-0.008, 2.395)
    heights = np.array([z for t, z in track if t >= 2.1])
    assert heights[-1] < -0.006
    assert np.diff(heights).min() >= -LANDING.speed * PERIOD - 1e-12


@pytest.mark.parametrize(("relax_time", "stays"), [(0.0, True), (0.2, False)])
def test_what_a_foot_was_pressed_too_far_is_given_back_when_the_robot_stands(relax_time, stays):
    feet, steps = straight_plan(1)
    timing = Timing()
    schedule = WalkSchedule.of([step.side for step in steps], timing)
    motion = FootMotion(feet, PERIOD, 0.05, replace(LANDING, relax_time=relax_time))
    frame = CommandFrame(feet["left"].position, PERIOD, 0.3)
    loads: dict[Side, float] = {"left": 0.0, "right": 800.0}
    heights: dict[Side, float] = {"left": 1.001, "right": 1.0}
    walking = timing.start + timing.single_support + timing.end
    pressed = 0.0
    for k in range(round((walking + 2.0) / PERIOD)):
        time = k * PERIOD
        phase = schedule.at(time)
        motion.update(phase, time, taken(steps, phase), loads, frame, heights=heights)
        if phase.kind != PhaseKind.STANDING:
            pressed = motion.footholds["left"][0][2]
        else:
            loads = {"left": 400.0, "right": 400.0}
    assert pressed < -0.01
    assert motion.footholds["left"][0][2] == pytest.approx(pressed if stays else 0.001, abs=1e-3)


def test_the_next_ground_is_expected_where_the_last_was_as_far_as_it_is_trusted():
    for trust in (0.0, 0.3, 1.0):
        feet, steps = straight_plan(2)
        schedule = WalkSchedule.of([step.side for step in steps], Timing())
        motion = FootMotion(feet, PERIOD, 0.05, replace(LANDING, ground_share=trust))
        frame = CommandFrame(feet["left"].position, PERIOD, 0.3)
        lowest = 1.0
        for k in range(round(3.3 / PERIOD)):
            phase = schedule.at(k * PERIOD)
            depth = 0.02 - motion.footholds["left"][0][2]
            load = max(0.0, 2e5 * depth) if phase.step == 0 else 800.0
            motion.update(phase, k * PERIOD, taken(steps, phase), {"left": load, "right": 0.0}, frame)
            if phase.step == 1 and phase.swing == "right" and phase.end - k * PERIOD < 2.0 * PERIOD:
                lowest = min(lowest, float(motion.footholds["right"][0][2]))
        assert lowest == pytest.approx(trust * motion.footholds["left"][0][2], abs=2e-3)


def test_no_ground_is_not_followed_for_ever():
    _, track = walked(-1.0, 3.2)
    assert min(z for _, z in track) > -LANDING.reach - 2e-3


def test_a_standing_foot_stays_where_it_is():
    motion, _ = walked(0.0, 2.3)
    position, yaw = motion.footholds["right"]
    assert position.tolist() == [0.0, -0.085, 0.0]
    assert yaw == 0.0


@pytest.mark.parametrize(
    ("height", "spike", "landed"),
    [(0.004, 35.0, False), (0.004, 90.0, True), (0.001, 35.0, True), (0.02, 60.0, False)],
    ids=["noise above the ground", "met something", "a touch", "noise high up"],
)
def test_a_small_load_is_a_touch_only_where_the_ground_is_seen(height, spike, landed):
    """The taxels of a sole that comes down add up to a few newtons of noise, and now and then to a touch's load."""
    layout = hex_layout([[-0.1, -0.07], [0.1, -0.07], [0.1, 0.07], [-0.1, 0.07]])
    feet, steps = straight_plan(2)
    schedule = WalkSchedule.of([step.side for step in steps], Timing())
    compliance = {
        side: SwingCompliance(layout, ComplianceGains(), TouchdownGains(), GroundMapSettings(), 0.3) for side in feet
    }
    motion = FootMotion(feet, PERIOD, 0.05, LANDING, compliance)
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
            senses[side] = SoleSense(percept, position, np.eye(3), time)
        down = motion.comes_down and motion.footholds["left"][0][2] < height
        spikes += down
        load = spike if down and spikes <= 2 else 0.0
        phase = schedule.at(time)
        motion.update(phase, time, taken(steps, phase), {"left": load, "right": 800.0}, frame, senses)
        if spikes == 3:
            break
    assert spikes == 3
    assert motion.landed == landed


def test_a_foot_that_met_something_rises_first_in_its_next_step():
    """What a foot refused stands beside it when it goes on; a swing that moved at once would hit it."""
    feet, steps = straight_plan(3)
    schedule = WalkSchedule.of([step.side for step in steps], Timing())
    motion = FootMotion(feet, PERIOD, 0.05, Landing(approach_height=0.015))
    frame = CommandFrame(feet["left"].position, PERIOD, 0.3)
    ahead: dict[int, list[float]] = {0: [], 1: [], 2: []}
    for k in range(round(schedule.end / PERIOD)):
        time = k * PERIOD
        phase = schedule.at(time)
        motion.update(phase, time, taken(steps, phase), {"left": 400.0, "right": 400.0}, frame)
        if motion.view.touchdown and steps[0].x != 0.1:
            steps = (replace(steps[0], x=0.1), *steps[1:])
            schedule = schedule.delayed(phase, 1.0)
            motion.aim(schedule.at(time), time, steps[0], frame)
            assert not motion.landed
        if phase.swing is not None and time - phase.start < 0.13 * (phase.end - phase.start):
            ahead[phase.step].append(float(motion.ahead[0]))
    assert np.ptp(ahead[2]) == 0.0
    assert np.ptp(ahead[1]) > 0.005


@pytest.mark.parametrize(("place", "later"), [((0.3, 0.12), 0.0), ((0.1, 0.05), -0.2), ((0.2, 0.085), 0.5)])
def test_a_swing_is_aimed_anew_in_flight_without_a_jump(place, later):
    feet, steps = straight_plan(2)
    schedule = WalkSchedule.of([step.side for step in steps], Timing())
    motion = FootMotion(feet, PERIOD, 0.05, LANDING)
    frame = CommandFrame(feet["left"].position, PERIOD, 0.3)
    target, aimed, track = steps[0], False, []
    while not (track and schedule.at(len(track) * PERIOD).step == 1):
        time = len(track) * PERIOD
        phase = schedule.at(time)
        if not aimed and time > 1.2 + 0.4:
            aimed = True
            target = replace(target, x=place[0], y=place[1], yaw=0.2)
            schedule = schedule.delayed(phase, later)
            motion.aim(schedule.at(time), time, target, frame)
        motion.update(schedule.at(time), time, target, {"left": 0.0, "right": 800.0}, frame)
        position, yaw = motion.footholds["left"]
        track.append([*position, yaw])
    way = np.array(track)
    assert way[-1, :2] == pytest.approx(place, abs=1e-6)
    assert way[-1, 3] == pytest.approx(0.2, abs=1e-6)
    assert len(track) * PERIOD == pytest.approx(1.2 + 0.9 + later, abs=2 * PERIOD)
    assert np.abs(np.diff(way, axis=0)).max() < 2.0 * PERIOD  # m/s
    lifted = way[round(1.25 / PERIOD) :]
    assert np.abs(np.diff(lifted, 2, axis=0))[:, [0, 1, 3]].max() < 40.0 * PERIOD**2  # m/s^2


def test_a_foot_that_has_landed_waits_where_it_is_when_its_phase_is_made_longer():
    motion, _ = walked(0.0, 2.05)
    feet, steps = straight_plan(2)
    frame = CommandFrame(feet["left"].position, PERIOD, 0.3)
    schedule = WalkSchedule.of([step.side for step in steps], Timing())
    motion.landed, before = True, motion.footholds["left"][0].copy()
    longer = schedule.delayed(schedule.at(2.05), 0.5)
    motion.aim(longer.at(2.05), 2.05, steps[0], frame)
    assert motion.landed
    assert motion.footholds["left"][0].tolist() == before.tolist()


def test_a_foot_in_the_air_rises_again_before_it_leaves_what_it_sees_next_to_it():
    motion, _ = walked(0.0, 1.9)
    feet, steps = straight_plan(2)
    frame = CommandFrame(feet["left"].position, PERIOD, 0.3)
    schedule = WalkSchedule.of([step.side for step in steps], Timing())
    schedule = schedule.delayed(schedule.at(1.9), 1.4)
    target = replace(steps[0], x=steps[0].x - 0.1)
    assert not motion.landed
    low = motion.footholds["left"][0].copy()
    motion.aim(schedule.at(1.9), 1.9, target, frame, lifts=True)
    way = []
    for k in range(1, 290):
        time = 1.9 + k * PERIOD
        motion.update(schedule.at(time), time, target, {"left": 0.0, "right": 800.0}, frame)
        way.append(motion.footholds["left"][0].copy())
    path = np.array(way)
    highest = int(path[:, 2].argmax())
    assert path[highest, 2] > low[2] + 0.02
    assert abs(path[: highest // 2, 0] - low[0]).max() < 0.02  # up first
    assert path[-1, 0] == pytest.approx(target.x, abs=0.005)


def test_a_foot_that_sees_the_ground_presses_as_it_is_told():
    """The force is an argument of each tick: nobody can leave one behind for another to meet."""
    layout = hex_layout([[-0.1, -0.07], [0.1, -0.07], [0.1, 0.07], [-0.1, 0.07]])
    feet, steps = straight_plan(2)
    schedule = WalkSchedule.of([step.side for step in steps], Timing())
    frame = CommandFrame(feet["left"].position, PERIOD, 0.3)
    held = {}
    for press in (None, 80.0, 130.0):
        compliance = {
            side: SwingCompliance(layout, ComplianceGains(), TouchdownGains(), GroundMapSettings(), 0.3)
            for side in feet
        }
        motion = FootMotion(feet, PERIOD, 0.05, LANDING, compliance)
        carried = []
        longer = schedule.delayed(schedule.phases[2], 6.0, wait=6.0)
        for k in range(round(8.0 / PERIOD)):
            time = k * PERIOD
            phase = longer.at(time)
            load = max(0.0, -2e4 * float(motion.footholds["left"][0][2]))
            senses = {}
            for side in feet:
                seen = np.full(len(layout), max(0.0, float(motion.footholds[side][0][2])))
                percept = Percept(layout, Reading(time=time, force=np.zeros(len(layout)), proximity=seen))
                senses[side] = SoleSense(percept, motion.footholds[side][0], np.eye(3), time)
            carried.append(load)
            loads = {"left": load, "right": 800.0}
            motion.update(phase, time, taken(steps, phase), loads, frame, senses, press)
        held[press] = float(np.mean(carried[-200:]))
    assert held[None] == pytest.approx(TouchdownGains().hold_force, rel=0.1)
    assert held[80.0] == pytest.approx(80.0, rel=0.1)
    assert held[130.0] == pytest.approx(130.0, rel=0.1)


def seeing(ground, tilt=0.0, rise=0.0, until=3.28, block=None):
    """Motion and heights of a seeing right foot over `ground`, where the left sole tilts and stands higher; `block`:
    its height, under the foremost fifth of the right sole.
    """
    layout = hex_layout([[-0.1, -0.07], [0.1, -0.07], [0.1, 0.07], [-0.1, 0.07]])
    feet, steps = straight_plan(3)
    schedule = WalkSchedule.of([step.side for step in steps], Timing())
    compliance = {
        s: SwingCompliance(layout, ComplianceGains(), TouchdownGains(), GroundMapSettings(), 0.3) for s in feet
    }
    motion = FootMotion(feet, PERIOD, 0.05, LANDING, compliance)
    frame = CommandFrame(feet["left"].position, PERIOD, 0.3)
    heights = []
    for k in range(round(until / PERIOD)):
        time = k * PERIOD
        phase = schedule.at(time)
        if phase.step == 1 and phase.swing == "right" and not heights:
            motion.turn_standing("left", np.array([0.0, -tilt]), np.zeros(2))
            place, yaw = motion.footholds["left"]
            motion.stand_at("left", place + np.array([0.0, 0.0, rise]), yaw)
        senses = {}
        for side in feet:
            position, _ = motion.footholds[side]
            above = math.inf if ground is None else max(0.0, float(position[2]) - ground)
            seen = None if ground is None else np.full(len(layout), above if above < 0.05 else np.inf)
            if block is not None and side == "right":
                over = np.where(layout.positions[:, 0] > 0.06, above - block, above)
                seen = np.where(over < 0.05, np.maximum(over, 0.0), np.inf)
            percept = Percept(layout, Reading(time=time, force=np.zeros(len(layout)), proximity=seen))
            senses[side] = SoleSense(percept, position, np.eye(3), time)
        loads = {"left": 800.0 if phase.swing != "left" else 0.0, "right": 800.0 if phase.swing != "right" else 0.0}
        motion.update(phase, time, taken(steps, phase), loads, frame, senses)
        if phase.step == 1 and phase.swing == "right":
            heights.append(float(motion.footholds["right"][0][2]))
    return motion, np.array(heights)


@pytest.mark.parametrize(
    ("tilt", "rise", "slope", "expected"),
    [
        (0.1, 0.02, 0.1, 0.04),
        (0.1, 0.01, 0.05, 0.02),
        (0.05, 0.02, 0.05, 0.02),
        (-0.1, -0.02, -0.1, -0.04),
        (0.1, -0.02, 0.0, -0.006),
    ],
    ids=["both", "less risen", "less tilted", "down", "differ"],
)
def test_ground_slopes_on_as_far_as_sole_and_step_agree(tilt, rise, slope, expected):
    motion, _ = seeing(0.0, tilt, rise, until=2.45)
    # From the standing foot on as much as the slope explains its step, by `ground_share` otherwise.
    assert motion.comes_to == pytest.approx(expected, abs=3e-3)  # a landed foot is pressed down
    motion, _ = seeing(None, tilt, rise, until=2.9)
    x, y, z = motion.rotation("right")[:, 0]
    assert (y, z / x) == pytest.approx((0.0, slope), abs=3e-3)


def test_a_foot_that_sees_no_ground_at_its_place_goes_down_to_look():
    (_, low), (_, level), (_, missing) = seeing(-0.08), seeing(0.0), seeing(None)
    assert level.min() == pytest.approx(-LANDING.depth, abs=2e-3)
    assert low[-1] < level.min() - 0.01
    assert missing.min() > level.min() - 0.002  # a sole that is missing shows nothing


@pytest.mark.parametrize("block", [0.0, 0.012, 0.03])
def test_what_lies_under_a_rim_alone_is_higher_ground(block):
    motion, _ = seeing(0.0, until=3.1, block=block)
    assert motion.surprise == pytest.approx(block, abs=5e-3)  # less than half of what is seen under the middle


def test_late_encoders_and_late_proximity_agree_on_the_ground():
    # A sole that comes down at 0.3 m/s, all that it measures 10 ms late.
    layout = hex_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]])
    ground = GroundMap(layout, GroundMapSettings())
    ground.begin()
    for k in range(12):
        sampled = k * PERIOD - 0.01
        height = 0.045 - 0.3 * sampled
        seen = Reading(time=sampled, force=np.zeros(len(layout)), proximity=np.full(len(layout), height))
        view = ground.update(Percept(layout, seen), np.array([0.0, 0.0, height]), np.eye(3), sampled)
        assert view is not None
        assert view.distance == pytest.approx(height, abs=1e-9)
