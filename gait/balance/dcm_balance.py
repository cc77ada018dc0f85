"""Balance feedback: DCM error moves the desired ZMP, ZMP error moves the CoM reference (T 4.17-4.20, 4.27-4.29)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from gait.balance.com_admittance import ComAdmittance
from gait.plan.vrp_plan import LipReference
from plantar.geometry.polygon import closest_point
from plantar.layouts.layout import Side
from plantar.mechanics.contact import Contact
from plantar.settings.schema import Settings, number

__all__ = ["BalanceGains", "BalanceLaw", "BalanceState", "DcmBalance", "FootAction", "FootState"]


@dataclass(frozen=True)
class BalanceGains(Settings):
    """Gains of the DCM feedback with CoM admittance.

    Attributes:
        dcm_gain: k_xi of T 4.28 in 1/s.
        zmp_gain: k_f of T 4.29 in 1/s: how fast the CoM reference yields to a ZMP error.
        com_gain: k_x of T 4.29 in 1/s: how fast the CoM reference returns to the plan.
        zmp_filter: Time constant in s of the low-pass on the measured ZMP error.
        zmp_offset: Inner offset in m that the desired ZMP keeps from the support polygon's edge.
    """

    dcm_gain: float = number(1.5, "1/s", 0, 50)
    zmp_gain: float = number(0.5, "1/s", 0, 50)
    com_gain: float = number(1.0, "1/s", 0, 50)
    zmp_filter: float = number(0.02, "s", 0, 1)
    zmp_offset: float = number(0.015, "m", 0, 0.1)


@dataclass(frozen=True)
class FootState:
    """A foot that stands, as a balance law sees it.

    Attributes:
        contact: Its sole frame in the world, the part of the sole that may be loaded, and where the plan likes its
            centre of pressure.
        wrench: Measured wrench (6,) in the sole frame about its origin, by the world on the robot.
    """

    contact: Contact
    wrench: NDArray[np.float64]


@dataclass(frozen=True)
class FootAction:
    """What a balance law wants of a foot.

    Attributes:
        wrench: Wrench (6,) in the sole frame about its origin that the ground shall exert on it.
        roll: Turn in rad of the commanded sole about its x axis.
        pitch: Turn in rad about its y axis.
        shift: Shift in m of the commanded sole upwards.
    """

    wrench: NDArray[np.float64]
    roll: float
    pitch: float
    shift: float


@dataclass(frozen=True)
class BalanceState:
    """What the balance law decided at one tick, world frame.

    Attributes:
        zmp_desired: Desired ZMP p_d (2,) in m, inside the support polygon.
        com: CoM reference (2,) in m after admittance.
        com_velocity: Its rate (2,) in m/s.
        com_acceleration: Acceleration (2,) in m/s^2 that the desired ZMP asks for.
        feet: What each foot shall do; empty for a law that leaves the feet as the plan has them.
    """

    zmp_desired: NDArray[np.float64]
    com: NDArray[np.float64]
    com_velocity: NDArray[np.float64]
    com_acceleration: NDArray[np.float64]
    feet: Mapping[Side, FootAction] = field(default_factory=dict)


class BalanceLaw(Protocol):
    """What the walking controller asks of a balance law.

    Attributes:
        wants_feet: Whether it looks at the feet; if not, `update` gets none.
        states: How often it ended in which of its named states, for the run's summary; empty for a law without states.
    """

    wants_feet: bool
    states: Counter[str]

    def update(
        self,
        reference: LipReference,
        dcm: NDArray[np.float64],
        zmp: NDArray[np.float64] | None,
        region: NDArray[np.float64],
        feet: Mapping[Side, FootState],
    ) -> BalanceState:
        """One control tick.

        Args:
            reference: The plan now.
            dcm: Measured DCM (2,) in m.
            zmp: Measured ZMP (2,) in m, or None where no foot carries load.
            region: Convex polygon (k, 2) in which the desired ZMP has to lie.
            feet: The feet that stand.

        Returns:
            What body and feet shall do.
        """
        ...


class DcmBalance:
    """DCM feedback with CoM admittance.

    Args:
        gains: The gains.
        omega: Pendulum frequency in rad/s.
        period: Control period in s.
    """

    wants_feet = False

    def __init__(self, gains: BalanceGains, omega: float, period: float) -> None:
        self.gains = gains
        self.omega = omega
        self.period = period
        self.states: Counter[str] = Counter()
        self._admittance = ComAdmittance(gains.zmp_gain, gains.com_gain, gains.zmp_filter, period)

    def desired_zmp(
        self, reference: LipReference, dcm: NDArray[np.float64], region: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Desired ZMP p_d = p_r - (1 + k_xi / w) (xi_r - xi) (T 4.28), kept in a region (T Algorithm 1).

        Args:
            reference: The plan now.
            dcm: Measured DCM (2,) in m.
            region: Convex polygon (k, 2) in the world frame, counter-clockwise, in which p_d has to lie: the support
                polygon less its safety offset; empty leaves p_d free.

        Returns:
            Desired ZMP (2,) in m.
        """
        wanted = reference.vrp - (1.0 + self.gains.dcm_gain / self.omega) * (reference.dcm - dcm)
        nearest = closest_point(region, wanted)
        return wanted if nearest is None else nearest

    def update(
        self,
        reference: LipReference,
        dcm: NDArray[np.float64],
        zmp: NDArray[np.float64] | None,
        region: NDArray[np.float64],
        feet: Mapping[Side, FootState] | None = None,
    ) -> BalanceState:
        """One control tick.

        Args:
            reference: The plan now.
            dcm: Measured DCM (2,) in m.
            zmp: Measured ZMP (2,) in m, or None where no foot carries load.
            region: Where the desired ZMP has to lie (see `desired_zmp`).
            feet: The feet that stand; this law does not need them.

        Returns:
            The desired ZMP and the CoM reference that tracks it (T 4.29 around the moving plan).
        """
        desired = self.desired_zmp(reference, dcm, region)
        self._admittance.update(np.zeros(2) if zmp is None else zmp - desired)
        com = reference.com + self._admittance.offset
        return BalanceState(
            zmp_desired=desired,
            com=com,
            com_velocity=reference.com_velocity + self._admittance.rate,
            com_acceleration=self.omega**2 * (com - desired),
        )
