"""Balance laws: `update` (CoM, ZMP), then `act` (each foot), each tick."""

from collections import Counter
from collections.abc import Mapping
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from plantar.common.record import Record
from plantar.common.settings.part import Part
from plantar.common.settings.schema import fixed
from plantar.common.sides import Side
from plantar.gait.plan.vrp_plan import LipReference
from plantar.kernels.gait.command_frame import CommandFrame
from plantar.mechanics.contact import Contact


class BalanceState(Record, frozen=True):
    """A balance law's decision, world frame.

    `zmp_desired`: p_d (2,) in m, in the support polygon; `com`: reference (2,) in m after admittance; `com_velocity`:
    its rate (2,) in m/s; `com_acceleration`: for the desired ZMP (2,) in m/s^2.
    """

    zmp_desired: NDArray[np.float64]
    com: NDArray[np.float64]
    com_velocity: NDArray[np.float64]
    com_acceleration: NDArray[np.float64]


class FootState(Record, frozen=True):
    """A foot as balance laws see it, command frame.

    `position`: commanded sole origin (3,) in m; `level`: sole's commanded rotation (3, 3) before foot damping;
    `rotation`: the same after foot damping; `center`: point (2,) of the sole in m to load; `contact`: frame in the
    world, loadable part, desired center of pressure; None in the air or without `wants_contacts`; `wrench`: measured
    (6,), sole frame, about its origin, by the world; None in the air, or while walking without it.
    """

    position: NDArray[np.float64]
    level: NDArray[np.float64]
    rotation: NDArray[np.float64]
    center: NDArray[np.float64]
    contact: Contact | None = None
    wrench: NDArray[np.float64] | None = None


class Feet(Record, frozen=True):
    """Both feet at a tick.

    `stance`: single support's carrying foot, else None; `frame`: command frame; `rests`: whether the robot stands after
    a walk.
    """

    states: Mapping[Side, FootState]
    stance: Side | None
    frame: CommandFrame
    rests: bool = False


class FootAction(Record, frozen=True):
    """Ground's desired wrench on a foot, and its yielding.

    `force` (3,) in N, command frame; `center_of_pressure` (2,), command frame, in m, without a horizontal moment;
    `roll`: sole's turn in rad about its x axis; `pitch`: about its y axis in rad; `shift`: sole's in m upwards.
    """

    force: NDArray[np.float64]
    center_of_pressure: NDArray[np.float64]
    roll: float = 0.0
    pitch: float = 0.0
    shift: float = 0.0


class BalanceLaw(Protocol):
    """Protocol of a balance law.

    `wants_contacts`: whether it needs the feet's contacts and measured wrenches; `states`: counts of its named end
    states; empty without states.
    """

    wants_contacts: bool
    states: Counter[str]

    def update(
        self,
        reference: LipReference,
        dcm: NDArray[np.float64],
        zmp: NDArray[np.float64] | None,
        region: NDArray[np.float64],
        firm: bool = True,
    ) -> BalanceState:
        """Decide on CoM and ZMP.

        `dcm`: measured (2,) in m; `zmp`: measured (2,) in m; None if no foot is loaded; `region`: for the desired ZMP:
        convex (k, 2), world, in m; empty for no limit; `firm`: whether feet can go anywhere.
        """
        ...

    def act(self, balanced: BalanceState, feet: Feet) -> Mapping[Side, FootAction]:
        """Share the ground's wrench between the feet."""
        ...


class LawGains(Part, table="balance"):
    """Gains of a balance law, which makes the law; `law` in `[balance]` names it.

    Laws of other packages use the entry points "plantar.balance_laws".
    """

    # Inner offset in m that the desired ZMP keeps from the support polygon's edge; chosen: 15 mm of 250: more takes the
    # room to balance, less lets noise of the ZMP reach the edge
    zmp_offset: float = fixed(0.06, "sole")

    def law(self, omega: float, mass: float, period: float) -> BalanceLaw:
        """Returns the law with these gains.

        Args:
            omega: Pendulum's frequency in rad/s.
            mass: Robot's in kg.
            period: Of control in s.
        """
        raise NotImplementedError
