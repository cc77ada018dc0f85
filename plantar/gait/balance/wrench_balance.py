"""Balance by wrench distribution over the feet (Caron et al. 2019, T 4.4.4).

The DCM error gives a net wrench; a quadratic program shares it within wrench cones; ankles and legs yield until soles
measure their shares.
"""

from collections.abc import Mapping
from dataclasses import field, replace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.body_scale import REFERENCE_BODY, BodyScale
from plantar.common.settings.schema import Setting, fixed, number, share
from plantar.common.settings.unknown_keys import refuse_unknown_keys
from plantar.errors import InputError, PlantarError
from plantar.gait.balance.dcm_balance import DcmBalance
from plantar.gait.balance.foot_admittance import AdmittanceGains
from plantar.gait.balance.law import BalanceLaw, BalanceState, Feet, FootAction, LawGains
from plantar.kernels.gait.sole_admittance import pressed
from plantar.layouts.layout import Side
from plantar.mechanics.contact import Contact
from plantar.mechanics.lip import GRAVITY
from plantar.mechanics.wrench_distribution import DistributionWeights, WrenchDistribution

_NO_WRENCH = np.zeros(6)
# derived: leg: lever that makes moments as large as forces in the distribution; 0.1 m for a leg of 0.6 m
_LENGTH = 1 / 6


class WrenchBalanceGains(LawGains):
    """Gains of the law.

    Attributes:
        dcm_gain: k_xi of T 4.18 in 1/s.
        zmp_gain: CoM reference's yield to ZMP error in 1/s (T 4.29).
        com_gain: Its return to the plan in 1/s (T 4.29).
        feet: Admittance of the feet.
    """

    # chosen: 3 1/s, twice T Table 2's; the distribution has no ZMP feedback of its own
    dcm_gain: float = share(0.742, "1/beat", 0, 50)
    zmp_gain: float = number(0.0, "1/s", 0, 50)
    com_gain: float = share(0.247, "1/beat", 0, 50)  # nature: T Table 2, 1 1/s
    # Low-pass time constant in s of the ZMP error; derived: as of `BalanceGains`
    zmp_filter: float = fixed(0.0809, "beat")
    # Normal force in N of a standing foot; chosen: 15 N on h1, above the noise of a sole's sum
    minimum_force: float = fixed(0.0178, "weight")
    feet: AdmittanceGains = field(default_factory=AdmittanceGains)

    def law(self, omega: float, mass: float, period: float) -> BalanceLaw:
        """DCM feedback with wrench distribution."""
        return WrenchBalance(self, omega, mass, period)

    @classmethod
    def from_table(cls, table: Any, where: str, error: type[PlantarError] = InputError, note: str = "") -> Self:
        """Returns gains of the law and the feet from one `table`; `where`, `error` and `note` are for messages."""
        refuse_unknown_keys(table, cls.names(), where, error, note)
        feet = {k: v for k, v in table.items() if k in AdmittanceGains.names()}
        own = {k: v for k, v in table.items() if k not in feet}
        return replace(super().from_table(own, where, error), feet=AdmittanceGains.from_table(feet, where, error))

    @classmethod
    def names(cls) -> tuple[str, ...]:
        """A table's allowed keys."""
        return (*super().names(), *AdmittanceGains.names())

    @classmethod
    def described(cls, body: BodyScale = REFERENCE_BODY) -> tuple[Setting, ...]:
        """All described settings."""
        return (*super().described(body), *AdmittanceGains.described(body))


class WrenchBalance(DcmBalance):
    """DCM feedback, wrench distribution and foot admittance.

    `omega`: pendulum's in rad/s; `mass`: robot's in kg; `period` of control in s; `weights`: for the distribution,
    whose end states `states` counts.
    """

    wants_contacts = True
    _offset_first = False

    def __init__(
        self,
        gains: WrenchBalanceGains,
        omega: float,
        mass: float,
        period: float,
        weights: DistributionWeights | None = None,
    ) -> None:
        super().__init__(gains, omega, mass, period, gains.feet)
        self.distribution = WrenchDistribution(mass * GRAVITY, weights, gains.minimum_force, _LENGTH * gains.body.leg)

    def act(self, balanced: BalanceState, feet: Feet) -> Mapping[Side, FootAction]:
        """Returns standing `feet` that share the pendulum's wrench by `balanced`, and yield."""
        states = feet.states
        wanted = self.distributed(balanced, feet)
        measured = {side: foot.wrench for side, foot in states.items() if foot.wrench is not None}
        actions = {}
        for side, yields in self.feet.update(wanted, measured, feet.rests).items():
            foot = states[side]
            force, place = pressed(wanted.get(side, _NO_WRENCH), foot.level, foot.position, foot.center)
            actions[side] = FootAction(force, place, yields.roll, yields.pitch, yields.shift)
        return actions

    def distributed(self, balanced: BalanceState, feet: Feet) -> Mapping[Side, NDArray[np.float64]]:
        """Returns the world's wrench (6,) on each standing one of `feet` about its sole frame's origin; their sum is
        the pendulum's by `balanced`.
        """
        contacts: dict[str, Contact] = {
            side: foot.contact for side, foot in feet.states.items() if foot.contact is not None
        }
        ax, ay = balanced.com_acceleration.tolist()
        x, y = balanced.zmp_desired.tolist()
        places = [contact.center_in_world for contact in contacts.values()]
        shares = None
        ground = sum(place[2] for place in places) / max(1, len(places))
        if len(places) == 2:
            share = _share(x, y, *places)
            shares = dict(zip(contacts, (share, 1.0 - share), strict=True))
        # Along the line from the ZMP to the CoM: no moment about the ZMP.
        wrench = (self.mass * ax, self.mass * ay, self.mass * GRAVITY, 0.0, 0.0, 0.0)
        found = self.distribution.solve(contacts, wrench, (x, y, ground), shares)
        self.states[str(found.state)] += 1
        return found.wrenches  # type: ignore[return-value]  # of the same names as the contacts


def _share(x: float, y: float, first: tuple[float, ...], second: tuple[float, ...]) -> float:
    """First point's share in a ZMP (x, y) between two, 0 to 1."""
    dx = first[0] - second[0]
    dy = first[1] - second[1]
    length = dx * dx + dy * dy
    if length == 0.0:
        return 0.5
    return min(1.0, max(0.0, ((x - second[0]) * dx + (y - second[1]) * dy) / length))
