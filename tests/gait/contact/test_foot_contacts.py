"""What both feet stand on."""

import math
from dataclasses import replace

import numpy as np
import pytest

from plantar import Percept, hex_layout
from plantar.gait.contact.ankle_limits import AnkleLimits
from plantar.gait.contact.foot_contacts import FootContacts, middle_of_sole, on_its_hull
from plantar.gait.contact.stance_contact import ContactSettings
from plantar.gait.plan.feet_view import FeetView
from plantar.gait.plan.phases import Phase, PhaseKind
from plantar.mechanics.base_state import BaseState
from plantar.sensing.reading import Reading

SOLE = hex_layout([[-0.125, -0.075], [0.125, -0.075], [0.125, 0.075], [-0.125, 0.075]], clip=False)


@pytest.mark.parametrize("edge", [0.0, math.inf])
def test_a_foot_that_lands_stands_on_the_part_of_its_sole_that_saw_ground(edge):
    contacts = FootContacts(ContactSettings(), {"left": SOLE, "right": SOLE})
    contacts.lift_off("left", 0)
    phase, ahead = Phase(PhaseKind.SINGLE_SUPPORT, 0, 1.0, 2.0, "left"), np.array([0.1, 0.0])  # too far to plan with
    nothing = np.zeros(3)
    state = BaseState(np.eye(3), nothing, nothing, nothing, None, {}, {"left": nothing}, {"left": np.eye(3)})
    for k in range(10):
        distance = np.where(SOLE.positions[:, 0] < edge, 0.02, math.inf)
        sole = Percept(SOLE, Reading(1.8 + 0.004 * k, np.zeros(len(SOLE)), distance))
        feet = FeetView({}, "left", landed=False, ahead=ahead)
        assert contacts.find_ahead(phase, 1.8, feet, state, {"left": sole}) is None
    whole = contacts.center("left")
    contacts.touchdown("left")
    assert ("left" in contacts.parts) == (edge == 0.0)
    assert contacts.center("left")[0] == pytest.approx(-0.0625 if edge == 0.0 else whole[0], abs=0.015)
    contacts.lift_off("left", 2)
    assert "left" not in contacts.parts


@pytest.mark.parametrize("reach", [0.08, math.inf])
def test_a_sole_with_a_waist_is_loaded_where_its_hull_is(reach):
    ring = np.insert(SOLE.outline, 1, [0.0, -0.06], 0)  # 15 mm inwards, at the right side
    waisted = replace(SOLE, outline=ring)
    assert on_its_hull(SOLE) is SOLE
    assert middle_of_sole(waisted, reach) == pytest.approx(middle_of_sole(SOLE, reach), abs=1e-12)


@pytest.mark.parametrize(("side", "outer"), [("left", 1.0), ("right", -1.0)])
def test_a_sole_that_leans_is_loaded_towards_its_outer_edge(side, outer):
    ring = np.array([[-0.1, -0.03], [0.15, -0.06], [0.15, 0.06], [-0.1, 0.03]])  # narrower at the heel
    sole = replace(SOLE, outline=ring, side=side)
    x, y = middle_of_sole(sole)
    edge = 0.03 + 0.03 * (x + 0.1) / 0.25  # half of its width at x
    assert middle_of_sole(sole, outward=1.0) == pytest.approx([x, outer * edge])
    assert middle_of_sole(sole, outward=0.5) == pytest.approx([x, y + 0.5 * (outer * edge - y)])
    contacts = FootContacts(ContactSettings(), {"left": sole, "right": sole}, outward=0.5)
    assert contacts.center("left") == pytest.approx([x, y + 0.5 * (outer * edge - y)])


def test_a_whole_sole_is_planned_to_be_loaded_where_a_weak_knee_can():
    knee = AnkleLimits(np.array([[1.0, 0.0, 0.3, 0.25, 0.1]]), 0.015)  # in front of 62 mm
    x, _ = middle_of_sole(SOLE, limits=knee)
    front = SOLE.outline[:, 0].max() - 0.015
    assert 0.3 - 0.95 * 0.25 < x < front
    assert x == pytest.approx(0.5 * (0.0625 + front), abs=0.005)
    # One that holds most of the sole leaves its middle: hrp2kai fell on slopes with its feet farther behind.
    strong = AnkleLimits(np.array([[1.0, 0.0, 0.3, 0.38, 0.1]]), 0.015)
    assert middle_of_sole(SOLE, limits=strong).tolist() == middle_of_sole(SOLE).tolist()


@pytest.mark.parametrize(("half_width", "left"), [(0.012, 0.006), (0.075, 0.06)])
def test_a_narrow_sole_leaves_the_zmp_half_of_its_width(half_width, left):
    ring = [[-0.125, -half_width], [0.125, -half_width], [0.125, half_width], [-0.125, half_width]]
    sole = hex_layout(ring, cell_area=1e-4)
    contacts = FootContacts(ContactSettings(), {"left": sole, "right": sole})
    phase, place = Phase(PhaseKind.SINGLE_SUPPORT, 0, 1.0, 2.0, "right"), (np.zeros(3), 0.0)
    region = contacts.zmp_region(
        phase, FeetView({"left": place, "right": place}, "right", landed=False), [0.0] * 3, 0.015
    )
    assert np.ptp(region[:, 1]) == pytest.approx(2.0 * left, abs=1e-6)
