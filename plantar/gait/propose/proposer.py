"""Proposers of plan changes: input, result and priority.

Each tick a proposer receives a frozen `Tick` and returns a `PlanChange` or None; `Tick.plan.last` is the applied one.
"""

from collections.abc import Mapping
from enum import IntEnum
from types import MappingProxyType
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from plantar.common.record import Record
from plantar.common.sides import Side
from plantar.gait.contact.foot_contacts import FootholdFound, FootholdSeen
from plantar.gait.estimate.push_estimate import NO_PUSH
from plantar.gait.plan.feet_view import FeetView
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.plan.phases import Phase
from plantar.gait.plan.plan_change import PlanChange
from plantar.gait.plan.vrp_plan import LipReference
from plantar.gait.plan.walk_plan import PlanView
from plantar.kernels.gait.command_frame import CommandFrame
from plantar.kernels.gait.pendulum_miss import best_zmp
from plantar.sensing.reading import Reading


class Priority(IntEnum):
    """Rank of proposed changes, the first applied.

    Attributes:
        SAFETY: A foothold that is not trusted: nothing may put weight on it.
        FOOTHOLD: What a foot stands on, or will: the VRP has to lie over it.
        TIMING: When the swing foot comes down, by where the DCM is.
        COMMAND: What a user wants: it can wait for a tick.
    """

    SAFETY = 0
    FOOTHOLD = 1
    TIMING = 2
    COMMAND = 3


class Pendulum(Record, frozen=True):
    """The pendulum at a tick.

    `omega`: frequency in rad/s; `dcm`: estimate (2,) in m; `goal`: planned DCM (2,) in m at the phase's end;
    `zmp_region`: allowed ZMP: convex (k, 2), world, in m, counter-clockwise; `offset`: push's u_w (2,) in m of the VRP
    off the ZMP until the phase ends (K 18); `pushed`: distance (2,) in m that recent pushes would move an unbalanced
    DCM.
    """

    omega: float
    dcm: NDArray[np.float64]
    reference: LipReference
    goal: NDArray[np.float64]
    zmp_region: NDArray[np.float64]
    offset: NDArray[np.float64] = NO_PUSH
    pushed: NDArray[np.float64] = NO_PUSH

    def beyond_zmp(self, left: float) -> tuple[float, tuple[float, float], tuple[float, float]]:
        """DCM's miss of its goal after `left` seconds T, for the best ZMP (K 25-27), in plain numbers.

        Returns e^(w T) - 1; ZMP (x, y) in m that reaches the goal; the nearest of `zmp_region`, not empty. The miss is
        the first times the distance of these two.
        """
        found: tuple[float, tuple[float, float], tuple[float, float]] = best_zmp(self, left)
        return found


class Tick(Record, frozen=True):
    """Input of proposers at a tick.

    Attributes:
        time: In s.
        frame: Command frame.
        loads: Vertical on each foot in N.
        moments: (2,) at each ankle in N m, with force-torque sensors.
        seen: Swing foot's coming foothold.
        pendulum: With balance fed back.
        firm: Whether ground has lately carried whole soles, so that feet can go anywhere.
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
    pendulum: Pendulum | None = None
    firm: bool = True

    def place(self, side: Side) -> Footstep:
        """A commanded foot as a level place in the world without height."""
        position, yaw = self.feet.footholds[side]
        x, y, _ = self.frame.to_world(position).tolist()
        return Footstep(side, x, y, yaw + self.frame.turn)


class Proposer(Protocol):
    """Proposes plan changes."""

    priority: Priority

    def propose(self, tick: Tick) -> PlanChange | None:
        """Its change at this tick, or None."""
        ...


def was_applied(change: PlanChange, tick: Tick) -> bool:
    """Returns whether a change proposed the tick before `tick` was applied."""
    return tick.plan.last is not None and tick.plan.last.change is change
