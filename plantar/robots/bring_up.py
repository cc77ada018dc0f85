"""Bring-up of a robot's walking controller."""

from collections.abc import Mapping, Sequence

from plantar.common.sides import SIDES, Side
from plantar.gait.controller import WalkingController
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.plan.walk_plan import vrp_of_step
from plantar.gait.safety.bring_up.bring_up import BringUp
from plantar.gait.safety.standing_command import standing_command
from plantar.mechanics.lip import GRAVITY
from plantar.robots.kinematics.robot_model import Visitor, build_leg_model
from plantar.robots.kinematics.standing_posture import solve_standing
from plantar.robots.robot import Robot


def bring_up_of(
    robot: Robot, controller: WalkingController, feet: Mapping[Side, Footstep], worn: Sequence[Visitor] = ()
) -> BringUp:
    """The checks that a `controller`'s walk waits for (`SafetyShell.bring_up`), of a `robot` that stands on its `feet`.

    It solves its commands with legs of its own, so that your loop need not; `worn` is what else the robot's model
    holds.
    """
    settings = controller.settings
    centers = {side: vrp_of_step(feet[side], controller.middles[side]) for side in SIDES}
    legs = build_leg_model(robot, worn)
    solve_standing(robot, legs, feet, centers, settings.com_height)
    layouts = controller.layouts
    start = controller.schedule.phases[0].end - 1.0
    stand = standing_command(feet, controller.plan, layouts, settings.mass * GRAVITY, settings.com_height, start)
    names = (*robot.legs["left"].joints, *robot.legs["right"].joints)
    imu = legs.place_of(robot.imu_site)
    return BringUp(stand, centers, controller.omega, layouts, legs, imu, names, settings.mass, settings.period)
