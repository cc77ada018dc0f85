"""What a balance law has to keep."""

from collections import Counter

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.body_scale import REFERENCE_BODY
from plantar.common.sides import SIDES, Side
from plantar.gait.balance.law import BalanceLaw, BalanceState, Feet, FootAction, FootState, LawGains
from plantar.gait.plan.vrp_plan import LipReference
from plantar.kernels.gait.command_frame import CommandFrame
from plantar.mechanics.contact import Contact
from plantar.mechanics.lip import GRAVITY
from plantar.mechanics.wrench_cone import Rectangle

_OMEGA = 3.5  # rad/s of a pendulum 0.8 m high
_MASS = 60.0  # kg
_PERIOD = 0.005  # s of control
_HALF, _WIDE = 0.12, 0.06  # m of half a sole
_SOLE = Rectangle(-_HALF, _HALF, -_WIDE, _WIDE)
_PLACES = {"left": np.array([0.0, 0.1, 0.0]), "right": np.array([0.0, -0.1, 0.0])}
_RING = np.array([[-_HALF, -_WIDE], [_HALF, -_WIDE], [_HALF, _WIDE], [-_HALF, _WIDE]])
_BOTH = np.array([[-_HALF, -0.16], [_HALF, -0.16], [_HALF, 0.16], [-_HALF, 0.16]])
_ERRORS = ((0.01, 0.0), (0.0, -0.02), (-0.05, 0.03), (0.3, 0.3))  # m of the DCM, the last beyond any sole
_OUTSIDE = 1e-6  # m by which rounding may leave the region
_WEIGHT = 0.05  # share of the weight by which the vertical forces may differ from it


def check_balance_law(gains: LawGains) -> list[str]:
    """What a balance law lacks, a sentence each; empty if nothing.

    It balances a robot that stands, with its DCM on the plan and off it, and shares the load of both feet and of one.

    Args:
        gains: An instance of its class.

    Returns:
        The sentences.
    """
    law = gains.for_body(REFERENCE_BODY).law(_OMEGA, _MASS, _PERIOD)
    lacks = []
    if not isinstance(getattr(law, "wants_contacts", None), bool):
        lacks.append("wants_contacts is not true or false")
    if not isinstance(getattr(law, "states", None), Counter):
        lacks.append("states is no collections.Counter")
    if lacks:
        return lacks
    stances: tuple[Side | None, ...] = (None, *SIDES)
    for stance in stances:
        for x, y in ((0.0, 0.0), *_ERRORS):
            where = "on both feet" if stance is None else f"on the {stance} foot"
            where += f" with the DCM ({x:g}, {y:g}) m off"
            lacks += [f"{where}: {text}" for text in _lacks_at(gains, np.array([x, y]), stance)]
    return lacks


def _lacks_at(gains: LawGains, error: NDArray[np.float64], stance: Side | None) -> list[str]:
    """What a law lacks whose DCM is off by an error (2,) in m, on both feet or on one."""
    law = gains.for_body(REFERENCE_BODY).law(_OMEGA, _MASS, _PERIOD)
    middle = np.zeros(2) if stance is None else _PLACES[stance][:2]
    still = np.zeros(2)
    region = _BOTH if stance is None else _RING + middle
    reference = LipReference(middle, middle, still, middle, still, still)
    balanced = law.update(reference, middle + error, middle, region)
    if not isinstance(balanced, BalanceState):
        return [f"update() returns a {type(balanced).__name__}; expected a BalanceState"]
    for name in ("zmp_desired", "com", "com_velocity", "com_acceleration"):
        value = np.asarray(getattr(balanced, name), dtype=float)
        if value.shape != (2,) or not np.isfinite(value).all():
            return [f"{name} is no finite (2,)"]
    lacks = []
    moved = balanced.zmp_desired - middle
    if np.any(balanced.zmp_desired > region.max(axis=0) + _OUTSIDE) or np.any(
        balanced.zmp_desired < region.min(axis=0) - _OUTSIDE
    ):
        lacks.append("the desired ZMP is outside the region")
    if moved @ error < -_OUTSIDE:
        lacks.append("the desired ZMP is moved against the DCM's error, which then grows faster")
    if not error.any() and np.linalg.norm(moved) > _OUTSIDE:
        lacks.append("the desired ZMP leaves the plan where nothing is off")
    return lacks + _lacks_of_loads(law, balanced, _feet(law, stance))


def _feet(law: BalanceLaw, stance: Side | None) -> Feet:
    """Feet that stand level, or one that stands and one in the air."""
    states = {}
    for side in SIDES:
        contact = None
        wrench = None
        if law.wants_contacts and stance in (None, side):
            contact = Contact(_PLACES[side], np.eye(3), _SOLE)
            share = 0.5 if stance is None else 1.0
            wrench = np.array([0.0, 0.0, share * _MASS * GRAVITY, 0.0, 0.0, 0.0])
        states[side] = FootState(_PLACES[side], np.eye(3), np.eye(3), _PLACES[side][:2], contact, wrench)
    return Feet(states, stance, CommandFrame(np.zeros(3), _PERIOD, 0.3))


def _lacks_of_loads(law: BalanceLaw, balanced: BalanceState, feet: Feet) -> list[str]:
    actions = law.act(balanced, feet)
    if set(actions) != set(SIDES) or not all(isinstance(action, FootAction) for action in actions.values()):
        return ["act() returns no FootAction of each side"]
    vertical = {side: float(action.force[2]) for side, action in actions.items()}
    weight = _MASS * GRAVITY
    lacks = []
    if not abs(sum(vertical.values()) - weight) <= _WEIGHT * weight:
        lacks.append(f"the feet press with {sum(vertical.values()):.0f} N; the robot weighs {weight:.0f} N")
    if min(vertical.values()) < 0.0:
        lacks.append("the ground pulls at a foot")
    if feet.stance is not None and any(force > 0.0 for side, force in vertical.items() if side != feet.stance):
        lacks.append("the foot in the air is loaded")
    return lacks
