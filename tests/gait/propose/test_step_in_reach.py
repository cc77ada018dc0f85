"""A step after a partial foothold is as short as the other leg needs it to be, and no other step is."""

import numpy as np
import pytest

from plantar.common.sides import SIDES
from plantar.gait.contact.ankle_limits import AnkleLimits
from plantar.gait.contact.foot_contacts import FootholdFound
from plantar.gait.contact.standing_leg import StandingLeg
from plantar.gait.propose.step_in_reach import StepInReach

LEG = StandingLeg(0.3, 0.3, 0.534, 0.03, 0.0, 1.0, 0.16, 0.12, 0.075, (0.0, 0.075, 0.0))
NOWHERE = np.empty((0, 2))
LEAST, BODY = 0.004, 0.6  # m


def proposer_with(leg: StandingLeg | None, middle: float = 0.02) -> StepInReach:
    limits = {side: AnkleLimits(np.empty((0, 5)), 0.015, leg) for side in SIDES}
    return StepInReach(limits, {side: np.array([middle, 0.0]) for side in SIDES}, LEAST, BODY)


def found_in(plan, step: int, behind: float, whole: bool = False, rise: float = 0.01) -> FootholdFound:
    """A foothold of a step that carries at some way behind its sole's origin, and the leg stands higher by a rise."""
    foot = plan.view.foothold(step)
    place = foot.position[:2] - behind * foot.rotation_sole_to_world[:2, 0]
    return FootholdFound(step, foot.side, NOWHERE, 0.3, place, place, whole, whole, True, rise)


def swung(proposer, plan, tick_at, found, step=2):
    """What it proposes as the swing after a foothold begins."""
    phase = next(p for p in plan.schedule.phases if p.step == step and p.swing is not None)
    down = next(p for p in plan.schedule.phases if p.step == step and p.swing is None)
    assert proposer.propose(tick_at(plan, down.start + 0.01, found=(found,))) is None
    return phase, proposer.propose(tick_at(plan, phase.start + 0.005))


def test_the_foot_can_land_while_the_body_rests_over_the_load(plan_of, tick_at):
    plan, proposer = plan_of(6, length=0.2), proposer_with(LEG)
    found = found_in(plan, 1, 0.03)
    phase, change = swung(proposer, plan, tick_at, found)
    planned = plan.view.foothold(2)
    assert change.step == 2
    assert change.shift == (0.0, 0.0)
    less = planned.x - change.foothold.x
    assert LEAST < less < BODY / 20
    reach = LEG.spread(abs(planned.y - found.vrp.item(1)), found.rise)
    assert change.foothold.x - found.vrp.item(0) == pytest.approx(reach)
    plan.apply(change, phase.start + 0.005, NOWHERE)
    assert proposer.propose(tick_at(plan, phase.start + 0.01)) is None
    assert plan.view.foothold(3).x == pytest.approx(planned.x + 0.2)


def test_it_asks_until_the_step_is_over(plan_of, tick_at):
    plan, proposer = plan_of(6, length=0.2), proposer_with(LEG)
    phase, change = swung(proposer, plan, tick_at, found_in(plan, 1, 0.05))
    assert proposer.propose(tick_at(plan, phase.start + 0.01)) is change
    assert proposer.propose(tick_at(plan, phase.end + 0.01)) is None
    assert proposer.propose(tick_at(plan, phase.end + 0.02)) is None


def test_a_step_is_shortened_by_so_much_at_most(plan_of, tick_at):
    plan = plan_of(6, length=0.2)
    planned = plan.view.foothold(2)
    change = swung(proposer_with(LEG, middle=0.1), plan, tick_at, found_in(plan, 1, 0.1))[1]
    assert planned.x - change.foothold.x == pytest.approx(BODY / 20)


def test_the_last_step_that_closes_the_feet_stays(plan_of, tick_at):
    plan = plan_of(3, length=0.2)
    assert swung(proposer_with(LEG), plan, tick_at, found_in(plan, 1, 0.1))[1] is None


def test_a_step_to_the_side_stays(plan_of, tick_at):
    plan = plan_of(6, length=0.0, sideways=0.1)
    assert swung(proposer_with(LEG), plan, tick_at, found_in(plan, 1, 0.05))[1] is None


@pytest.mark.parametrize("why", ["whole", "in reach", "another step", "no knee", "next out of reach"])
def test_other_steps_stay(why, plan_of, tick_at):
    plan = plan_of(6, length=0.2)
    leg = None if why == "no knee" else LEG
    found = found_in(plan, 1, 0.0 if why == "in reach" else 0.05, whole=why == "whole")
    proposer = proposer_with(leg, middle=-0.1 if why == "next out of reach" else 0.02)
    step = 3 if why == "another step" else 2
    assert swung(proposer, plan, tick_at, found, step)[1] is None
