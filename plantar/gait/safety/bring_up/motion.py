"""How a robot moves while it is checked: it stands, leans, turns its torso, and shifts its weight from foot to foot."""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.gait.command import Command
from plantar.gait.plan.vrp_plan import VrpPlan
from plantar.mechanics.rotation import rotation_from_vector

_LEAN = 0.01  # m that the VRP moves each way; drawn plants show it ten times as clearly as noise
_TILT = 0.05  # rad that the torso turns about each axis
_SHARE = 0.85  # of the weight on one foot at most; what the other keeps holds robots whose CoM lies elsewhere

STOOD = 0.5
"""End in s of standing still."""

ROLLED = 1.2
"""End in s of the torso's roll, after which the ZMP to the left is that of a body that does not turn."""

PITCHES = 2.0
"""Begin in s of its pitch, before which the ZMP forward is likewise."""

LEANED = 3.2
"""End in s of leaning and turning."""

UNLOADED = 5.95
"""End in s of shifting weight, and of coming to rest."""

# Knots of VRP: time in s, share of the lean forward and to the left
_LEANS = (
    *((0.0, 0, 0), (0.5, 0, 0), (0.65, 1, 0), (0.95, 1, 0), (1.25, -1, 0), (1.55, -1, 0), (1.7, 0, 0)),
    *((1.85, 0, 0), (2.0, 0, 1), (2.3, 0, 1), (2.6, 0, -1), (2.9, 0, -1), (3.05, 0, 0), (3.2, 0, 0)),
)
# And of the weight beyond half that the left foot carries
_SHIFTS = ((3.2, 0), (3.7, 1), (4.0, 1), (4.6, -1), (4.9, -1), (5.3, 0), (5.95, 0))
_RETURN = (5.2, 5.9)  # in which what the CoM would still be off at the end is taken back
_ROLL = (0.5, ROLLED)
_YAW = (1.2, 1.9)
_PITCH = (PITCHES, 2.9)


class BringUpMotion:
    """Commands over time.

    Args:
        stand: Command of a standing robot.
        vrps: VRP (2,) over each foot, world frame, in m.
        omega: Pendulum's in rad/s.
    """

    def __init__(self, stand: Command, vrps: Mapping[Side, NDArray[np.float64]], omega: float) -> None:
        self._stand = stand
        self._vrps = vrps
        self._omega = omega
        self._middle = 0.5 * (vrps["left"] + vrps["right"])
        self._across = vrps["left"] - vrps["right"]
        self._forward = stand.rotation_torso[:2, 0]
        self._left = stand.rotation_torso[:2, 1]
        self._weight = sum(float(foot.force[2]) for foot in stand.feet.values())
        times = [time for time, _, _ in _LEANS]
        points = [self._middle + _LEAN * (x * self._forward + y * self._left) for _, x, y in _LEANS]
        self._plan = VrpPlan(times, points, omega)
        self._left_over = np.zeros(2)

    def shift(self, off: float) -> None:
        """Plan the shifts of weight of a robot whose left foot carries a share of `off` more than half."""
        points = [self._middle + ((_SHARE - 0.5) * share - off * abs(share)) * self._across for _, share in _SHIFTS]
        begin = self._plan.at(_SHIFTS[0][0]).com
        self._plan = VrpPlan([time for time, _ in _SHIFTS], points, self._omega, begin)
        self._left_over = self._plan.at(UNLOADED).com - self._middle

    def at(self, time: float) -> Command:
        """Command at a time in s."""
        reference = self._plan.at(time)
        com = reference.com - _ramp(time, _RETURN) * self._left_over
        moved = reference.vrp - self._middle
        turn = _TILT * np.array([_bump(time, _ROLL), _bump(time, _PITCH), _bump(time, _YAW)])
        share = float(moved @ self._across / (self._across @ self._across)) + 0.5
        shares: dict[Side, float] = {"left": min(1.0, max(0.0, share)), "right": min(1.0, max(0.0, 1.0 - share))}
        along = float(moved @ self._forward) * self._forward
        feet = {
            side: self._stand.feet[side].changed(
                force=np.array([0.0, 0.0, self._weight * shares[side]]),
                center_of_pressure=self._vrps[side] + along,
            )
            for side in SIDES
        }
        return self._stand.changed(
            com=np.array([*com, self._stand.com[2]]),
            rotation_torso=self._stand.rotation_torso @ rotation_from_vector(turn),
            feet=feet,
            reference=reference,
            zmp_desired=reference.vrp,  # the plan's own: nothing is balanced yet, which motors go by
        )


def _bump(time: float, span: tuple[float, float]) -> float:
    """From 0 to 1 and back to 0, without a jump in speed."""
    share = (time - span[0]) / (span[1] - span[0])
    return 0.5 - 0.5 * math.cos(2.0 * math.pi * share) if 0.0 < share < 1.0 else 0.0


def _ramp(time: float, span: tuple[float, float]) -> float:
    """From 0 to 1, without a jump in speed."""
    share = min(1.0, max(0.0, (time - span[0]) / (span[1] - span[0])))
    return share * share * (3.0 - 2.0 * share)
