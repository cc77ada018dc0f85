"""Proposed and applied changes of a plan, as values; only `plantar.gait.plan.walk_plan` applies them."""

from __future__ import annotations

from dataclasses import dataclass

from plantar.gait.plan.footsteps import Footstep

__all__ = ["AppliedChange", "MovedStep", "PlanChange", "Point"]

Point = tuple[float, float]
"""A place (x, y) in the world in m."""


@dataclass(frozen=True)
class PlanChange:
    """A proposed change of footsteps, timing and VRPs. What is None stays.

    Attributes:
        reason: Why, in a few words; recorded, and used by the decision.
        step: Index of the footstep concerned.
        foothold: Its new place.
        vrp: VRP over it in m; at its place in the sole where None and the foothold moves.
        shift: Move of the footsteps after it in m.
        vrp_shift: Move of the VRPs over those in m; as the footsteps where None.
        following: New footsteps after it; an empty tuple ends the walk with it.
        longer: Delay in s of the end of the current single support (negative: sooner).
        wait: Time in s before that end by which the foot has to be down; unchanged where None.
        resets: Whether the reference jumps to the changed plan, which is nearer to the body, without a bridge.
        because: Reason recorded for the footsteps after it, where it differs.
    """

    reason: str
    step: int
    foothold: Footstep | None = None
    vrp: Point | None = None
    shift: Point = (0.0, 0.0)
    vrp_shift: Point | None = None
    following: tuple[Footstep, ...] | None = None
    longer: float | None = None
    wait: float | None = None
    resets: bool = False
    because: str = ""


@dataclass(frozen=True)
class MovedStep:
    """A moved footstep.

    Attributes:
        step: Its index.
        x: New place of its sole's origin, forward, in m.
        y: The same, left, in m.
        yaw: Heading in rad.
        reason: Why it was moved.
        before: Its place before; None for a new footstep.
    """

    step: int
    x: float
    y: float
    yaw: float
    reason: str
    before: Footstep | None = None


@dataclass(frozen=True)
class AppliedChange:
    """A change that the plan has applied.

    Attributes:
        time: When in s.
        change: The change.
        moved: The footsteps that it moved or added.
        gap: DCM in m by which the reference jumps, because the support polygon limits the bridge.
        delay: Time in s by which the next double support became longer for the bridge.
    """

    time: float
    change: PlanChange
    moved: tuple[MovedStep, ...]
    gap: Point
    delay: float
