"""A mobile robot before a floating box: it is pushed back as a follower, and pushes as a leader."""

import math
from itertools import pairwise

import pytest

from plantar.common.settings.body_scale import REFERENCE_BODY, BodyScale
from plantar.sim.partner.mobile_robot import Impedance, MobileRobot
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


def test_a_follower_gives_way_and_takes_momentum():
    partner, momentum = met("follower", 0.15, 1.2)
    told = partner.summary()
    assert told["moved_m"] < -0.02
    assert momentum < 0.8 * 0.15 * REFERENCE_BODY.mass
    assert 0.0 < told["contact_share"] < 1.0
    assert 20.0 < told["largest_force_N"] < 500.0


def test_a_leader_comes_and_pushes_the_body_away():
    partner, momentum = met("leader", 0.0, 2.0)
    assert partner.moved > 0.0
    assert momentum < -1.0


def test_a_small_pair_does_likewise():
    scale = 0.4**0.5  # of speeds and times, by dynamic similarity
    whole, _ = met("follower", 0.15, 0.8)
    small, _ = met("follower", 0.15 * scale, 0.8 * scale, SMALL)
    assert small.moved / SMALL.leg == pytest.approx(whole.moved / REFERENCE_BODY.leg, rel=0.1)


FOLLOWER = PartnerSettings(kind="mobile_robot").for_body(REFERENCE_BODY)


def test_the_defaults_are_those_of_k_on_h1():
    law = PartnerSettings()
    given = (law.virtual_mass, law.virtual_damping, law.virtual_stiffness, law.stride, law.built_in_force)
    assert given == pytest.approx((50.0, 60.0, 200.0, 0.1, 15.0), rel=2e-3)


def test_it_moves_by_the_closed_form():
    law, force, step = Impedance(FOLLOWER), 8.0, 1e-4
    m, d, k = FOLLOWER.virtual_mass, FOLLOWER.virtual_damping, FOLLOWER.virtual_stiffness
    decay, wave = d / (2.0 * m), math.sqrt(k / m - (d / (2.0 * m)) ** 2)
    for i in range(1, 30001):
        law.update(force, step)
        if i % 5000 == 0:
            t = i * step
            swing = math.exp(-decay * t) * (math.cos(wave * t) + decay / wave * math.sin(wave * t))
            assert law.position == pytest.approx(force / k * (1.0 - swing), abs=2e-5)
    assert law.rest == 0.0


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_its_rest_follows_by_strides_either_way(sign):
    law = Impedance(FOLLOWER)
    rests = []
    for _ in range(8000):
        law.update(sign * 60.0, 0.001)
        rests.append(law.rest)
    hops = [b - a for a, b in pairwise(rests) if b != a]
    assert len(hops) >= 3
    assert hops == pytest.approx([sign * FOLLOWER.stride] * len(hops))
    assert abs(law.position - law.rest) <= FOLLOWER.stride + abs(law.velocity) * 0.001


def test_only_a_leader_goes_by_itself():
    leader, follower = (Impedance(PartnerSettings(role=role)) for role in ("leader", "follower"))
    for _ in range(5000):
        leader.update(0.0, 0.001)
        follower.update(0.0, 0.001)
    assert leader.rest >= leader._law.stride
    assert follower.position == 0.0
