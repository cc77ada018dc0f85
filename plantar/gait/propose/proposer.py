"""Who proposes changes of the plan: what they get, what they return, and whose change comes first.

A proposer is a small object in a file of its own. At each tick it gets a frozen `Tick` and returns a `PlanChange` or
nothing; it never touches the plan. The change of one proposer is applied in a tick (see
`plantar.gait.propose.decide`); a proposer whose change was not chosen sees that in `Tick.plan.last` and proposes again
while it still wants it.
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
        omega: Its frequency in rad/s.
        dcm: Estimated DCM (2,) in m.
        reference: The plan now.
        goal: Where the plan has the DCM (2,) at the end of the phase in m.
        zmp_region: Convex polygon (k, 2) in the world in m in which the ZMP may lie, counter-clockwise.
        offset: u_w (2,) in m by which a push is expected to move the VRP off the ZMP until the phase ends (K 18).
        pushed: By how much (2,) in m pushes have lately moved the DCM, had nobody resisted.
    """

    omega: float
    dcm: NDArray[np.float64]
    reference: LipReference
    goal: NDArray[np.float64]
    zmp_region: NDArray[np.float64]
    offset: NDArray[np.float64] = read_only(np.zeros(2))
    pushed: NDArray[np.float64] = read_only(np.zeros(2))

    def beyond_zmp(self, left: float) -> tuple[float, tuple[float, float], tuple[float, float]]:
        """What keeps the DCM from its goal after some time, wherever the ZMP is kept (K 25-27).

        Plain numbers: a search over the time asks for this dozens of times in a tick.

        Args:
            left: Time in s.

        Returns:
            e^(w T) - 1; the ZMP (x, y) in m that would bring the DCM to its goal; the nearest one to it of
            `zmp_region`, which is not empty. The DCM misses its goal by the first times the way from the nearest to the
            wanted ZMP.
        """
        growth = math.expm1(self.omega * left)
        (x, y), (gx, gy), (wx, wy) = self.dcm.tolist(), self.goal.tolist(), self.offset.tolist()
        wanted = x + (x - gx) / growth + wx, y + (y - gy) / growth + wy
        return growth, wanted, nearest_place(self.zmp_region, *wanted)


class Tick(Record, frozen=True):
    """All that a proposer gets to know at one tick.

    Attributes:
        time: Time in s.
        phase: Phase of the walk.
        plan: The plan as it stands.
        feet: Where the feet are commanded.
        frame: The frame that they are commanded in.
        readings: Reading of each sole.
        loads: Vertical force on each foot in N.
        moments: Moment (2,) at each ankle in N m, where there are force-torque sensors.
        found: What feet have been found to stand on at this tick.
        seen: What the swing foot has been seen to stand on soon.
        inward: By how much in m, along its y axis, a foot that touches down now shall carry further inside.
        pendulum: Where the body is, where balance is fed back.
        firm: Whether the ground has carried every sole as a whole lately, so that a foot may be put down anywhere.
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
    """Somebody who may want the plan to change.

    Attributes:
        priority: Where its change stands among those of others.
    """

    priority: Priority

    def propose(self, tick: Tick) -> PlanChange | None:
        """What it wants to change now.

        Args:
            tick: What there is to know.

        Returns:
            The change, or None.
        """
        ...


def nearest_place(region: NDArray[np.float64], x: float, y: float) -> tuple[float, float]:
    """The place of a region that is nearest to a wanted one, in plain numbers.

    Args:
        region: Convex polygon (k, 2) in m, not empty.
        x: Wanted place in m.
        y: The same.

    Returns:
        Place (x, y) in m.

    Example:
        >>> nearest_place(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]), 2.0, 0.5)
        (1.0, 0.5)
    """
    nx, ny = closest_point(region, x, y).tolist()
    return nx, ny


def was_applied(change: PlanChange, tick: Tick) -> bool:
    """Whether a change that was proposed at the tick before was the one that was applied.

    Args:
        change: The change.
        tick: The tick now.

    Returns:
        True if the plan's last change is this one.
    """
    return tick.plan.last is not None and tick.plan.last.change is change
