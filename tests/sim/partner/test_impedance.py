"""The partner's impedance controller against the closed form of a damped oscillator, and its rest that follows."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest

from plantar.settings.body_scale import REFERENCE_BODY
from plantar.sim.partner.impedance import Impedance
from plantar.sim.partner.settings import PartnerSettings

FOLLOWER = PartnerSettings(kind="mobile_robot").for_body(REFERENCE_BODY)


def test_the_defaults_are_those_of_k_on_h1() -> None:
    law = PartnerSettings()
    given = (law.virtual_mass, law.virtual_damping, law.virtual_stiffness, law.stride, law.built_in_force)
    assert given == pytest.approx((50.0, 60.0, 200.0, 0.1, 15.0), rel=2e-3)


def test_it_moves_as_the_closed_form_says() -> None:
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
def test_its_rest_follows_by_strides_either_way(sign: float) -> None:
    law = Impedance(FOLLOWER)
    rests = []
    for _ in range(8000):
        law.update(sign * 60.0, 0.001)
        rests.append(law.rest)
    hops = [b - a for a, b in pairwise(rests) if b != a]
    assert len(hops) >= 3
    assert hops == pytest.approx([sign * FOLLOWER.stride] * len(hops))
    assert abs(law.position - law.rest) <= FOLLOWER.stride + abs(law.velocity) * 0.001


def test_only_a_leader_goes_by_itself() -> None:
    leader, follower = (Impedance(PartnerSettings(role=role)) for role in ("leader", "follower"))
    for _ in range(5000):
        leader.update(0.0, 0.001)
        follower.update(0.0, 0.001)
    assert leader.rest >= leader._law.stride
    assert follower.position == 0.0
