from dataclasses import FrozenInstanceError, replace

import numpy as np
import pytest

from plantar.common.sides import other_side
from plantar.errors import InputError
from plantar.gait.plan.footsteps import Footstep, straight_plan
from plantar.gait.plan.phases import PhaseKind, Timing
from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.plan.walk_plan import WalkPlan, vrp_of_step

OMEGA = 3.5
CENTER = {"left": np.array([0.025, 0.01]), "right": np.array([0.025, -0.01])}


def test_vrp_stands_over_the_stance_foot_and_the_plan_ends_between_the_feet():
    feet, steps = straight_plan(6, length=0.2)
    plan = WalkPlan(feet, steps, Timing(), CENTER, OMEGA, 1.0)
    schedule = plan.schedule
    standing = dict(feet)
    for phase in schedule.phases:
        if phase.kind == PhaseKind.SINGLE_SUPPORT:
            assert phase.stance is not None
            wanted = vrp_of_step(standing[phase.stance], CENTER[phase.stance])
            for time in (phase.start, 0.5 * (phase.start + phase.end), phase.end):
                assert np.allclose(plan.at(time).vrp, wanted, atol=1e-12)
            standing[steps[phase.step].side] = steps[phase.step]
    assert np.allclose(plan.end, [1.0 + 0.025, 0.0], atol=1e-12)
    assert np.allclose(plan.at(0.0).com, [0.025, 0.0], atol=1e-2)


def test_the_planned_com_stays_near_the_feet_for_any_number_of_steps():
    for count in (0, 1, 2, 300):
        feet, steps = straight_plan(count, length=0.2)
        plan = WalkPlan(feet, steps, Timing(), CENTER, OMEGA).vrps
        times = np.arange(plan.times[0], plan.times[-1], 0.05)
        lateral = np.array([plan.at(t).com[1] for t in times])
        assert np.abs(lateral).max() < 0.1


def test_turned_footsteps_turn_their_vrps():
    feet, _ = straight_plan(0, start=(1.0, 2.0, np.pi / 2))
    assert vrp_of_step(feet["left"], CENTER["left"]) == pytest.approx([1.0 - 0.085 - 0.01, 2.0 + 0.025])


def turned_by_a_foothold(step=3, shift=(0.06, 0.0), late=0.02):
    """A walk in the double support after a step, and what a foothold off its middle makes of it."""
    feet, steps = straight_plan(12, length=0.0, sideways=0.08)
    plan = WalkPlan(feet, steps, Timing(), CENTER, OMEGA, 1.0)
    phase = next(p for p in plan.schedule.phases if p.kind == PhaseKind.DOUBLE_SUPPORT and p.step == step + 1)
    time = phase.start + late
    before = plan.at(time)
    replan = moved(plan, step, shift, time, WIDE)
    return plan, time, before, replan


def moved(plan, step, by, time, region, later=(0.0, 0.0)):
    """Move the VRP over a step, and the later steps."""
    x, y = (plan.view.vrp(step) + by).tolist()
    return plan.apply(PlanChange("a test", step, vrp=(x, y), shift=later), time, region)


WIDE = np.array([[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]])


def test_a_moved_foothold_leaves_dcm_and_com_where_they_are():
    plan, time, before, replan = turned_by_a_foothold()
    after = plan.at(time)
    assert replan.moved == ()  # the foot stands where it was planned; its VRP has moved
    assert max(map(abs, replan.gap)) < 1e-12
    assert np.abs(after.dcm - before.dcm).max() < 1e-12
    assert np.abs(after.com - before.com).max() < 1e-12
    assert np.abs(after.com_velocity - before.com_velocity).max() < 1e-12
    assert np.abs(after.vrp - before.vrp).max() < 1e-12


def test_the_moved_plan_stands_on_the_foothold_and_satisfies_its_equations():
    plan, time, _, _ = turned_by_a_foothold()
    swing = next(p for p in plan.schedule.phases if p.kind == PhaseKind.SINGLE_SUPPORT and p.step == 4)
    for at in np.linspace(swing.start, swing.end, 5):
        assert np.abs(plan.at(float(at)).vrp - plan.view.vrp(3)).max() < 1e-12
    step = 1e-5
    knots = np.array(plan.vrps.times)
    for at in np.linspace(time, plan.vrps.times[-1] + 0.3, 101):
        now = plan.at(float(at))
        assert np.abs(now.dcm_velocity - OMEGA * (now.dcm - now.vrp)).max() < 1e-9
        if np.abs(knots - at).min() > 2 * step:
            slope = (plan.at(float(at) + step).dcm - plan.at(float(at) - step).dcm) / (2 * step)
            assert np.abs(slope - now.dcm_velocity).max() < 1e-6
    assert np.abs(plan.at(plan.vrps.times[-1]).dcm - plan.end).max() < 1e-12


def test_without_room_the_double_support_grows_or_the_rest_is_left_to_the_feedback():
    _, time, before, free = turned_by_a_foothold()
    assert free.delay == 0.0
    feet, steps = straight_plan(12, length=0.0, sideways=0.08)
    tight = WalkPlan(feet, steps, Timing(), CENTER, OMEGA, 1.0)
    narrow = np.array([[0.015, -2.0], [0.05, -2.0], [0.05, 2.0], [0.015, 2.0]])
    ending = tight.schedule.end
    replan = moved(tight, 3, (0.06, 0.0), time, narrow)
    assert replan.delay > 0.0
    assert tight.schedule.end == pytest.approx(ending + replan.delay)
    jump = before.dcm - tight.at(time).dcm
    assert jump == pytest.approx(replan.gap, abs=1e-12)
    bridge = [p for t, p in zip(tight.vrps.times, tight.vrps.vrps, strict=True) if time < t < time + 0.2]
    assert all(0.015 - 1e-9 <= p[0] <= 0.05 + 1e-9 for p in bridge)
    hopeless, beat = WalkPlan(feet, steps, Timing(), CENTER, OMEGA, 1.0), Timing().body.beat
    longest = moved(hopeless, 3, (0.6, 0.0), time, narrow)
    assert max(map(abs, longest.gap)) > 0.01
    assert 1.2 * beat < longest.delay < 1.5 * beat


def test_later_footholds_move_along():
    feet, steps = straight_plan(12, length=0.0, sideways=0.08)
    plan = WalkPlan(feet, steps, Timing(), CENTER, OMEGA, 1.0)
    phase = next(p for p in plan.schedule.phases if p.kind == PhaseKind.DOUBLE_SUPPORT and p.step == 4)
    old = [plan.view.vrp(k) for k in range(12)]
    end = plan.end
    moved(plan, 3, (0.0, 0.0), phase.start + 0.01, WIDE, (0.03, -0.01))
    for k in range(4, 12):
        assert plan.view.vrp(k) == pytest.approx(old[k] + [0.03, -0.01], abs=1e-12)
    assert plan.end == pytest.approx(end + np.array([0.03, -0.01]), abs=1e-12)
    for swing in (p for p in plan.schedule.phases if p.kind == PhaseKind.SINGLE_SUPPORT and p.step >= 5):
        assert plan.at(0.5 * (swing.start + swing.end)).vrp == pytest.approx(plan.view.vrp(swing.step - 1), abs=1e-9)


def test_a_thousand_steps_on_random_partial_footholds_stay_consistent():
    rng = np.random.default_rng(5)
    feet, steps = straight_plan(1000, length=0.2)
    plan = WalkPlan(feet, steps, Timing(), CENTER, OMEGA, 1.0)
    largest = 0.0
    for k in range(999):
        phase = plan.schedule.at(plan.schedule.phases[2 * k + 3].start + 0.02)
        assert (phase.kind, phase.step) == (PhaseKind.DOUBLE_SUPPORT, k + 1)
        before = plan.at(phase.start + 0.02)
        moved(plan, k, rng.uniform(-0.05, 0.05, 2).tolist(), phase.start + 0.02, np.empty((0, 2)))
        after = plan.at(phase.start + 0.02)
        largest = max(largest, float(np.abs(after.dcm - before.dcm).max()), float(np.abs(after.com - before.com).max()))
        assert np.isfinite(plan.vrps.dcm_waypoints).all()
    assert largest < 1e-9
    last = plan.at(plan.vrps.times[-1] + 20.0)
    assert last.com == pytest.approx(plan.end, abs=1e-9)
    assert np.abs(last.com - [999 * 0.2 + 0.025, 0.0]).max() < 0.12


def test_a_replan_costs_the_same_in_a_long_plan():
    # What a replan builds anew is a few stances, however many there are to come.
    feet, steps = straight_plan(1000, length=0.2)
    plan = WalkPlan(feet, steps, Timing(), CENTER, OMEGA, 1.0)
    offsets = plan.vrps._end_offset.copy()
    moved(plan, 3, (0.05, 0.0), plan.schedule.phases[9].start + 0.02, np.empty((0, 2)))
    kept = len(plan.vrps._end_offset) - 20
    assert (plan.vrps._end_offset[-kept:] == offsets[-kept:]).all()


@pytest.mark.parametrize("moves", [False, True])
def test_a_stance_that_is_held_longer_keeps_the_com_over_it(moves):
    """In mid swing the DCM stays over the stance foot, and leaves for the next foothold in time."""
    feet, steps = straight_plan(8, length=0.2)
    plan = WalkPlan(feet, steps, Timing(), CENTER, OMEGA, 1.0)
    schedule = plan.schedule
    swing = next(p for p in schedule.phases if p.step == 4 and p.swing is not None)
    time = swing.start + 0.45
    before = plan.at(time)
    stance = plan.at(swing.start + 0.01).vrp
    region = stance + 0.06 * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    x, y = (plan.view.vrp(4) + np.array([-0.1, 0.0])).tolist()
    later = (-0.1, 0.0) if moves else (0.0, 0.0)
    end = plan.end.copy()
    gap = plan.apply(PlanChange("a test", 4, vrp=(x, y) if moves else None, shift=later, longer=0.8), time, region).gap
    after = plan.at(time + 1e-9)
    assert np.hypot(*gap) < 1e-6
    assert np.allclose(after.dcm, before.dcm, atol=1e-6)
    assert np.allclose(after.com, before.com, atol=1e-6)
    away = [float(np.hypot(*(plan.at(time + t).dcm - stance))) for t in (0.2, 0.4, 0.6, 0.8)]
    assert max(away) < 0.045  # over the sole, where it would have been 0.14 m away after 0.45 s
    held = np.array([plan.at(t).vrp for t in np.arange(time, swing.end + 0.8, 0.01)])
    assert np.abs(held - stance).max() < 0.06 + 1e-9
    assert np.allclose(plan.end, end + later, atol=1e-9)
    if moves:
        assert np.allclose(plan.at(swing.end + 0.8 + 0.3 + 0.1).vrp, [x, y], atol=1e-9)


def test_a_foothold_that_is_seen_coming_is_bridged_on_the_stance_foot():
    feet, steps = straight_plan(6, length=0.2)
    plan = WalkPlan(feet, steps, Timing(), CENTER, OMEGA, 1.0)
    swing = next(p for p in plan.schedule.phases if p.kind == PhaseKind.SINGLE_SUPPORT and p.step == 2)
    time = swing.end - 0.18
    before, stance = plan.at(time), plan.view.vrp(1)
    sole = stance + np.array([[-0.11, -0.06], [0.11, -0.06], [0.11, 0.06], [-0.11, 0.06]])
    replan = moved(plan, 2, (-0.08, 0.0), time, sole)
    after = plan.at(time)
    assert replan.delay == 0.0
    assert max(map(abs, replan.gap)) < 1e-12
    assert np.abs(after.dcm - before.dcm).max() < 1e-12
    assert np.abs(after.com_velocity - before.com_velocity).max() < 1e-12
    shifts = [plan.at(t).vrp[0] - stance[0] for t in np.linspace(time, swing.end, 50)]
    assert 0.02 < max(np.abs(shifts)) < 0.11  # the bridge stays within the sole
    assert plan.at(swing.end).vrp == pytest.approx(stance, abs=1e-9)


def walking(count: int = 6) -> WalkPlan:
    feet, steps = straight_plan(count, length=0.2)
    return WalkPlan(feet, steps, Timing(), CENTER, OMEGA, 1.0)


def test_a_footstep_moves_with_its_vrp_and_the_record_says_from_where_to_where_and_why():
    plan = walking()
    before = plan.view
    place = replace(before.foothold(3), x=0.75, yaw=0.1)
    applied = plan.apply(PlanChange("aimed anew", 3, foothold=place, shift=(0.05, 0.0), because="after it"), 2.5, WIDE)
    assert plan.view.foothold(3) == place
    assert plan.view.vrp(3) == pytest.approx(vrp_of_step(place, CENTER[place.side]))
    assert plan.record == (applied,)
    assert plan.view.last is applied
    assert [(m.step, m.before, m.reason) for m in applied.moved] == [
        (3, before.foothold(3), "aimed anew"),
        (4, before.foothold(4), "after it"),
        (5, before.foothold(5), "after it"),
    ]
    assert before.foothold(3) == straight_plan(6, length=0.2)[1][3]  # what was handed out stays as it was


def test_steps_come_one_by_one_for_an_hour_in_bounded_memory():
    """A walk without an end: at each double support the next steps are planned anew, a little further each time."""
    plan = walking(3)
    largest = 0.0
    for k in range(3000):
        phase = next(p for p in plan.schedule.phases if p.step == k and p.swing is None)
        time = phase.start + 0.01 if np.isfinite(phase.start) else 1.0
        last = plan.view.foothold(k - 1) if k else None
        side = plan.view.foothold(k).side
        x = 0.0 if last is None else last.x
        following = tuple(
            Footstep(side if i % 2 == 0 else other_side(side), x + 0.1 * (i + 1), 0.085 * (1 - 2 * ((k + i) % 2)))
            for i in range(3)
        )
        before = plan.at(time)
        applied = plan.apply(PlanChange("goes on", k - 1, following=following), time, np.empty((0, 2)))
        after = plan.at(time)
        largest = max(largest, float(np.abs(after.dcm - before.dcm).max()), float(np.abs(after.com - before.com).max()))
        assert max(map(abs, applied.gap)) < 1e-9
    assert largest < 1e-9
    assert plan.view.count == 3002
    assert len(plan.view.steps) < 12
    assert len(plan.schedule.phases) < 16
    assert len(plan.vrps.times) < 40
    assert len(plan.record) == 1000


def test_a_phase_that_is_shortened_brings_the_touchdown_and_all_later_phases_forward():
    plan = walking()
    swing = next(p for p in plan.schedule.phases if p.step == 2 and p.swing is not None)
    time = swing.start + 0.2
    before = plan.at(time)
    plan.apply(PlanChange("sooner", 2, longer=-0.25), time, WIDE)
    assert plan.schedule.at(time).touchdown == pytest.approx(swing.end - 0.25)
    assert plan.at(time).dcm == pytest.approx(before.dcm, abs=1e-9)
    assert plan.at(time).com == pytest.approx(before.com, abs=1e-9)
    landed = plan.schedule.at(swing.end - 0.25 + 0.3 + 0.1)
    assert plan.at(0.5 * (landed.start + landed.end)).vrp == pytest.approx(plan.view.vrp(2), abs=1e-9)


def test_a_change_of_a_step_that_is_not_there_is_refused():
    with pytest.raises(InputError, match=r"step 9 is not in the plan; allowed: 0 to 5"):
        walking().apply(PlanChange("a test", 9, vrp=(0.0, 0.0)), 1.0, WIDE)
    with pytest.raises(InputError, match=r"step 1 is not in the plan; allowed: 0 to 0"):
        walking(1).apply(PlanChange("a test", 1, vrp=(0.0, 0.0)), 1.0, WIDE)


def test_what_the_plan_hands_out_cannot_be_changed():
    plan = walking()
    plan.apply(PlanChange("a test", 2, vrp=(0.5, 0.0)), 2.5, WIDE)
    values = (
        plan.view,
        plan.view.steps[0],
        plan.view.foothold(0),
        plan.schedule,
        plan.schedule.phases[0],
        *plan.record,
    )
    for value in values:
        for name in vars(value):
            with pytest.raises(FrozenInstanceError):
                setattr(value, name, None)
    assert isinstance(plan.view.steps, tuple)
    assert isinstance(plan.schedule.phases, tuple)
    arrays = [plan.view.vrp(k) for k in range(6)] + [plan.vrps.vrps, plan.vrps.dcm_waypoints]
    for array in (*arrays, *plan.view.standing.values()):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0.0


def test_a_moved_foothold_keeps_the_height_that_was_planned():
    feet, steps = straight_plan(6, length=0.2, climb=0.05)
    plan = WalkPlan(feet, steps, Timing(), CENTER, OMEGA, 1.0)
    there = Footstep(steps[2].side, steps[2].x + 0.03, steps[2].y)
    plan.apply(PlanChange("farther", 2, foothold=there), 1.5, np.empty((0, 2)))
    assert plan.view.foothold(2) == replace(there, z=steps[2].z)
    assert plan.view.foothold(2).z > 0.1


def test_without_a_transfer_the_vrp_is_constant_over_a_step():
    """T 4.14-4.15 (corrected), waypoint by waypoint, each step t_ss + t_ds long (T 4.16)."""
    feet, steps = straight_plan(6, length=0.2)
    timing = Timing(transfer=0.0)
    plan = WalkPlan(feet, steps, timing, CENTER, OMEGA, 1.0)
    singles = [p for p in plan.schedule.phases if p.kind == PhaseKind.SINGLE_SUPPORT]
    length = timing.single_support + timing.double_support
    begins = [p.start - 0.5 * timing.double_support for p in singles]
    vrps = [plan.view.stance_vrp(p.step) for p in singles]
    for i in range(1, len(singles) - 2):
        after = plan.at(begins[i + 1] + length).dcm
        waypoint = vrps[i + 1] + np.exp(-OMEGA * length) * (after - vrps[i + 1])  # T 4.14
        assert plan.at(begins[i + 1]).dcm == pytest.approx(waypoint, abs=1e-3)  # the jump takes a millisecond
        for time in (0.1, 0.5 * length, length - 0.1):
            found = plan.at(begins[i] + time)
            assert found.vrp == pytest.approx(vrps[i], abs=1e-12)
            assert found.dcm == pytest.approx(
                vrps[i] + np.exp(OMEGA * (time - length)) * (waypoint - vrps[i]), abs=1e-3
            )


@pytest.mark.parametrize("transfer", [0.0, 0.3, 1.0])
def test_a_change_keeps_a_jumping_vrps_dcm_without_a_jump(transfer):
    feet, steps = straight_plan(8, length=0.0, sideways=0.08)
    for late in (-0.3, 0.02, 0.14, 0.16, 0.28):
        plan = WalkPlan(feet, steps, Timing(transfer=transfer), CENTER, OMEGA, 1.0)
        phase = next(p for p in plan.schedule.phases if p.kind == PhaseKind.DOUBLE_SUPPORT and p.step == 4)
        before = plan.at(phase.start + late)
        applied = moved(plan, 3, (0.02, 0.01), phase.start + late, WIDE)
        after = plan.at(phase.start + late)
        assert after.com == pytest.approx(before.com, abs=1e-9)
        assert after.dcm + np.array(applied.gap) == pytest.approx(before.dcm, abs=1e-9)
        assert np.hypot(*applied.gap) < 0.02
