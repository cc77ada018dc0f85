"""What a balance law is asked, and what it answers: the same for every law.

A tick has two questions. `update`: where shall CoM and ZMP be? Then `act`: what shall each foot carry, and how does it
give way? In between, feet may take the shape of the ground.
"""

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
    """What a balance law decided at one tick, world frame.

    Attributes:
        zmp_desired: Desired ZMP p_d (2,) in m, inside the support polygon.
        com: CoM reference (2,) in m after admittance.
        com_velocity: Its rate (2,) in m/s.
        com_acceleration: Acceleration (2,) in m/s^2 that the desired ZMP asks for.
    """

    zmp_desired: NDArray[np.float64]
    com: NDArray[np.float64]
    com_velocity: NDArray[np.float64]
    com_acceleration: NDArray[np.float64]


class FootState(Record, frozen=True):
    """A foot as a balance law sees it, command frame.

    Attributes:
        position: Commanded position (3,) of the sole frame's origin in m.
        level: Commanded rotation (3, 3) of the sole before foot damping turns it.
        rotation: The same with the turn of foot damping.
        center: Point (2,) of the sole frame in m at which the foot is to be loaded.
        contact: Its sole frame in the world, the part of the sole that may be loaded, and its desired centre of
            pressure; None in the air, or for a law that does not look at contacts.
        wrench: Measured wrench (6,) in the sole frame about its origin, by the world on the robot; None in the air,
            and for such a law while the robot walks.
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
        stance: The only foot that carries in single support, else None.
        frame: The frame that they are commanded in.
        rests: Whether the robot stands after a walk.
    """

    states: Mapping[Side, FootState]
    stance: Side | None
    frame: CommandFrame
    rests: bool = False


class FootAction(Record, frozen=True):
    """What a balance law wants of a foot: the wrench that the ground shall exert on it, and how it gives way.

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
    """What the walking controller asks of a balance law.

    Attributes:
        wants_contacts: Whether it looks at the contacts and measured wrenches of the feet; if not, it gets none.
        states: How often it ended in which of its named states, for the run's summary; empty for a law without states.
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
            zmp: Measured ZMP (2,) in m, or None where no foot carries load.
            region: Convex polygon (k, 2) in which the desired ZMP has to lie; empty leaves it free.

        Returns:
            What the body shall do.
        """
        ...

    def act(self, balanced: BalanceState, feet: Feet) -> Mapping[Side, FootAction]:
        """Share the ground's wrench between the feet.

        Args:
            balanced: What `update` decided at this tick.
            feet: The feet.

        Returns:
            What each foot shall do.
        """
        ...
