"""A robot with its plan and controller, as a scene has it: all that needs no physics."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from plantar.common.settings.body_scale import BodyScale
from plantar.common.sides import SIDES
from plantar.errors import SceneError
from plantar.gait.controller import Start, WalkingController
from plantar.gait.controller_settings import ControllerSettings
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.propose.velocity_command import VelocityTable
from plantar.layouts.layout import Side, SoleLayout
from plantar.robots.controller_settings import com_height_of, controller_settings
from plantar.robots.kinematics.ankle_limits import ankle_limits, standing_legs
from plantar.robots.kinematics.ankle_sensors import ankle_sensors
from plantar.robots.kinematics.body import body_of
from plantar.robots.kinematics.leg_inertia import leg_inertia
from plantar.robots.kinematics.leg_model import LegModel
from plantar.robots.kinematics.robot_model import build_leg_model
from plantar.robots.motors.command_motors import CommandMotors
from plantar.robots.motors.torque_control import command_motors
from plantar.robots.robot import Robot
from plantar.robots.robot_file import load_robot
from plantar.robots.start import start_of_walk
from plantar.robots.walk import crouch_of
from plantar.sensing.link_skin import BodySkin
from plantar.sim.arms.settings import ArmSettings
from plantar.sim.arms.worn_arm import WornArm
from plantar.sim.run.hand_pushing import upper_body_skin_of
from plantar.sim.run.scene import Scene


@dataclass(frozen=True, eq=False)
class Walker:
    """A robot in a scene before there is a world.

    Attributes:
        scene: With shares of this body as lengths.
        worn: An arm that moves, or None.
        velocities: Commanded ones, or None for a number of steps.
        feet: At the start.
        steps: Planned ones.
        skin: Of the upper body, or None.
    """

    scene: Scene
    robot: Robot
    worn: WornArm | None
    legs: LegModel
    body: BodyScale
    velocities: VelocityTable | None
    feet: dict[Side, Footstep]
    steps: tuple[Footstep, ...]
    skin: BodySkin | None
    settings: ControllerSettings
    motors: CommandMotors | None
    controller: WalkingController


def walker_of(
    scene: Scene, seed: int, layouts: Mapping[Side, SoleLayout] | None, placed: Callable[[Start], Start]
) -> Walker:
    """Returns the walker of a `scene`: `seed` draws commands, `layouts` replace the robot's where given, and `placed`
    may move the start.

    Raises:
        RobotError: If the robot is invalid.
        SceneError: If it cannot walk the scene's plan.
    """
    robot = load_robot(scene.robot)
    if layouts is not None:
        robot = replace(robot, layouts=dict(layouts))
    worn = _worn(robot, scene.arm)
    legs = build_leg_model(robot, () if worn is None else (worn,))
    body = body_of(robot, legs.model)
    scene = scene.for_body(body)
    noise = {"force": scene.sensing.force_noise}
    robot = replace(
        robot, layouts={s: replace(robot.layouts[s], noise={**robot.layouts[s].noise, **noise}) for s in SIDES}
    )
    velocities = scene.walk.velocities(seed)
    start = placed(_start(scene, robot, velocities))
    skin = upper_body_skin_of(scene, robot, legs.model, body, worn)
    settings = controller_settings(
        scene,
        robot,
        body,
        ankle_sensors(legs.model, robot),
        ankle_limits(robot, legs.model, body.weight),
        skin if scene.sensing.body_skin else None,
        leg_inertia(robot, legs, com_height_of(scene.walk, robot)),
        standing_legs(robot, legs.model, body.weight, crouch_of(scene.walk, robot)),
    )
    motors = command_motors(robot, legs, body, scene.control, settings.period)
    controller = WalkingController(settings, start, robot.layouts, legs, motors)
    return Walker(
        scene=scene,
        robot=robot,
        worn=worn,
        legs=legs,
        body=body,
        velocities=velocities,
        feet=dict(start.feet),
        steps=start.steps,
        skin=skin,
        settings=settings,
        motors=motors,
        controller=controller,
    )


def _worn(robot: Robot, arm: ArmSettings) -> WornArm | None:
    if arm.side == "none":
        return None
    return WornArm(robot, "left" if arm.side == "left" else "right", arm.posture)


def _start(scene: Scene, robot: Robot, velocities: VelocityTable | None) -> Start:
    """Feet at the start, and planned and commanded walk."""
    height = com_height_of(scene.walk, robot)
    try:
        return start_of_walk(scene.walk, robot, height, scene.terrain.height, velocities)
    except SceneError as error:
        raise SceneError(f"scene '{scene.name}': {error}") from None
