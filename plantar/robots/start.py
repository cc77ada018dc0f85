"""Start of a walk: feet, planned footsteps, commanded velocities."""

import math

from plantar.common.sides import Side, other_side
from plantar.errors import InputError, SceneError
from plantar.gait.controller import Start
from plantar.gait.plan.footsteps import Footstep, straight_plan
from plantar.gait.propose.velocity_command import Legs, VelocityCommand, VelocityTable
from plantar.robots.robot import Robot
from plantar.robots.walk import Walk


def start_of_walk(
    walk: Walk, robot: Robot, com_height: float, height: float = 0.0, velocities: VelocityTable | None = None
) -> Start:
    """The start of a walk, for its controller.

    `com_height`: above the soles in m; `height` of the ground in m; `velocities`: commanded over time,
    `walk.velocities`; None for a number of steps.
    """
    width = (walk.stance_width or robot.stance_width) + walk.wider
    first: Side = "left" if walk.first == "left" else "right"
    steps = walk.steps if velocities is None else 0
    if walk.pattern == "box":
        try:
            feet, plan = box_plan(steps, stride=walk.length, width=width, first=first, height=height)
        except InputError as error:
            raise SceneError(f"[walk] {error}") from None
    else:
        feet, plan = straight_plan(
            steps,
            length=walk.length,
            sideways=walk.sideways,
            width=width,
            first=first,
            height=height,
            closing=walk.pattern == "closing",
            climb=walk.climb,
        )
    if velocities is None:
        return Start(feet, plan, walk.begin)
    return Start(feet, plan, walk.begin, (velocity_command(walk, robot, com_height, velocities),))


def velocity_command(
    walk: Walk, robot: Robot, com_height: float, velocities: VelocityTable | None = None
) -> VelocityCommand:
    """What turns velocities into a robot's steps; without `velocities` it waits for the first that is set.

    `com_height`: above the soles in m; `velocities`: commanded over time.
    """
    width = (walk.stance_width or robot.stance_width) + walk.wider
    outline = robot.layouts["left"].outline
    rear, inner = (-outline.min(axis=0)).tolist()
    toe = float(outline[:, 0].max())
    return VelocityCommand(velocities, Legs(width, com_height, rear, toe, inner))


STEPS_A_ROUND = 6
"""Footsteps after which both feet stand where they began."""

# Where each step puts its foot, in strides forward and away from the foot that moves first
_CORNERS = ((1.0, 0.0), (1.0, 1.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0), (0.0, 0.0))


def box_plan(
    steps: int, *, stride: float, width: float, first: Side = "left", height: float = 0.0
) -> tuple[dict[Side, Footstep], tuple[Footstep, ...]]:
    """A box step: first foot forward, other forward and aside, first closes; back likewise.

    `stride`: side of box in m, above 0; `width`: distance in m of sole origins with feet together; `height` of the
    ground in m. Returns the standing feet at the start, and the steps in order.
    """
    if steps % STEPS_A_ROUND:
        raise InputError(f"steps is {steps}; allowed: whole rounds of {STEPS_A_ROUND} steps")
    if not 0.0 < stride < math.inf:
        raise InputError(f"length is {stride} m; allowed: a finite number above 0 as the side of a box")
    feet, _ = straight_plan(0, width=width, height=height)
    away = -1.0 if first == "left" else 1.0
    plan: list[Footstep] = []
    side = first
    for k in range(steps):
        forward, aside = _CORNERS[k % STEPS_A_ROUND]
        start = feet[side]
        plan.append(Footstep(side, start.x + stride * forward, start.y + away * stride * aside, 0.0, height))
        side = other_side(side)
    return feet, tuple(plan)
