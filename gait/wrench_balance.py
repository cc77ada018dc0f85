"""Balance by distributing the ground's wrench over the feet: DCM feedback, wrench distribution and foot admittance.

After Caron et al. 2019 (T 4.4.4): the DCM error, proportional and integral, asks for a net wrench; a quadratic program
shares it between the feet, each within the cone of what it stands on; ankles and legs yield until the soles feel their
shares; the CoM reference gives way a little to what is left of the ZMP error.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from gait.balance import BalanceState, FootAction, FootState
from gait.com_admittance import ComAdmittance
from gait.foot_admittance import AdmittanceGains, FootAdmittance
from gait.gains import Gains
from gait.lip import GRAVITY
from gait.vrp_plan import LipReference
from gait.wrench_distribution import DistributionWeights, WrenchDistribution
from plantar.layout import Side
from plantar.polygon import closest_point

__all__ = ["WrenchBalance", "WrenchBalanceGains"]

_NO_WRENCH = np.zeros(6)


@dataclass(frozen=True)
class WrenchBalanceGains(Gains):
    """Gains of the law.

    Attributes:
        dcm_gain: k_xi of T 4.18 in 1/s.
        dcm_integral: Gain in 1/s of the integral of the DCM error on the desired ZMP.
        dcm_forgetting: Rate in 1/s at which that integral forgets.
        largest_integral: Largest part in m that the integral may have in the desired ZMP.
        zmp_gain: How fast the CoM reference yields to a ZMP error, in 1/s (T 4.29).
        com_gain: How fast it returns to the plan, in 1/s (T 4.29).
        zmp_filter: Time constant in s of the low-pass on the measured ZMP error.
        zmp_offset: Inner offset in m that the desired ZMP keeps from the support polygon's edge.
        minimum_force: Least normal force in N of a foot that stands.
        feet: Gains of the feet's admittance.
    """

    dcm_gain: float = 3.0
    dcm_integral: float = 0.0
    dcm_forgetting: float = 0.1
    largest_integral: float = 0.03
    zmp_gain: float = 0.0
    com_gain: float = 1.0
    zmp_filter: float = 0.02
    zmp_offset: float = 0.015
    minimum_force: float = 15.0
    feet: AdmittanceGains = field(default_factory=AdmittanceGains)

    @classmethod
    def from_table(cls, table: Mapping[str, Any]) -> Self:
        """Gains of the law and of the feet's admittance from the keys that name one; other keys are left alone."""
        return replace(super().from_table(table), feet=AdmittanceGains.from_table(table))

    @classmethod
    def names(cls) -> list[str]:
        """Names of the numbers of the law, and of those of the feet's admittance, that a table may give."""
        return [*super().names(), *AdmittanceGains.names()]


class WrenchBalance:
    """DCM feedback, wrench distribution and foot admittance.

    Attributes:
        states: How often the distribution ended in which state.

    Args:
        gains: Gains of the law.
        omega: Pendulum frequency in rad/s.
        mass: Mass of the robot in kg.
        period: Control period in s.
        weights: Weights of the distribution.
    """

    wants_feet = True

    def __init__(
        self,
        gains: WrenchBalanceGains,
        omega: float,
        mass: float,
        period: float,
        weights: DistributionWeights | None = None,
    ) -> None:
        self.gains = gains
        self.omega = omega
        self.mass = mass
        self.period = period
        self.distribution = WrenchDistribution(mass * GRAVITY, weights, gains.minimum_force)
        self.feet = FootAdmittance(gains.feet, period)
        self.states: Counter[str] = Counter()
        self._integral = np.zeros(2)
        self._admittance = ComAdmittance(gains.zmp_gain, gains.com_gain, gains.zmp_filter, period)

    def update(
        self,
        reference: LipReference,
        dcm: NDArray[np.float64],
        zmp: NDArray[np.float64] | None,
        region: NDArray[np.float64],
        feet: Mapping[Side, FootState],
    ) -> BalanceState:
        """One control tick (see `gait.balance.BalanceLaw`).

        Args:
            reference: The plan now.
            dcm: Measured DCM (2,) in m.
            zmp: Measured ZMP (2,) in m, or None where no foot carries load.
            region: Convex polygon (k, 2) in which the desired ZMP has to lie; empty leaves it free.
            feet: The feet that stand.

        Returns:
            Desired ZMP, CoM reference, and what each standing foot shall carry and how it gives way.
        """
        desired = self._desired_zmp(reference, dcm, region)
        acceleration = self.omega**2 * (reference.com + self._admittance.offset - desired)
        actions = self._act(desired, acceleration, feet)
        if self.gains.zmp_gain > 0.0:
            self._admittance.update(np.zeros(2) if zmp is None else zmp - desired)
        return BalanceState(
            zmp_desired=desired,
            com=reference.com + self._admittance.offset,
            com_velocity=reference.com_velocity + self._admittance.rate,
            com_acceleration=acceleration,
            feet=actions,
        )

    def _desired_zmp(
        self, reference: LipReference, dcm: NDArray[np.float64], region: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """T 4.18 with an integral that forgets; it stands still while the region holds the desired ZMP back."""
        g, dt = self.gains, self.period
        error = dcm - reference.dcm
        wanted = reference.vrp + (1.0 + g.dcm_gain / self.omega) * error + self._integral
        nearest = closest_point(region, wanted)
        if nearest is None:
            return wanted
        if g.dcm_integral > 0.0 and math.dist(nearest, wanted) < 1e-9:
            moved = self._integral + dt * (g.dcm_integral * error - g.dcm_forgetting * self._integral)
            self._integral = np.minimum(np.maximum(moved, -g.largest_integral), g.largest_integral)
        return nearest

    def _act(
        self, desired: NDArray[np.float64], acceleration: NDArray[np.float64], feet: Mapping[Side, FootState]
    ) -> dict[Side, FootAction]:
        """Share the pendulum's wrench between the feet, and let them give way."""
        contacts = [f.contact for f in feet.values()]
        ax, ay = acceleration.tolist()
        x, y = desired.tolist()
        ratio, ground = 0.5, 0.0
        if contacts:
            places = [c.center_in_world for c in contacts]
            ground = sum(p[2] for p in places) / len(places)
            if len(places) == 2:
                ratio = _share(x, y, *places)
        # Along the line from the ZMP to the CoM: no moment about the ZMP.
        wrench = (self.mass * ax, self.mass * ay, self.mass * GRAVITY, 0.0, 0.0, 0.0)
        share = self.distribution.solve(contacts, wrench, (x, y, ground), ratio)
        self.states[share.state.value] += 1
        wanted = dict(zip(feet, share.wrenches, strict=True))
        corrections = self.feet.update(wanted, {side: foot.wrench for side, foot in feet.items()})
        return {
            side: FootAction(wanted.get(side, _NO_WRENCH), c.roll, c.pitch, c.shift) for side, c in corrections.items()
        }


def _share(x: float, y: float, first: tuple[float, ...], second: tuple[float, ...]) -> float:
    """Share of the first of two points in a ZMP (x, y) between them, 0 to 1."""
    dx, dy = first[0] - second[0], first[1] - second[1]
    length = dx * dx + dy * dy
    if length == 0.0:
        return 0.5
    return min(1.0, max(0.0, ((x - second[0]) * dx + (y - second[1]) * dy) / length))
