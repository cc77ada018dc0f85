"""Puts a robot on its feet and lets contacts settle."""

from collections.abc import Callable, Mapping

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES
from plantar.errors import SceneError
from plantar.gait.plan.footsteps import Footstep
from plantar.layouts.layout import Side
from plantar.robots.kinematics.leg_model import LegModel
from plantar.robots.kinematics.standing_posture import solve_standing
from plantar.sim.judging.leg_contact import legs_that_touch
from plantar.sim.model.world import World, check_stable
from plantar.sim.run.motor_drives import MotorDrives
from plantar.sim.run.servos import LegServos

_SETTLING = 500  # physics steps: half a second of H1
_SINKING_MAX = 1 / 12  # leg, of the base while it settles; soft servos yield by less


def stand(
    world: World,
    legs: LegModel,
    servos: LegServos | MotorDrives,
    feet: Mapping[Side, Footstep],
    centers: Mapping[Side, NDArray[np.float64]],
    com_height: float,
    hold: Callable[[], None] | None = None,
) -> None:
    """Stand the robot on its footholds, and let it settle until time 0.

    `centers` (2,) of each sole in the world frame in m, carrying half the weight; `com_height`: above the soles in m;
    `hold`: holds other moving parts each physics step, or None.
    """
    joints, torques = solve_standing(world.robot, legs, feet, centers, com_height)
    ground = float(np.mean([feet[s].z for s in SIDES]))
    data = world.data
    mujoco.mj_resetData(world.model, data)
    # The robot comes first; others have their places after it.
    data.qpos[: len(legs.configuration)] = legs.configuration
    data.time = -_SETTLING * world.period
    mujoco.mj_kinematics(world.model, data)
    mujoco.mj_collision(world.model, data)
    touching = legs_that_touch(world)
    if touching is not None:
        raise SceneError(
            f"robot '{world.robot.name}' cannot stand with its feet "
            f"{np.hypot(feet['left'].x - feet['right'].x, feet['left'].y - feet['right'].y):.3f} m apart: "
            f"{' and '.join(touching)} touch; allowed: a wider stance (walk.stance_width, or the robot's stance_width)"
        )
    servos.start(joints, torques)
    if hold is None:
        mujoco.mj_step(world.model, data, _SETTLING)
    else:
        for _ in range(_SETTLING):
            hold()
            mujoco.mj_step(world.model, data)
    check_stable(data.warning.number)
    sunk = float(legs.configuration[2] - data.qpos[2])
    if abs(sunk) > _SINKING_MAX * world.body.leg:
        settling = _SETTLING * world.period
        raise SceneError(
            f"robot '{world.robot.name}' does not keep standing: it came to be {abs(sunk):.2f} m "
            f"{'lower' if sunk > 0.0 else 'higher'} in its first {settling:g} s; allowed: ground at a height of "
            f"{ground:g} m (terrain.height) under both feet, and servos that carry the robot"
        )
    data.time = 0.0
