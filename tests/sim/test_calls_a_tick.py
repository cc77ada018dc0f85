"""A control tick makes no more calls than before, and slowings are noticed."""

import logging

import numpy as np
import pytest

from plantar import kernels
from plantar.common.sides import SIDES
from plantar.gait.contact.contact_memory import ContactMemory
from plantar.gait.contact.foot_contacts import FootContacts
from plantar.gait.controller import WalkingController
from plantar.gait.estimate.estimator import FloatingBaseEstimator
from plantar.gait.feet.foot_motion import FootMotion
from plantar.gait.plan.walk_plan import WalkPlan
from plantar.gait.tick.footing import Footing
from plantar.geometry.polygon import convex_hull
from plantar.robots.kinematics.leg_model import LegModel

from .calls_a_tick import ALLOWED, CASES, calls_a_tick, limits

pytestmark = pytest.mark.skipif(not kernels.compiled, reason="interpreted kernels make calls themselves")

SHORT = (2.3, 2.6)  # s of a swing


@pytest.mark.sample(2, each="robot")
@pytest.mark.parametrize(("scene", "robot"), CASES)
def test_a_tick_makes_no_more_calls(scene, robot):
    limit, found = limits()[scene, robot], calls_a_tick(scene, robot)
    for name, most, now in zip(limit._fields, limit, found, strict=True):
        assert now <= most + ALLOWED, (
            f"a tick of {scene} with {robot} makes {now:.1f} {name}, {now - most:.1f} more than before; "
            "if they are worth it, run `python tests/sim/calls_a_tick.py`"
        )


def _also(method, work):
    """A method that does some more work first."""

    def slowed(self, *args, **named):
        work(self)
        return method(self, *args, **named)

    return slowed


def _forget_rotations(motion):
    motion._rotations = {}


def _forget_region(contacts):
    contacts._region_of = []


def _forget_polygon(memory):
    memory._polygon = None


_CLOUD = np.random.default_rng(0).normal(size=(20, 2))
_LOG = logging.getLogger("plantar.test")
SLOWINGS = {
    "a polygon": (FootContacts, "coming_to_carry", lambda _: convex_hull(_CLOUD)),
    "a copy": (FloatingBaseEstimator, "update", lambda _: _CLOUD.copy()),
    "a line of a log": (WalkingController, "_tick", lambda _: _LOG.debug("a tick")),
    "a lost cache of rotations": (FootMotion, "rotation", _forget_rotations),
    "a lost cache of the ZMP's region": (FootContacts, "zmp_region", _forget_region),
    "a lost cache of contacts": (ContactMemory, "encloses", _forget_polygon),
    "kinematics computed twice": (LegModel, "follow_command", lambda legs: legs.live_posture(legs.joints)),
    "a plan looked at once more": (Footing, "perceive", lambda footing: footing._plan.at(2.0)),
    "a convenience of numpy": (LegModel, "carry_command", lambda _: np.repeat([0.5, 0.5], 6)),
    "a dictionary by a comprehension": (WalkPlan, "at", lambda _: {side: len(side) for side in SIDES}),
}


@pytest.mark.long
@pytest.mark.parametrize("name", SLOWINGS)
def test_a_slowing_is_noticed(name, monkeypatch):
    owner, method, work = SLOWINGS[name]
    usual = getattr(owner, method)
    monkeypatch.setattr(owner, method, _also(usual, lambda _: None))
    before = calls_a_tick("flat", "h1", SHORT)
    monkeypatch.setattr(owner, method, _also(usual, work))
    found = calls_a_tick("flat", "h1", SHORT)
    assert any(now > most + ALLOWED for now, most in zip(found, before, strict=True))
