"""The walk that a scene plans: footsteps, commands, and the footprints that its ground is laid out by."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from plantar.errors import InputError, SceneError
from plantar.gait.plan.footsteps import Footstep, straight_plan
from plantar.gait.plan.phases import WalkSchedule
from plantar.gait.plan.walk_plan import vrp_of_step
from plantar.gait.propose.velocity_command import Legs, VelocityCommand, VelocityTable
from plantar.layouts.layout import Side
from plantar.sides import SIDES
from plantar.sim.robots.robot import Robot
from plantar.sim.run.box_plan import box_plan
from plantar.sim.run.scene import Scene
from plantar.sim.terrain import Footprint, PlannedFeet

__all__ = ["planned_feet", "planned_steps", "velocity_command"]


def planned_steps(
    scene: Scene, robot: Robot, *, commanded: bool = False
) -> tuple[dict[Side, Footstep], tuple[Footstep, ...]]:
    """Where the feet stand, and the footsteps that are planned at the start.

    Args:
        scene: The scene, with lengths in m.
        robot: The robot.
        commanded: Whether the walk is commanded while it is walked: no footsteps then.

    Raises:
        SceneError: If a box cannot be walked in so many steps.
    """
    walk = scene.walk
    steps = 0 if commanded else walk.steps
    width, height = _stance_width(scene, robot), scene.terrain.height
    first: Side = "left" if walk.first == "left" else "right"
    if walk.pattern == "box":
        try:
            return box_plan(steps, stride=walk.length, width=width, first=first, height=height)
        except InputError as error:
            raise SceneError(f"scene '{scene.name}': [walk] {error}") from None
    return straight_plan(steps, length=walk.length, sideways=walk.sideways, width=width, first=first, height=height)


def _stance_width(scene: Scene, robot: Robot) -> float:
    """Distance in m of the ankles when the feet stand side by side."""
    return (scene.walk.stance_width or robot.stance_width) + scene.walk.wider


def velocity_command(scene: Scene, robot: Robot, velocities: VelocityTable, com_height: float) -> VelocityCommand:
    """What commands a walk while it is walked.

    Args:
        scene: The scene, with lengths in m.
        robot: The robot.
        velocities: The commands over time.
        com_height: Height of the CoM above the ground in m.
    """
    outline = robot.layouts["left"].outline
    (rear, inner), toe = (-outline.min(axis=0)).tolist(), float(outline[:, 0].max())
    return VelocityCommand(velocities, Legs(_stance_width(scene, robot), com_height, rear, toe, inner))


def planned_feet(
    robot: Robot, feet: Mapping[Side, Footstep], steps: Sequence[Footstep], schedule: WalkSchedule
) -> PlannedFeet:
    """The plan's footprints with their times.

    Args:
        robot: The robot.
        feet: Where the feet stand at the start.
        steps: The footsteps.
        schedule: When they are made.
    """
    swings = {p.step: p for p in schedule.phases if p.swing is not None}

    def footprint(foot: Footstep, step: int | None) -> Footprint:
        center, half = robot.sole_rectangle(foot.side)
        place = vrp_of_step(foot, center)
        if step is None:
            return Footprint(foot.side, place, foot.yaw, half, foot.position[:2])
        swing = swings[step]
        return Footprint(foot.side, place, foot.yaw, half, foot.position[:2], swing.start, swing.end)

    return PlannedFeet(
        {side: footprint(feet[side], None) for side in SIDES},
        tuple(footprint(foot, k) for k, foot in enumerate(steps)),
    )
