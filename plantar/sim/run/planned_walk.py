"""A planned walk's footprints, by which its ground is laid out."""

from collections.abc import Mapping, Sequence

from plantar.common.sides import SIDES
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.plan.phases import WalkSchedule
from plantar.gait.plan.walk_plan import vrp_of_step
from plantar.layouts.layout import Side
from plantar.robots.robot import Robot
from plantar.sim.terrain import Footprint, PlannedFeet


def planned_feet(
    robot: Robot, feet: Mapping[Side, Footstep], steps: Sequence[Footstep], schedule: WalkSchedule
) -> PlannedFeet:
    """Returns footprints of `steps` at times of a `schedule`, of a `robot` with `feet` at the start."""
    swings = {p.step: p for p in schedule.phases if p.swing is not None}

    def footprint(foot: Footstep, step: int | None) -> Footprint:
        center, half = robot.sole_rectangle(foot.side)
        place = vrp_of_step(foot, center)
        if step is None:
            return Footprint(foot.side, place, foot.yaw, half, foot.position[:2], z=foot.z)
        swing = swings[step]
        return Footprint(foot.side, place, foot.yaw, half, foot.position[:2], swing.start, swing.end, foot.z)

    return PlannedFeet(
        {side: footprint(feet[side], None) for side in SIDES},
        tuple(footprint(foot, k) for k, foot in enumerate(steps)),
    )
