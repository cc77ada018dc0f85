"""A foot that takes the ground's shape, on ground made of springs."""

import numpy as np
import pytest

from plantar import Percept, Reading
from plantar.common.sides import SIDES, Side
from plantar.errors import InputError
from plantar.gait.contact.ground_map import GroundMapSettings
from plantar.gait.feet.compliance_gains import ComplianceGains, TouchdownGains
from plantar.gait.feet.foot_motion import FootMotion
from plantar.gait.feet.ground_conformity import ConformityGains, FootTurn, GroundConformity
from plantar.gait.feet.landing import Landing
from plantar.gait.feet.swing_compliance import SwingCompliance
from plantar.gait.plan.footsteps import straight_plan
from plantar.gait.plan.phases import Phase, PhaseKind
from plantar.layouts.layout import SoleLayout
from plantar.layouts.tiling import hex_layout
from plantar.mechanics.base_state import BaseState

PERIOD = 0.005
GAINS = ConformityGains()


def test_an_incoming_sole_on_its_toes_turns_its_heel_down_the_faster_the_more_it_carries():
    slow, fast = (FootTurn(GAINS, PERIOD).incoming(load, np.array([0.1, 0.0]), np.zeros(2)) for load in (100.0, 400.0))
    assert fast == pytest.approx(4.0 * slow)
    assert slow[0] == 0.0
    assert slow[1] < 0.0  # about +y the toes go down
    assert FootTurn(GAINS, PERIOD).incoming(300.0, np.array([0.005, 0.005]), np.zeros(2)) == pytest.approx([0.0, 0.0])


def test_a_foot_rolls_from_a_bump_onto_the_next_ones():
    """One bump 70 mm in front of the target carries until the sole has turned by 50 mrad; then its load can move."""
    foot, tilt, stiff = FootTurn(GAINS, PERIOD), 0.05, 9.5  # rad; m of the load's place for each rad beyond contact
    for _ in range(160):
        x = 0.07 if tilt > 0.0 else max(-0.05, 0.07 + stiff * tilt)
        tilt += float(foot.incoming(200.0, np.array([x, 0.0]), np.zeros(2))[1])
    assert -0.01 < tilt <= 0.0
    assert abs(x) <= GAINS.nearly + 0.002


def test_a_stance_foot_brings_its_load_where_it_is_wanted():
    foot, tilt = FootTurn(GAINS, PERIOD), 0.0
    track = []
    for _ in range(100):
        cop = np.array([0.02 + 9.5 * tilt, 0.0])
        tilt += float(foot.stance(840.0, cop, np.array([-0.01, 0.0]))[1])
        track.append(float(cop[0]))
    assert track[-1] == pytest.approx(-0.01, abs=1e-4)
    assert min(track) > -0.012  # does not swing over


def test_a_foot_that_rolls_over_an_edge_turns_faster():
    foot, stuck = FootTurn(GAINS, PERIOD), np.array([0.05, 0.02])
    turns = [float(np.hypot(*foot.stance(230.0, stuck, np.array([0.02, 0.0])))) for _ in range(60)]
    assert turns[-1] == pytest.approx(GAINS.rolling / (GAINS.firm * 230.0) * turns[0])
    assert max(turns) <= GAINS.largest_rate * PERIOD + 1e-12


def test_a_foot_whose_load_follows_its_turns_late_does_not_turn_faster():
    foot, tilts = FootTurn(GAINS, PERIOD), [0.0] * 12  # 55 ms from a turn until the load that it moved is read
    rates = []
    for _ in range(60):
        cop = np.array([0.06 + 9.5 * tilts[-12], 0.0])
        turn = float(foot.stance(200.0, cop, np.zeros(2))[1])
        tilts.append(tilts[-1] + turn)
        rates.append(-turn / (GAINS.firm * 200.0 * PERIOD * abs(cop[0])))
    assert max(rates) <= 1.0 + 1e-9


def test_a_standing_sole_turns_about_what_carries_it():
    feet, _ = straight_plan(2)
    layout = hex_layout([[-0.1, -0.07], [0.12, -0.07], [0.12, 0.07], [-0.1, 0.07]])
    compliance = {
        side: SwingCompliance(layout, ComplianceGains(), TouchdownGains(), GroundMapSettings(), 0.3) for side in feet
    }
    motion = FootMotion(feet, PERIOD, 0.05, Landing(), compliance)
    pivot, before = np.array([0.1, -0.04]), motion.footholds["left"][0].copy()
    motion.turn_standing("left", np.array([0.02, -0.03]), pivot)
    height = motion.footholds["left"][0][2] + float(motion.rotation("left")[2, :2] @ pivot)
    assert height == pytest.approx(before[2], abs=1e-12)
    assert motion.rotation("left")[2, 0] == pytest.approx(0.03, abs=1e-3)  # toes up
    assert (motion.footholds["left"][0][:2] == before[:2]).all()


def test_a_gain_below_zero_is_refused():
    with pytest.raises(InputError, match="setting 'gap'"):
        ConformityGains(gap=-1.0)


def _turned(swing, cop, zmp, landed, parts):
    """Turns of soles of which the right one carries 800 N around a place of it, with a ZMP wanted at another place."""
    feet, _ = straight_plan(2)
    layout = hex_layout([[-0.1, -0.07], [0.12, -0.07], [0.12, 0.07], [-0.1, 0.07]])
    layouts: dict[Side, SoleLayout] = {"left": layout, "right": layout}
    conformity = GroundConformity(GAINS, layouts, {side: np.zeros(2) for side in SIDES}, PERIOD)
    kind = PhaseKind.DOUBLE_SUPPORT if swing is None else PhaseKind.SINGLE_SUPPORT
    force = np.exp(-((layout.positions[:, :2] - cop) ** 2).sum(axis=1) / 0.03**2)
    percept = Percept(layout, Reading(1.5, 800.0 * force / force.sum()))
    places = {side: feet[side].position for side in SIDES}
    level = {side: np.eye(3) for side in SIDES}
    loads = {"left": 0.0, "right": 800.0}
    state = BaseState(np.eye(3), np.zeros(3), np.zeros(3), np.zeros(3), None, loads, places, level)
    incoming: Side | None = None if swing else "right"
    phase = Phase(kind, 0, 1.0, 2.0, swing)
    soles = dict.fromkeys(SIDES, percept)
    return conformity.update(phase, incoming, places["right"][:2] + zmp, state, soles, landed, parts)


@pytest.mark.parametrize(
    ("landed", "part", "turns"), [(False, False, True), (True, False, False), (False, True, False)]
)
def test_a_stance_foot_is_turned_where_there_may_be_more_ground(landed, part, turns):
    """A desired ZMP between both feet lies beyond the sole that carries, and beyond a seen edge there is no ground."""
    parts: dict[Side, np.ndarray] = {"right": np.zeros(2)} if part else {}
    assert ("right" in _turned("left", (0.0, 0.0), (0.0, 0.12), landed, parts)) == turns


def test_a_foot_that_takes_the_weight_over_turns_to_the_middle_of_the_part_that_carries():
    """The whole sole's middle would turn a foot that only its heel carries over the edge."""
    over = _turned(None, (-0.06, 0.0), (0.0, 0.0), True, {})
    assert over["right"].turn[1] > 0.0  # the toes go down
    assert not _turned(None, (-0.06, 0.0), (0.0, 0.0), True, {"right": np.array([-0.06, 0.0])})
