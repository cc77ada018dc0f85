"""The simulated world: robot, ground and others as one MuJoCo model."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.body_scale import REFERENCE_BODY, BodyScale
from plantar.common.sides import SIDES, Side
from plantar.errors import RobotError, SceneError
from plantar.robots.kinematics.body import body_of
from plantar.robots.kinematics.robot_model import Visitor, compiled_model, robot_spec
from plantar.robots.leg_shapes import COLLIDES, keep_apart
from plantar.robots.robot import Robot
from plantar.sim.model.contact_settings import Contact
from plantar.sim.model.contact_truth import REACH
from plantar.sim.plant.body import make_true
from plantar.sim.plant.draw import TruePlant
from plantar.sim.terrain import GROUND_CONTACT, GROUND_GROUP, Ground, Solid

PHYSICS_PERIOD = 0.001
"""Time step of the physics in s, where a scene gives none."""

_CONTACT_STEPS = 2.0  # physics steps that a contact takes to bring penetration to rest at least
_CONES = {"elliptic": mujoco.mjtCone.mjCONE_ELLIPTIC, "pyramidal": mujoco.mjtCone.mjCONE_PYRAMIDAL}
_USUAL = Contact()

_LEG_CONTACT = "truth_leg_contact"  # name of the sensor that reports a leg on the other
_LEGS = tuple(contype for contype, _ in COLLIDES.values())

DIVERGED = (
    int(mujoco.mjtWarning.mjWARN_BADQPOS),
    int(mujoco.mjtWarning.mjWARN_BADQVEL),
    int(mujoco.mjtWarning.mjWARN_BADQACC),
    int(mujoco.mjtWarning.mjWARN_BADCTRL),
)
"""MuJoCo's warnings that its state diverged."""


def check_stable(warnings: NDArray[np.int32]) -> None:
    """A SceneError where MuJoCo's `data.warning.number` shows a diverged state."""
    if warnings[list(DIVERGED)].any():
        raise SceneError(
            "the simulated physics became unstable: forces too large for its time step (control.physics_period); "
            "lower that, the robot's [servo] stiffness and damping, or what pushes it"
        )


def add_looks(spec: Any, torso: str) -> None:
    """Add sky, light that follows a `torso`, and material "ground" to a `spec`."""
    spec.add_texture(
        name="sky",
        type=mujoco.mjtTexture.mjTEXTURE_SKYBOX,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_GRADIENT,
        rgb1=[0.98, 0.985, 0.99],
        rgb2=[0.72, 0.80, 0.88],
        width=256,
        height=1536,
    )
    spec.add_texture(
        name="ground",
        type=mujoco.mjtTexture.mjTEXTURE_2D,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_CHECKER,
        rgb1=[0.88, 0.89, 0.91],
        rgb2=[0.80, 0.82, 0.85],
        width=256,
        height=256,
    )
    material = spec.add_material(name="ground", texrepeat=[5, 5], texuniform=True)
    material.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = "ground"
    spec.worldbody.add_light(
        pos=[0, 0, 4],
        dir=[0.3, 0.4, -1],
        type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
        diffuse=[0.3, 0.3, 0.3],
        castshadow=False,
    )
    spec.worldbody.add_light(
        pos=[0.6, -0.8, 3.2],
        mode=mujoco.mjtCamLight.mjCAMLIGHT_TARGETBODYCOM,
        targetbody=torso,
        type=mujoco.mjtLightType.mjLIGHT_SPOT,
        cutoff=60.0,
        exponent=2.0,
        diffuse=[0.35, 0.35, 0.35],
    )
    spec.visual.headlight.ambient = [0.4, 0.4, 0.4]
    spec.visual.headlight.diffuse = [0.25, 0.25, 0.25]
    spec.visual.quality.shadowsize = 4096
    spec.visual.rgba.haze = [0.95, 0.96, 0.97, 1.0]
    spec.visual.map.haze = 0.4


def _add_touch(spec: Any, sole: Any, name: str) -> None:
    """Add a touch site on a sole box, 10 mm larger."""
    site = sole.parent.add_site(name=name, type=mujoco.mjtGeom.mjGEOM_BOX, pos=sole.pos, quat=sole.quat, group=5)
    site.size = np.asarray(sole.size) + 0.01
    spec.add_sensor(name=name, type=mujoco.mjtSensor.mjSENS_TOUCH, objtype=mujoco.mjtObj.mjOBJ_SITE, objname=name)


def _add_leg_contact(spec: Any, robot: Robot) -> None:
    left, right = (spec.joint(robot.legs[side].joints[0]).parent for side in SIDES)
    for side, link in zip(SIDES, (left, right), strict=True):
        link.name = link.name or f"{side}_leg"  # a sensor finds it by name, which a model need not give
    body = mujoco.mjtObj.mjOBJ_XBODY  # with all bodies below it
    spec.add_sensor(
        name=_LEG_CONTACT,
        type=mujoco.mjtSensor.mjSENS_CONTACT,
        objtype=body,
        objname=left.name,
        reftype=body,
        refname=right.name,
        intprm=[1, 0, 1],  # report whether there are contacts, and the first one
    )


def _let_legs_touch_ground(spec: Any, robot: Robot) -> None:
    """Let thighs and shanks meet the ground, as a robot that kneels; feet and shoes have their soles for that."""
    feet = {spec.geom(f"{side}_foot_shape").parent.name for side in SIDES}
    for side in SIDES:
        link = spec.body(robot.legs[side].foot_body)
        last = spec.joint(robot.legs[side].joints[-1]).parent.name
        feet.add(link.name)
        while link.name != last:  # of several bodies, up to the one that the ankle turns
            link = link.parent
            feet.add(link.name)
    for geom in spec.geoms:
        if geom.contype in _LEGS and geom.parent.name not in feet:
            geom.conaffinity |= GROUND_CONTACT


@dataclass(frozen=True)
class World:
    """A compiled world and its addresses; left leg first.

    Attributes:
        servos: Indices of the legs' actuators in ctrl.
        sole_sites: Site id of each sole frame.
        stiffness: Servo gains (k,) in N m/rad of the robot's file; `damping` in N m s/rad.
        joint_damping: Of the robot's model (k,) in N m s/rad; `joint_friction` in N m.
        gyro: Address in sensordata, like `accelerometer`, `ankle_wrench` (force, torque), `touch` (force on each sole),
            and `leg_contact`, above 0 where the legs touch.
        period: Physics step in s.
        moving_ground: Moving pieces with mocap numbers.
        ground_top: Largest ground height in m, ever.
    """

    model: Any
    data: Any
    robot: Robot
    joint_qpos: NDArray[np.int64]
    joint_qvel: NDArray[np.int64]
    servos: NDArray[np.int64]
    sole_geoms: dict[Side, tuple[int, ...]]
    sole_sites: dict[Side, int]
    torso: int
    stiffness: NDArray[np.float64]
    damping: NDArray[np.float64]
    joint_damping: NDArray[np.float64]
    joint_friction: NDArray[np.float64]
    gyro: int
    accelerometer: int
    ankle_wrench: dict[Side, tuple[int, int]]
    touch: dict[Side, int]
    leg_contact: int
    body: BodyScale
    period: float = PHYSICS_PERIOD
    moving_ground: tuple[tuple[int, Solid], ...] = ()
    ground_top: float = math.inf

    @property
    def reach(self) -> float:
        """Largest gap in m between sole and ground that still counts as contact."""
        return REACH * self.body.leg / REFERENCE_BODY.leg

    def move_ground(self) -> None:
        """Move the ground to where it is now."""
        for i, solid in self.moving_ground:
            self.data.mocap_pos[i] = solid.at(float(self.data.time))


def build_world(
    robot: Robot,
    ground: Ground,
    period: float = PHYSICS_PERIOD,
    plant: TruePlant | None = None,
    others: Sequence[Visitor] = (),
    contact: Contact = _USUAL,
) -> World:
    """Build and compile the world in its reference configuration.

    `period`: physics step in s; `plant`: True differences, or None; `others`: bodies with coordinates after the
    robot's; `contact`: of soles and ground, scaled to the robot's body. Returns the world.
    """
    spec = robot_spec(robot)
    _set_solver(spec, period, contact)
    add_looks(spec, robot.torso_body)
    for geom in spec.geoms:
        if geom.group == GROUND_GROUP:
            geom.group = 1  # as visible as before, but not for proximity sensors
    ground.add_to(spec)
    for side in SIDES:
        _add_touch(spec, spec.geom(f"{side}_sole_box"), f"{side}_truth_touch")
    _add_leg_contact(spec, robot)
    _let_legs_touch_ground(spec, robot)
    soles = _set_contacts(spec, ground.friction)
    for other in others:
        other.add_to(spec)
    model = compiled_model(spec, robot)
    body = body_of(robot, model)
    _soften(model, soles, contact.for_body(body), period, robot.contact_damping)
    keep_apart(model, robot)
    world = _world_of(model, robot, ground, body)
    if plant is not None:
        make_true(model, plant, world.torso, world.servos, soles, body)
    return world


def _set_solver(spec: Any, period: float, contact: Contact) -> None:
    spec.option.timestep = period
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.option.cone = _CONES[contact.cone]
    spec.option.impratio = contact.impratio
    spec.option.iterations = 20


def _set_contacts(spec: Any, friction: float) -> list[str]:
    touching = [geom for geom in spec.geoms if geom.contype and geom.contype not in _LEGS]
    for geom in touching:
        geom.condim = 3
        geom.friction[0] = friction
    return [geom.name for geom in touching]


def _soften(model: Any, names: Sequence[str], contact: Contact, period: float, damping: float) -> None:
    """Give geoms of soles and ground the parameters of their `contact`."""
    ids = [model.geom(name).id for name in names]
    model.geom_solref[ids] = [max(contact.settling, _CONTACT_STEPS * period), damping]
    model.geom_solimp[ids] = [contact.least_impedance, contact.largest_impedance, contact.rigid_depth, 0.5, 2]
    model.geom_gap[ids] = contact.listed_gap


def _servos_of(model: Any, robot: Robot, names: Sequence[str], ids: Sequence[int]) -> NDArray[np.int64]:
    servo_of = {int(model.actuator_trnid[a, 0]): a for a in range(model.nu)}
    missing = [n for n, i in zip(names, ids, strict=True) if i not in servo_of]
    if missing:
        raise RobotError(f"robot '{robot.name}': no actuator drives joint {', '.join(missing)}")
    return np.array([servo_of[i] for i in ids])


def _world_of(model: Any, robot: Robot, ground: Ground, body: BodyScale) -> World:
    joints = [*robot.legs["left"].joints, *robot.legs["right"].joints]
    ids = [model.joint(name).id for name in joints]
    servos = _servos_of(model, robot, joints, ids)
    dofs = model.jnt_dofadr[ids].astype(np.int64)
    return World(
        model=model,
        data=mujoco.MjData(model),
        robot=robot,
        joint_qpos=model.jnt_qposadr[ids].astype(np.int64),
        joint_qvel=dofs,
        servos=servos,
        sole_geoms={s: (model.geom(f"{s}_sole_box").id,) for s in SIDES},
        sole_sites={s: model.site(robot.legs[s].sole_site).id for s in SIDES},
        torso=model.body(robot.torso_body).id,
        stiffness=model.actuator_gainprm[servos, 0].copy(),
        damping=-model.actuator_biasprm[servos, 2].copy(),
        joint_damping=model.dof_damping[dofs].copy(),
        joint_friction=model.dof_frictionloss[dofs].copy(),
        gyro=int(model.sensor("imu_gyro").adr[0]),
        accelerometer=int(model.sensor("imu_accelerometer").adr[0]),
        ankle_wrench={
            s: (int(model.sensor(f"{s}_ankle_force").adr[0]), int(model.sensor(f"{s}_ankle_torque").adr[0]))
            for s in SIDES
        },
        touch={s: int(model.sensor(f"{s}_truth_touch").adr[0]) for s in SIDES},
        leg_contact=int(model.sensor(_LEG_CONTACT).adr[0]),
        body=body,
        period=float(model.opt.timestep),
        moving_ground=tuple((int(model.body(f"ground_{i}").mocapid[0]), solid) for i, solid in ground.moving),
        ground_top=ground.top,
    )
