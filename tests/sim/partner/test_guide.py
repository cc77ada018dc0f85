"""A hand that leads an arm on a fixed base: its way, its force, and that it lets the arm alone before."""

import numpy as np
import pytest

from plantar.common.settings.body_scale import REFERENCE_BODY
from plantar.sim.judging.guide_truth import GuideTruth
from plantar.sim.model.world import World
from plantar.sim.partner.guide import Grip, Guide
from plantar.sim.partner.settings import GuideSettings
from plantar.sim.partner.touch import Touch

from ..arms.fixed_arm import compliant, fixed_world, left_arm

WAY, STARTS = 0.06, 0.15


def led(direction: str, force: float, gain: float) -> tuple[Guide, GuideTruth, list[float]]:
    """The hand, the judge, and the forces in N along the way at each control tick."""
    worn = left_arm()
    settings = GuideSettings(way=WAY, toward=direction, sets_out=STARTS, within=0.0, hand_speed=0.2, hand_force=force)
    guide = Guide(settings, Grip(*worn.surface("left_lower_arm")), REFERENCE_BODY, seed=0)
    world: World = fixed_world(worn, [guide])
    arm = compliant(worn, world, gain=gain)
    touch = Touch(world, worn.skin, [guide], seed=0)
    touch.place()
    grip = guide.grip
    truth = GuideTruth(world, grip.link, grip.point, tuple(worn.joints), worn.posture, guide.sign * WAY, STARTS)
    forces = []
    for k in range(900):
        if k % 5 == 0:
            arm.read()
            arm.step(touch.read())
            truth.update(world.data.time)
            forces.append(guide.force)
        touch.step()
    return guide, truth, forces


def test_it_leads_an_arm_that_gives_way_and_meets_its_springs():
    guide, truth, forces = led("forward", force=40.0, gain=3.0)
    assert guide.sign == 1.0
    assert np.abs(forces[: round(STARTS / 0.005)]).max() == 0.0  # between the fingers the arm has play
    assert guide.reference == WAY
    assert 0.5 * WAY < guide.moved < WAY
    assert forces[-1] == pytest.approx(guide.settings.hand_spring * (WAY - guide.moved), rel=0.2)
    assert guide.moved - 0.02 < truth.yielded < guide.moved + 1e-3  # less by the play
    assert truth.followed == truth.astray == 0.0
    failed = truth.reasons()
    assert [reason["criterion"] for reason in failed] == ["followed"]
    assert failed[0]["limit"] == pytest.approx(0.04)
    assert truth.summary()["arm_turned_deg"] > 1.0


def test_it_is_no_stronger_than_its_force_and_leads_backward_too():
    guide, truth, forces = led("backward", force=5.0, gain=0.0)
    assert guide.sign == -1.0
    assert np.median(forces[-40:]) == pytest.approx(5.0, abs=0.5)
    assert [reason["criterion"] for reason in truth.reasons()] == ["yielded", "followed"]


def test_the_seed_chooses_where_to_and_when():
    grip = Grip("arm/left_lower_arm", np.zeros(3), 0.045)
    guides = [Guide(GuideSettings(way=0.3), grip, REFERENCE_BODY, seed) for seed in range(8)]
    assert {guide.sign for guide in guides} == {-1.0, 1.0}
    starts = [guide.starts for guide in guides]
    assert 2.0 <= min(starts) < 3.0 < max(starts) <= 2.0 + GuideSettings().within
