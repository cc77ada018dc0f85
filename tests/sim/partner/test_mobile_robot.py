"""A mobile robot before a floating box: it is pushed back as a follower, and pushes as a leader."""

from __future__ import annotations

import pytest

from plantar.settings.body_scale import REFERENCE_BODY, BodyScale
from plantar.sim.partner.mobile_robot import MobileRobot
from plantar.sim.partner.settings import PartnerSettings

from .floating import box_skin, floating_box

SMALL = BodyScale(mass=86.0 * 0.4**3, leg=0.24, sole=0.0924, sole_width=0.064)


def met(role: str, speed: float, seconds: float, body: BodyScale = REFERENCE_BODY) -> tuple[MobileRobot, float]:
    """The partner and the box's momentum in N s after so many seconds, the box coming at it at a speed in m/s."""
    settings = PartnerSettings(kind="mobile_robot", role=role, starts=0.0).for_body(body)
    partner = MobileRobot(settings, box_skin(body), body, 1.0, seed=0)
    touch = floating_box([partner], body)
    data = touch._world.data
    data.qvel[0] = speed
    while data.time < seconds:
        touch.step()
    return partner, float(data.qvel[0] * body.mass)


def test_a_follower_gives_way_and_takes_momentum() -> None:
    partner, momentum = met("follower", 0.15, 1.2)
    told = partner.summary()
    assert told["moved_m"] < -0.02
    assert momentum < 0.8 * 0.15 * REFERENCE_BODY.mass
    assert 0.0 < told["contact_share"] < 1.0
    assert 20.0 < told["largest_force_N"] < 500.0


def test_a_leader_comes_and_pushes_the_body_away() -> None:
    partner, momentum = met("leader", 0.0, 2.0)
    assert partner.moved > 0.0
    assert momentum < -1.0


def test_a_small_pair_does_likewise() -> None:
    scale = 0.4**0.5  # of speeds and times, by dynamic similarity
    whole, _ = met("follower", 0.15, 0.8)
    small, _ = met("follower", 0.15 * scale, 0.8 * scale, SMALL)
    assert small.moved / SMALL.leg == pytest.approx(whole.moved / REFERENCE_BODY.leg, rel=0.1)
