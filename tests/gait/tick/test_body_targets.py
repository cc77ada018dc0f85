"""Targets of the body over the feet."""

from types import SimpleNamespace

import numpy as np
import pytest

from plantar.common.settings.body_scale import REFERENCE_BODY
from plantar.gait.plan.phases import Phase, PhaseKind
from plantar.gait.tick.body_targets import BodyTargets

SINGLE = Phase(PhaseKind.SINGLE_SUPPORT, 0, 0.0, 1.0, "right")
DOUBLE = Phase(PhaseKind.DOUBLE_SUPPORT, 1, 1.0, 1.3)


def height_in(phase, right, spare):
    """Height in m of the CoM over the left sole, at rest, with a right sole that is or comes to `right` in m."""
    motion = SimpleNamespace(
        footholds={"left": (np.zeros(3), 0.0), "right": (np.array([0.2, -0.2, right]), 0.0)},
        comes_to=right,
        comes_down=True,
    )
    footing = SimpleNamespace(
        motion=motion, contacts=SimpleNamespace(rise=0.0), guard=None, frame=SimpleNamespace(to_command=lambda p: p)
    )
    settings = SimpleNamespace(
        body=REFERENCE_BODY,
        standing_legs={},
        period=0.005,
        com_height=0.75,
        spare_crouch=spare,
        trunk_lean=0.0,
        lean_reach=0.1,
    )
    targets = BodyTargets(settings, footing)
    for _ in range(1000):
        com, _, _ = targets.at(phase, np.zeros(2), 0.0, None)
    return com.item(2)


@pytest.mark.parametrize("right", [-0.04, -0.02, 0.0])
def test_before_a_step_down_the_body_is_where_both_feet_will_have_it(right):
    assert height_in(SINGLE, right, 0.03) == pytest.approx(height_in(DOUBLE, right, 0.03), abs=1e-6)


def test_it_comes_down_no_lower_than_it_may_crouch():
    assert height_in(SINGLE, -0.1, 0.03) == pytest.approx(0.72, abs=1e-6)


def test_it_stays_up_before_a_step_up():
    assert height_in(SINGLE, 0.04, 0.03) == pytest.approx(0.75, abs=1e-6)
