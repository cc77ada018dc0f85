"""How a robot's walk begins: where its feet are, the footsteps that are planned, and the velocities it is asked for."""

from __future__ import annotations

from plantar.errors import InputError, SceneError
from plantar.gait.controller import Start
from plantar.gait.plan.footsteps import straight_plan
from plantar.gait.propose.velocity_command import Legs, VelocityCommand, VelocityTable
from plantar.robots.box_plan import box_plan
from plantar.robots.robot import Robot
from plantar.robots.walk import Walk
from plantar.sides import Side

__all__ = ["start_of_walk"]


def start_of_walk(
    walk: Walk, robot: Robot, com_height: float, height: float = 0.0, velocities: VelocityTable | None = None
) -> Start:
    """The start of a walk, for its controller.

    Returns the start.

    Args:
        walk: The gait, for the same body (`Walk.for_body`).
        robot: The robot.
        com_height: CoM height above the soles in m.
        height: Height of the ground that the feet stand on in m.
        velocities: What is commanded over time, `walk.velocities`; None for a number of steps.

    Raises:
        SceneError: If the gait cannot be planned.
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
            steps, length=walk.length, sideways=walk.sideways, width=width, first=first, height=height
        )
    if velocities is None:
        return Start(feet, plan, walk.begin)
    outline = robot.layouts["left"].outline
    (rear, inner), toe = (-outline.min(axis=0)).tolist(), float(outline[:, 0].max())
    return Start(feet, plan, walk.begin, (VelocityCommand(velocities, Legs(width, com_height, rear, toe, inner)),))
