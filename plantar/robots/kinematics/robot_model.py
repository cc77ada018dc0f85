"""The robot alone as a MuJoCo model, for its controller."""

import math
from collections.abc import Sequence
from typing import Any, Protocol

import mujoco

from plantar.common.files.model_limits import quiet_mujoco
from plantar.common.settings.body_scale import REFERENCE_BODY
from plantar.common.sides import SIDES
from plantar.errors import RobotError
from plantar.robots.biped import biped_mjcf
from plantar.robots.kinematics.body import body_of
from plantar.robots.kinematics.leg_model import LegModel
from plantar.robots.leg_shapes import add_leg_shapes
from plantar.robots.model_file import spec_from_file
from plantar.robots.robot import Robot


class Visitor(Protocol):
    """An addition to a model: an arm, a partner, furniture."""

    def add_to(self, spec: Any) -> None:
        """Add it to an editable `mujoco.MjSpec`."""


def robot_spec(robot: Robot) -> Any:
    """The robot alone as an editable `mujoco.MjSpec`.

    Raises:
        RobotError: If the model cannot be read.
    """
    quiet_mujoco()
    if robot.biped is not None:
        center, half = robot.sole_rectangle("left")
        text = biped_mjcf(
            robot.biped,
            name=robot.name,
            posture=[math.degrees(v) for v in robot.posture["left"]],
            sole_center=center,
            sole_half_size=half,
            shoe_thickness=robot.shoe_thickness,
            shoe_mass=robot.shoe_mass,
            stiffness=robot.stiffness,
            damping=robot.damping,
        )
        spec = mujoco.MjSpec.from_string(text)
        add_leg_shapes(spec, robot)
        return spec
    return spec_from_file(robot)


def compiled_model(spec: Any, robot: Robot) -> Any:
    """Compile a model.

    Takes `spec` and `robot`; returns the `mujoco.MjModel`.
    """
    try:
        return spec.compile()
    except ValueError as error:
        text = " ".join(str(error).split())
        raise RobotError(f"robot '{robot.name}': its model cannot be simulated: {text}") from None


def build_leg_model(robot: Robot, worn: Sequence[Visitor] = ()) -> LegModel:
    """Kinematic model of the robot alone, for its controller. `worn`: additional parts, such as a moving arm."""
    spec = robot_spec(robot)
    for part in worn:
        part.add_to(spec)
    model = compiled_model(spec, robot)
    joints = [*robot.legs["left"].joints, *robot.legs["right"].joints]
    soles = {s: robot.legs[s].sole_site for s in SIDES}
    unit = body_of(robot, model).leg / REFERENCE_BODY.leg
    return LegModel(model, joints, soles, robot.torso_body, unit)
