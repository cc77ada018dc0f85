"""Balance feedback: DCM error moves the desired ZMP, ZMP error moves the CoM reference (T 4.17-4.18, 4.27-4.29)."""

from collections import Counter
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import fixed, share
from plantar.common.sides import Side
from plantar.gait.balance.foot_admittance import AdmittanceGains, FootAdmittance
from plantar.gait.balance.law import BalanceLaw, BalanceState, Feet, FootAction, FootState, LawGains
from plantar.gait.balance.load_transfer import transferred
from plantar.gait.plan.vrp_plan import LipReference
from plantar.kernels.gait.dcm_feedback import ComAdmittance, DcmFeedback

_LARGEST_OFFSET = 0.5  # derived: leg that the CoM's reference may be off its plan: no foot reaches both from there
# derived: sole that ankles move the ZMP by: half a sole's width less the margin; beyond, the CoM goes along
_HELD = 0.22
_PRESS = 0.5  # measured: 1/beat at which it then brings the ZMP to the desired one; four times that rattles
# measured: of the ZMP's error, which feet that stand give way to; all of it lets a push tip the robot over
_ZMP_SHARE = 0.3


class BalanceGains(LawGains):
    """Gains of the DCM feedback with CoM admittance.

    Attributes:
        dcm_gain: k_xi of T 4.28 in 1/s.
        zmp_gain: k_f of T 4.29 in 1/s: the CoM reference yields to ZMP error.
        com_gain: k_x of T 4.29 in 1/s: the CoM reference returns to the plan.
    """

    dcm_gain: float = share(0.371, "1/beat", 0, 50)  # nature: T Table 2, 1.5 1/s
    zmp_gain: float = share(0.124, "1/beat", 0, 50)  # nature: T Table 2, 0.5 1/s
    com_gain: float = share(0.247, "1/beat", 0, 50)  # nature: T Table 2, 1 1/s
    # Low-pass time constant in s of the ZMP error; chosen: 20 ms, between the delay of sensors and the 0.28 s of the
    # pendulum
    zmp_filter: float = fixed(0.0809, "beat")

    def law(self, omega: float, mass: float, period: float) -> BalanceLaw:
        """DCM feedback with CoM admittance."""
        return DcmBalance(self, omega, mass, period)


class DcmBalance:
    """DCM feedback with CoM admittance.

    `omega`: pendulum's in rad/s; `mass`: robot's in kg; `period` of control in s.
    """

    wants_contacts = False
    _offset_first = True  # the CoM's acceleration counts its offset of the same tick

    def __init__(
        self,
        gains: Any,
        omega: float,
        mass: float,
        period: float,
        admittance: AdmittanceGains | None = None,
    ) -> None:
        self.mass = mass
        self.states: Counter[str] = Counter()
        self._zmp: NDArray[np.float64] | None = None
        self.feet = FootAdmittance(admittance or AdmittanceGains().for_body(gains.body), period)
        largest = _LARGEST_OFFSET * gains.body.leg
        com = ComAdmittance(gains.zmp_gain, gains.com_gain, gains.zmp_filter, period, largest)
        # At xi = xi_r the desired ZMP is the planned VRP; a DCM that is off has its error driven to zero at the rate
        # k_xi (T 4.18, 4.28).
        along = _HELD * gains.body.sole, _PRESS / gains.body.beat
        self._feedback = DcmFeedback(omega, gains.dcm_gain, period, com, self._offset_first, *along)

    def update(
        self,
        reference: LipReference,
        dcm: NDArray[np.float64],
        zmp: NDArray[np.float64] | None,
        region: NDArray[np.float64],
        firm: bool = True,
    ) -> BalanceState:
        """Returns the desired ZMP by `reference` and measured `dcm`, kept in `region` (T 4.28), and the CoM
        that tracks it by `zmp` (T 4.29), or, where `firm`, falls along.
        """
        plan = reference
        self._zmp = zmp
        return BalanceState(
            *self._feedback.decide(plan.vrp, plan.dcm, plan.com, plan.com_velocity, dcm, zmp, region, firm)
        )

    def act(self, balanced: BalanceState, feet: Feet) -> Mapping[Side, FootAction]:
        """Returns each foot's load by `balanced`; `feet` at rest yield to mutual pressure and part of the ZMP error."""
        actions = transferred(balanced, self.mass, feet)
        if not feet.rests:
            self.feet.fade()
            return self._yielding(actions) if self.feet.acts else actions
        wanted = {}
        measured = {}
        if self._zmp is not None:
            zmp = self._zmp + _ZMP_SHARE * (balanced.zmp_desired - self._zmp)
            still = balanced.changed(zmp_desired=zmp, com_acceleration=np.zeros(2))
            for side, action in transferred(still, self.mass, feet).items():
                foot = feet.states[side]
                if foot.wrench is not None:
                    wanted[side] = _wrench_in_sole(action, foot)
                    measured[side] = foot.wrench
        self.feet.update(wanted, measured, rests=True)
        return self._yielding(actions)

    def _yielding(self, actions: dict[Side, FootAction]) -> dict[Side, FootAction]:
        """Loads with the feet's corrections."""
        for side, moved in self.feet.corrections.items():
            if moved.roll or moved.pitch or moved.shift:
                actions[side] = actions[side].changed(roll=moved.roll, pitch=moved.pitch, shift=moved.shift)
        return actions


def _wrench_in_sole(action: FootAction, foot: FootState) -> NDArray[np.float64]:
    """Wrench (6,) of a foot's desired force about a sole's origin, level to first order."""
    force = action.force
    place = foot.rotation[:2, :2].T @ (action.center_of_pressure - foot.position[:2])
    return np.array([0.0, 0.0, force[2], place[1] * force[2], -place[0] * force[2], 0.0])
