"""Interface of balance laws: each tick calls `update` (CoM and ZMP), then `act` (load and yielding of each foot)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from plantar.gait.estimate.command_frame import CommandFrame
from plantar.gait.plan.vrp_plan import LipReference
from plantar.mechanics.contact import Contact
from plantar.record import Record
from plantar.sides import Side

__all__ = ["BalanceLaw", "BalanceState", "Feet", "FootAction", "FootState"]


class BalanceState(Record, frozen=True):
    """Decision of a balance law at one tick, world frame.

    Attributes:
        zmp_desired: Desired ZMP p_d (2,) in m, inside the support polygon.
        com: CoM reference (2,) in m after admittance.
        com_velocity: Its rate (2,) in m/s.
        com_acceleration: Acceleration (2,) in m/s^2 for the desired ZMP.
    """

    zmp_desired: NDArray[np.float64]
    com: NDArray[np.float64]
    com_velocity: NDArray[np.float64]
    com_acceleration: NDArray[np.float64]


class FootState(Record, frozen=True):
    """Input of a balance law for a foot, command frame.

    Attributes:
        position: Commanded position (3,) of the sole frame's origin in m.
        level: Commanded rotation (3, 3) of the sole before foot damping.
        rotation: The same after foot damping.
        center: Point (2,) of the sole frame in m at which the foot should be loaded.
        contact: Its sole frame in the world, loadable part and desired centre of pressure; None in the air, or for a
            law without `wants_contacts`.
        wrench: Measured wrench (6,) in the sole frame about its origin, by the world on the robot; None in the air, and
            for such a law while the robot walks.
    """

    position: NDArray[np.float64]
    level: NDArray[np.float64]
    rotation: NDArray[np.float64]
    center: NDArray[np.float64]
    contact: Contact | None = None
    wrench: NDArray[np.float64] | None = None


class Feet(Record, frozen=True):
    """Both feet at a tick.

    Attributes:
        states: Each foot.
        stance: The only carrying foot in single support, else None.
        frame: The frame that they are commanded in.
        rests: Whether the robot stands after a walk.
    """

    states: Mapping[Side, FootState]
    stance: Side | None
    frame: CommandFrame
    rests: bool = False


class FootAction(Record, frozen=True):
    """Desired wrench of the ground on a foot, and how the foot yields.

    Attributes:
        force: Force (3,) in N, command frame.
        center_of_pressure: Point (2,) of the command frame in m at which it acts, without a horizontal moment.
        roll: Turn in rad of the commanded sole about its x axis.
        pitch: Turn in rad about its y axis.
        shift: Shift in m of the commanded sole upwards.
    """

    force: NDArray[np.float64]
    center_of_pressure: NDArray[np.float64]
    roll: float = 0.0
    pitch: float = 0.0
    shift: float = 0.0


class BalanceLaw(Protocol):
    """Protocol of a balance law.

    Attributes:
        wants_contacts: Whether it needs contacts and measured wrenches of the feet.
        states: Counts of its named end states, for the run's summary; empty for a law without states.
    """

    wants_contacts: bool
    states: Counter[str]

    def update(
        self,
        reference: LipReference,
        dcm: NDArray[np.float64],
        zmp: NDArray[np.float64] | None,
        region: NDArray[np.float64],
    ) -> BalanceState:
        """Decide on CoM and ZMP.

        Args:
            reference: The plan now.
            dcm: Measured DCM (2,) in m.
            zmp: Measured ZMP (2,) in m, or None where no foot is loaded.
            region: Convex polygon (k, 2) in the world in m for the desired ZMP; empty does not limit it.

        Returns:
            The decision.
        """
        ...

    def act(self, balanced: BalanceState, feet: Feet) -> Mapping[Side, FootAction]:
        """Share the ground's wrench between the feet.

        Args:
            balanced: Result of `update` at this tick.
            feet: The feet.

        Returns:
            Action of each foot.
        """
        ...
