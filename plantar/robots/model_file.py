"""A robot from an MJCF or URDF: legs kept, upper body welded, soles and sensors added.

Other joints, actuators, sensors, keyframes, contacts and options of the file are dropped.
"""

from typing import Any

import mujoco
import numpy as np

from plantar.common.files.model_files import check_model
from plantar.common.files.model_limits import spec_of_file
from plantar.common.sides import SIDES
from plantar.errors import RobotError
from plantar.mechanics.lip import GRAVITY
from plantar.mujoco.deletion import delete_all
from plantar.mujoco.quaternions import quaternion_of
from plantar.robots.leg_shapes import add_leg_shapes
from plantar.robots.robot import LegNames, Robot

_SHOE_HEIGHT = 0.02  # m: where the shoe's mass is taken to be above the contact face, at most


def spec_from_file(robot: Robot) -> Any:
    """Read a robot's model file and make it a walking robot.

    Returns an editable `mujoco.MjSpec` with sites "<side>_sole" and the IMU's, geoms "<side>_sole_box", a position
    actuator a leg joint, and sensors "imu_gyro", "imu_accelerometer", "<side>_ankle_force" and "<side>_ankle_torque".
    """
    spec = _parsed(robot)
    forget_own_simulation(spec)
    _free_base(spec, robot)
    _weld_upper_body(spec, robot)
    colliding = _without_collisions(spec)
    _make_room_for_shoes(spec, robot)
    for i, geom in enumerate(colliding):
        geom.name = geom.name or f"shape {i} of the model"
    for side in SIDES:
        _put_on_shoe(spec, robot, side)
        _add_servos(spec, robot, side)
    add_leg_shapes(spec, robot, [geom.name for geom in colliding])
    _add_imu(spec, robot)
    return spec


def _parsed(robot: Robot) -> Any:
    assert robot.model_file is not None
    check_model(robot.model_file, RobotError)  # MuJoCo would follow no matter what it names
    try:
        spec = spec_of_file(robot.model_file)
    except Exception as error:  # MuJoCo's parser raises ValueError, OSError and its own errors
        text = " ".join(str(error).split())
        raise RobotError(f"robot '{robot.name}': model file {robot.model_file} cannot be read: {text}") from None
    spec.compiler.fusestatic = False  # URDF's default would melt shoes into feet
    return spec


def forget_own_simulation(spec: Any) -> None:
    """Drop the file's simulation options, such as no gravity."""
    for part in ("keys", "equalities", "tendons", "pairs", "excludes", "sensors", "actuators", "lights"):
        delete_all(spec, getattr(spec, part))
    spec.option.gravity = [0.0, 0.0, -GRAVITY]
    spec.option.density = 0.0
    spec.option.viscosity = 0.0
    spec.option.disableflags = 0
    spec.option.enableflags = 0
    for body in spec.bodies:
        body.gravcomp = 0.0


def _without_collisions(spec: Any) -> list[Any]:
    """Disable collisions of all geoms; returns those that had them."""
    colliding = [geom for geom in spec.geoms if geom.contype or geom.conaffinity]
    for geom in spec.geoms:
        geom.contype = 0
        geom.conaffinity = 0
    return colliding


def _add_imu(spec: Any, robot: Robot) -> None:
    torso = _body(spec, robot, robot.torso_body, "[torso] body")
    if spec.site(robot.imu_site) is None:
        torso.add_site(name=robot.imu_site, pos=[0.0, 0.0, 0.0])
    for name, kind in (
        ("imu_gyro", mujoco.mjtSensor.mjSENS_GYRO),
        ("imu_accelerometer", mujoco.mjtSensor.mjSENS_ACCELEROMETER),
    ):
        spec.add_sensor(name=name, type=kind, objtype=mujoco.mjtObj.mjOBJ_SITE, objname=robot.imu_site)


def _body(spec: Any, robot: Robot, name: str, field: str) -> Any:
    found = spec.body(name)
    if found is None:
        known = ", ".join(b.name for b in spec.bodies if b.name and b.name != "world")
        raise RobotError(f"robot '{robot.name}': {field} is '{name}'; the model has {known}")
    return found


def _free_base(spec: Any, robot: Robot) -> None:
    root = _body(spec, robot, robot.torso_body, "[torso] body")
    if root.parent is None:
        raise RobotError(f"robot '{robot.name}': [torso] body is '{root.name}', which is no part of the robot")
    while root.parent.name != "world":
        root = root.parent
    if not any(j.type == mujoco.mjtJoint.mjJNT_FREE for j in root.joints):
        delete_all(spec, root.joints)
        root.add_freejoint(name="plantar_root")
    _clear_world(spec, root)


def _clear_world(spec: Any, root: Any) -> None:
    delete_all(spec, [body for body in spec.worldbody.bodies if body.name != root.name])
    delete_all(spec, spec.worldbody.geoms)


def _weld_upper_body(spec: Any, robot: Robot) -> None:
    legs = {name for leg in robot.legs.values() for name in leg.joints}
    _check_joints(spec, robot, legs)
    for side, leg in robot.legs.items():
        _check_leg(spec, robot, side, leg)
    delete_all(spec, [j for j in spec.joints if j.name not in legs and j.type != mujoco.mjtJoint.mjJNT_FREE])


def _check_joints(spec: Any, robot: Robot, wanted: set[str]) -> None:
    names = {j.name for j in spec.joints}
    missing = sorted(wanted - names)
    if missing:
        known = ", ".join(sorted(filter(None, names)))
        raise RobotError(f"robot '{robot.name}': the model has no joint {', '.join(missing)}; it has {known}")


def _check_leg(spec: Any, robot: Robot, side: str, leg: LegNames) -> None:
    """Refuse joints that do not move the foot, and torso or IMU below."""
    where = f"robot '{robot.name}': [legs.{side}]"
    foot = _body(spec, robot, leg.foot_body, f"[legs.{side}] foot_body")
    chain = [j.name for body in reversed(_upwards(foot)) for j in body.joints if j.type != mujoco.mjtJoint.mjJNT_FREE]
    for name in leg.joints:
        if name not in chain:
            raise RobotError(f"{where} joint '{name}' does not move {foot.name}; those that do: {', '.join(chain)}")
        if spec.joint(name).type != mujoco.mjtJoint.mjJNT_HINGE:
            raise RobotError(f"{where} joint '{name}' is no hinge; allowed: hinges")
    site = spec.site(robot.imu_site)
    for field, body in (("body", spec.body(robot.torso_body)), ("imu_site", None if site is None else site.parent)):
        moved = next((j.name for part in _upwards(body) for j in part.joints if j.name in leg.joints), None)
        if moved is not None:
            raise RobotError(f"robot '{robot.name}': [torso] {field} hangs on a leg: joint '{moved}' moves it")


def _upwards(body: Any) -> list[Any]:
    """A body and its ancestors, without the world; none for None."""
    chain = []
    while body is not None and body.parent is not None:
        chain.append(body)
        body = body.parent
    return chain


def _make_room_for_shoes(spec: Any, robot: Robot) -> None:
    for side in SIDES:
        for element in (
            spec.site(robot.legs[side].sole_site),
            spec.site(f"{side}_truth_touch"),
            spec.geom(f"{side}_sole_box"),
            spec.geom(f"{side}_foot_shape"),
        ):
            if element is not None:
                element.name = f"{element.name} of the model"


def _put_on_shoe(spec: Any, robot: Robot, side: Any) -> None:
    foot = _body(spec, robot, robot.legs[side].foot_body, f"[legs.{side}] foot_body")
    center, half = robot.sole_rectangle(side)
    ankle = f"{side}_ankle_force_torque"
    if spec.site(ankle) is None:
        foot.add_site(name=ankle, pos=[0.0, 0.0, 0.0])
    for name, kind in (("force", mujoco.mjtSensor.mjSENS_FORCE), ("torque", mujoco.mjtSensor.mjSENS_TORQUE)):
        spec.add_sensor(name=f"{side}_ankle_{name}", type=kind, objtype=mujoco.mjtObj.mjOBJ_SITE, objname=ankle)
    shoe = foot.add_body(pos=robot.sole_origins[side], quat=quaternion_of(robot.sole_rotations[side]))
    thickness = max(robot.shoe_thickness, 1e-3)
    mass = max(robot.shoe_mass, 1e-3)
    lx = 2.0 * half[0]
    ly = 2.0 * half[1]
    lz = thickness
    shoe.mass = mass
    shoe.ipos = [center[0], center[1], min(0.5 * thickness, _SHOE_HEIGHT)]
    shoe.inertia = mass / 12.0 * np.array([ly * ly + lz * lz, lx * lx + lz * lz, lx * lx + ly * ly])
    shoe.explicitinertial = True
    shoe.add_site(name=robot.legs[side].sole_site, pos=[0.0, 0.0, 0.0])
    shoe.add_geom(
        name=f"{side}_sole_box",
        type=mujoco.mjtGeom.mjGEOM_BOX,
        size=[half[0], half[1], 0.5 * thickness],
        pos=[center[0], center[1], 0.5 * thickness],
        contype=1,
        conaffinity=2,
        mass=0.0,
        rgba=[0.1, 0.1, 0.12, 1.0],
    )


def _add_servos(spec: Any, robot: Robot, side: Any) -> None:
    for i, name in enumerate(robot.legs[side].joints):
        limit = robot.effort_limits[i] if robot.effort_limits else 0.0
        servo = spec.add_actuator(
            name=f"{name}_servo", target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT, biastype=mujoco.mjtBias.mjBIAS_AFFINE
        )
        servo.gainprm[0] = robot.stiffness[i]
        servo.biasprm[1] = -robot.stiffness[i]
        servo.biasprm[2] = -robot.damping[i]
        servo.ctrllimited = mujoco.mjtLimited.mjLIMITED_FALSE
        if limit > 0.0:
            servo.forcelimited = mujoco.mjtLimited.mjLIMITED_TRUE
            servo.forcerange = [-limit, limit]
