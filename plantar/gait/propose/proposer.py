"""Proposers of plan changes: what they receive, what they return, and whose change comes first.

At each tick a proposer receives a frozen `Tick` and returns a `PlanChange` or None; `Tick.plan.last` is the applied
one.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from enum import IntEnum
from types import MappingProxyType
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from plantar.arrays import read_only
from plantar.gait.contact.foot_contacts import FootholdFound, FootholdSeen
from plantar.gait.estimate.command_frame import CommandFrame
from plantar.gait.plan.feet_view import FeetView
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.plan.phases import Phase
from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.plan.vrp_plan import LipReference
from plantar.gait.plan.walk_plan import PlanView
from plantar.kernels.geometry.convex import closest_point
from plantar.record import Record
from plantar.sensing.reading import Reading
from plantar.sides import Side

__all__ = ["Pendulum", "Priority", "Proposer", "Tick", "nearest_place", "was_applied"]


class Priority(IntEnum):
    """Whose change is applied where several propose one, the first one first."""

    SAFETY = 0
    """A foothold that is not trusted: nothing may put weight on it."""
    FOOTHOLD = 1
    """What a foot stands on, or will: the VRP has to lie over it."""
    TIMING = 2
    """When the swing foot comes down, by where the DCM is."""
    COMMAND = 3
    """What a user wants: it can wait for a tick."""


class Pendulum(Record, frozen=True):
    """The pendulum at one tick.

    Attributes:
        omega: Frequency in rad/s.
        dcm: Estimated DCM (2,) in m.
        reference: The plan now.
        goal: Planned DCM (2,) in m at the end of the phase.
        zmp_region: Convex polygon (k, 2) in the world in m in which the ZMP may lie, counter-clockwise.
        offset: u_w (2,) in m by which a push is expected to move the VRP off the ZMP until the phase ends (K 18).
        pushed: Distance (2,) in m by which recent pushes would have moved an unbalanced DCM.
    """

    omega: float
    dcm: NDArray[np.float64]
    reference: LipReference
    goal: NDArray[np.float64]
    zmp_region: NDArray[np.float64]
    offset: NDArray[np.float64] = read_only(np.zeros(2))
    pushed: NDArray[np.float64] = read_only(np.zeros(2))

    def beyond_zmp(self, left: float) -> tuple[float, tuple[float, float], tuple[float, float]]:
        """What keeps the DCM from its goal after `left` seconds T, for the best ZMP in the region (K 25-27), in plain
        numbers.

        Returns:
            e^(w T) - 1; the ZMP (x, y) in m that would bring the DCM to its goal; the nearest one of `zmp_region`,
            which is not empty. The DCM misses its goal by the first times the distance between these two.
        """
        growth = math.expm1(self.omega * left)
        (x, y), (gx, gy), (wx, wy) = self.dcm.tolist(), self.goal.tolist(), self.offset.tolist()
        wanted = x + (x - gx) / growth + wx, y + (y - gy) / growth + wy
        return growth, wanted, nearest_place(self.zmp_region, *wanted)


class Tick(Record, frozen=True):
    """What proposers receive at one tick.

    Attributes:
        time: Time in s.
        phase: Phase of the walk.
        plan: The current plan.
        feet: Commanded feet.
        frame: The frame that they are commanded in.
        readings: Reading of each sole.
        loads: Vertical force on each foot in N.
        moments: Moment (2,) at each ankle in N m, where there are force-torque sensors.
        found: What feet have been found to stand on at this tick.
        seen: What the swing foot has been seen to stand on soon.
        inward: Distance in m along its y axis by which a foot that touches down now should carry further inside.
        pendulum: The pendulum, where balance is fed back.
        firm: Whether the ground has lately carried every sole as a whole, so that a foot may be put down anywhere.
    """

    time: float
    phase: Phase
    plan: PlanView
    feet: FeetView
    frame: CommandFrame
    readings: Mapping[Side, Reading] = MappingProxyType({})
    loads: Mapping[str, float] = MappingProxyType({})
    moments: Mapping[Side, NDArray[np.float64]] = MappingProxyType({})
    found: tuple[FootholdFound, ...] = ()
    seen: FootholdSeen | None = None
    inward: float = 0.0
    pendulum: Pendulum | None = None
    firm: bool = True

    def place(self, side: Side) -> Footstep:
        """Where a foot is commanded, as a level place in the world without its height."""
        position, yaw = self.feet.footholds[side]
        x, y, _ = self.frame.to_world(position).tolist()
        return Footstep(side, x, y, yaw + self.frame.turn)


class Proposer(Protocol):
    """Proposes changes of the plan.

    Attributes:
        priority: Its rank among proposers.
    """

    priority: Priority

    def propose(self, tick: Tick) -> PlanChange | None:
        """Its change at this tick, or None."""
        ...


def nearest_place(region: NDArray[np.float64], x: float, y: float) -> tuple[float, float]:
    """Returns the place of a region that is nearest to a wanted one, in plain numbers.

    Args:
        region: Convex polygon (k, 2) in m, not empty.
        x: Wanted place in m.
        y: The same.

    Example:
        >>> nearest_place(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]), 2.0, 0.5)
        (1.0, 0.5)
    """
    nx, ny = closest_point(region, x, y).tolist()
    return nx, ny


def was_applied(change: PlanChange, tick: Tick) -> bool:
    """Returns whether a change, proposed at the tick before `tick`, was applied."""
    return tick.plan.last is not None and tick.plan.last.change is change
