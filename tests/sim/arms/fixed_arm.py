"""A worn arm on a base that does not move, in a world with whoever touches it."""

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any, cast

import mujoco
import numpy as np

from plantar.common.settings.body_scale import REFERENCE_BODY
from plantar.robots import load_robot
from plantar.robots.kinematics.robot_model import Visitor
from plantar.sim.arms.compliant_arm import CompliantArm
from plantar.sim.arms.settings import ArmSettings
from plantar.sim.arms.worn_arm import WornArm
from plantar.sim.model.world import World

PERIOD = 0.005
ASIDE = (0.0, 15.0, 80.0, 80.0, 0.0, 0.0, 0.0)


def fixed_world(worn: WornArm, others: Sequence[Visitor] = ()) -> World:
    """The arm in its posture on a chest that stands 1 m above the ground."""
    spec = mujoco.MjSpec()
    spec.option.timestep = 0.001
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    base = spec.worldbody.add_body(name="base", pos=[0.0, 0.0, 1.0])
    chest = base.add_body(name="chest", mass=50.0, inertia=[1.0, 1.0, 1.0], explicitinertial=True)
    for side, y in (("left", 0.1), ("right", -0.1)):
        chest.add_site(name=f"{side}_sole", pos=[0.0, y, -1.0])
    worn.add_to(spec)
    for other in others:
        other.add_to(spec)
    model = spec.compile()
    data: Any = mujoco.MjData(model)
    torso = int(model.body("base").id)
    soles = {side: int(model.site(f"{side}_sole").id) for side in ("left", "right")}
    found = SimpleNamespace(
        model=model, data=data, torso=torso, body=REFERENCE_BODY, period=0.001, sole_sites=soles, robot=None
    )
    return cast("World", found)


def left_arm() -> WornArm:
    """H1's left arm with its forearm to the side."""
    return WornArm(load_robot("h1"), "left", ASIDE)


def compliant(worn: WornArm, world: World, skin: bool = True, **settings: float) -> CompliantArm:
    """Its controller without noise, with the joints in the posture."""
    given = ArmSettings(side="left", speed_noise=0.0, **settings)
    arm = CompliantArm(worn, worn.skin if skin else None, given, world, PERIOD, 0.0, 0)
    for name, angle in zip(worn.joints, arm.posture, strict=True):
        world.data.joint(name).qpos = angle
        world.data.joint(name).qvel = 0.0
    mujoco.mj_forward(world.model, world.data)
    return arm


def jacobian(world: World, link: str, point: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Rows (3, n) of the velocity of a point (3,) of a link, by MuJoCo."""
    body = int(world.model.body(link).id)
    place = world.data.xpos[body] + world.data.xmat[body].reshape(3, 3) @ point
    rows = np.zeros((3, world.model.nv))
    mujoco.mj_jac(world.model, world.data, rows, None, place, body)
    return rows
