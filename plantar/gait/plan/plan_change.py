"""What somebody wants of the plan of a walk, and what was made of it.

Whoever has a reason to change the plan returns a `PlanChange`; one place decides (`plantar.gait.propose.decide`) and
the plan's owner applies it (`plantar.gait.plan.walk_plan`) and keeps a record. All of these are values.
"""

from __future__ import annotations

from dataclasses import dataclass

from plantar.gait.plan.footsteps import Footstep

__all__ = ["AppliedChange", "MovedStep", "PlanChange", "Point"]

Point = tuple[float, float]
"""A place (x, y) in the world in m."""


@dataclass(frozen=True)
class PlanChange:
    """A change of footsteps, timing and VRPs that somebody proposes. What is None stays as it is.

    Attributes:
        reason: Why, in a few words: it stands in the record, and the decision goes by it.
        step: Index of the footstep that it is about.
        foothold: Where that one comes to be.
        vrp: VRP over it in m; its place in the sole where None and the foothold moves.
        shift: By how much the footsteps after it move in m.
        vrp_shift: By how much the VRPs over those move in m; as the footsteps where None.
        following: The footsteps after it from now on; none ends the walk with it.
        longer: By how much in s the current single support ends later (negative: sooner).
        wait: For how long in s the foot is down by then; as before where None. A foot whose touchdown moves in time is
            swung on accordingly.
        resets: Whether the reference goes over to the changed plan at once, since the body is nearer to that, and not
            by a bridge.
        because: Reason in the record for the footsteps after it, where theirs is another one.
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
    """A footstep that was planned anew at another place.

    Attributes:
        step: Its index.
        x: Where its sole's origin comes to be, forward, in m.
        y: The same, left, in m.
        yaw: Heading in rad.
        reason: Why it was moved.
        before: Where it was planned before; None for a new footstep.
    """

    step: int
    x: float
    y: float
    yaw: float
    reason: str
    before: Footstep | None = None


@dataclass(frozen=True)
class AppliedChange:
    """A change that the plan has taken over.

    Attributes:
        time: When in s.
        change: The change.
        moved: The footsteps that it moved or added, with their old and new places.
        gap: DCM in m by which the reference jumps, because the support polygon does not let it be bridged.
        delay: By how much in s the next double support became longer, to bridge the rest.
    """

    time: float
    change: PlanChange
    moved: tuple[MovedStep, ...]
    gap: Point
    delay: float
