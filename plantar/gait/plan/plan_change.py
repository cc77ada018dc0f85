"""Proposed and applied plan changes; only `plantar.gait.plan.walk_plan` applies them."""

from dataclasses import dataclass

from plantar.gait.plan.footsteps import Footstep

Point = tuple[float, float]
"""A place (x, y) in the world in m."""


@dataclass(frozen=True)
class PlanChange:
    """Proposed change of footsteps, timing and VRPs; None keeps.

    Attributes:
        reason: In a few words; recorded, and used by the decision.
        step: Its index.
        foothold: Its new place.
        vrp: Over it in m; None with a moved foothold: at its place in the sole.
        shift: Later footsteps' move in m.
        vrp_shift: Their VRPs' move in m; None for the same.
        following: New later footsteps; empty ends the walk.
        longer: Delay in s of the current support's end (negative: sooner).
        again: Whether the step that has just landed is taken once more: `longer` is of the single support before this
            double support.
        wait: Time in s before that end by which the foot is down; None for unchanged.
        resets: Whether the reference jumps to the changed plan, nearer to the body, without a bridge.
        because: Reason for later footsteps, if different.
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
    again: bool = False
    because: str = ""


@dataclass(frozen=True)
class MovedStep:
    """A moved footstep.

    `step`: its index; `x`: sole origin's new place, forward, in m; `y`: left in m; `yaw`: heading in rad; `before`: old
    place; None for a new footstep.
    """

    step: int
    x: float
    y: float
    yaw: float
    reason: str
    before: Footstep | None = None


@dataclass(frozen=True)
class AppliedChange:
    """An applied plan change.

    `time`: when in s; `gap`: reference's DCM jump in m, as the support polygon limits the bridge; `delay`: next double
    support's extension in s for the bridge.
    """

    time: float
    change: PlanChange
    moved: tuple[MovedStep, ...]
    gap: Point
    delay: float
