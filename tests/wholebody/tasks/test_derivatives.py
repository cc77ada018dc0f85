"""Every task's Jacobian and drift against finite differences of what it moves, with a fixed and with a free base."""

import importlib
import pkgutil
import re

import mujoco
import numpy as np
import pytest

import plantar.wholebody.tasks
from plantar.sensing.link_skin import BodySkin, SkinPatch
from plantar.sensing.reading import Reading
from plantar.wholebody.tasks.base_avoidance import BaseAvoidance
from plantar.wholebody.tasks.cartesian_pose import CartesianPose
from plantar.wholebody.tasks.center_of_mass import CenterOfMass
from plantar.wholebody.tasks.compliant_wrist import CompliantWrist
from plantar.wholebody.tasks.contact_force import ContactForce
from plantar.wholebody.tasks.point_force import AlongForce, PointForce
from plantar.wholebody.tasks.posture import BodyCompliance, Posture
from plantar.wholebody.tasks.self_collision import SelfCollision, Sphere
from plantar.wholebody.tasks.skin_interaction import (
    DirectInteraction,
    PressureInteraction,
    ProximityInteraction,
    TemperatureInteraction,
)
from plantar.wholebody.tasks.support import Standing, Support
from plantar.wholebody.tasks.tactile_guidance import TactileGuidance

JOINTS = 9
STEP = 1e-5
HAND, ARM = "link8", "link4"
POINT = np.array([0.05, -0.02, 0.11])
NORMAL = np.array([0.6, 0.0, -0.8])
BALLS = (Sphere(HAND, POINT, 0.02), Sphere(ARM, -POINT, 0.03))


def place(robot, link, point=None):
    origin, rotation = robot.pose(link)
    return origin if point is None else origin + rotation @ point


def turn(before, after):
    """Rotation vector from one rotation to another, in the world, to first order."""
    skew = after @ before.T
    return 0.5 * np.array([skew[2, 1] - skew[1, 2], skew[0, 2] - skew[2, 0], skew[1, 0] - skew[0, 1]])


def moved_pose(before, after, link, point=None):
    linear = place(after, link, point) - place(before, link, point)
    return np.hstack([linear, turn(before.pose(link)[1], after.pose(link)[1])])


def links_that_feel(before, after):
    return np.hstack([moved_pose(before, after, link) for link in (ARM, HAND)])


def along_normal(before, after, middle):
    outward = middle.pose(HAND)[1] @ NORMAL
    return np.array([outward @ moved_pose(before, after, HAND, POINT)[:3]])


def along_push(before, after, middle, skin):
    reading = Reading(0.0, np.ones(6), np.full(6, np.inf))
    wrenches = DirectInteraction(skin).demand(middle, reading).force.reshape(2, 6)
    moved = links_that_feel(before, after).reshape(2, 6)
    return (wrenches * moved).sum(1) / np.linalg.norm(wrenches[:, :3], axis=1)


def apart(robot):
    return np.linalg.norm(place(robot, HAND, POINT) - place(robot, ARM, -POINT))


def on_the_ground(before, after, middle):
    pose = moved_pose(before, after, HAND)
    return np.hstack([middle.pose(HAND)[1][:, :2].T @ pose[:3], pose[5]])


def pushed(robot):
    task = PointForce(HAND, POINT)
    task.force = np.ones(3)
    return task


def avoiding():
    task = BaseAvoidance(HAND, (0.2, 0.1))
    task.obstacles = np.array([[0.4, 0.05], [-0.1, 0.3]])
    return task


def generalized(before, after, middle):
    moved = np.zeros(middle.model.nv)
    mujoco.mj_differentiatePos(middle.model, moved, 1.0, before.data.qpos, after.data.qpos)
    return moved


# Each task, and how far what its rows stand for moves from one configuration to another.
CASES = {
    "along_force": (lambda r, s: AlongForce(DirectInteraction(s)), along_push),
    "base_avoidance": (lambda r, s: avoiding(), on_the_ground),
    "body_compliance": (lambda r, s: BodyCompliance(Posture(np.zeros(JOINTS), torques=True)), generalized),
    "cartesian_pose": (lambda r, s: CartesianPose(HAND, POINT), lambda a, b, m: moved_pose(a, b, HAND, POINT)),
    "center_of_mass": (lambda r, s: CenterOfMass(np.zeros(3)), lambda a, b, m: b.com()[0] - a.com()[0]),
    "compliant_wrist": (
        lambda r, s: CompliantWrist(s, "hand", POINT),
        lambda a, b, m: m.pose(HAND)[1].T @ moved_pose(a, b, HAND)[3:],
    ),
    "contact_force": (lambda r, s: ContactForce(s, "hand", POINT, NORMAL), along_normal),
    "direct_interaction": (lambda r, s: DirectInteraction(s), lambda a, b, m: links_that_feel(a, b)),
    "point_force": (lambda r, s: pushed(r), lambda a, b, m: moved_pose(a, b, HAND, POINT)[:3]),
    "posture": (
        lambda r, s: Posture(np.zeros(JOINTS), joints=[5, 2]),
        lambda a, b, m: (b.joint_positions - a.joint_positions)[[5, 2]],
    ),
    "pressure_interaction": (lambda r, s: PressureInteraction(s, 1e-3), lambda a, b, m: links_that_feel(a, b)),
    "proximity_interaction": (lambda r, s: ProximityInteraction(s, 100.0), lambda a, b, m: links_that_feel(a, b)),
    "self_collision": (lambda r, s: SelfCollision([BALLS], 9.0, 10.0), lambda a, b, m: np.array([apart(b) - apart(a)])),
    "support": (
        lambda r, s: Support({"a": Standing(HAND, POINT), "b": Standing(ARM, POINT, flat=False)}),
        lambda a, b, m: np.hstack([moved_pose(a, b, HAND, POINT), moved_pose(a, b, ARM, POINT)[:3]]),
    ),
    "tactile_guidance": (
        lambda r, s: TactileGuidance(s, ["arm"], HAND, POINT),
        lambda a, b, m: moved_pose(a, b, HAND, POINT)[:3],
    ),
    "temperature_interaction": (lambda r, s: TemperatureInteraction(s, 1.0), lambda a, b, m: links_that_feel(a, b)),
}


def test_no_task_is_left_out():
    modules = [f"plantar.wholebody.tasks.{m.name}" for m in pkgutil.iter_modules(plantar.wholebody.tasks.__path__)]
    classes = [c for m in modules for c in vars(importlib.import_module(m)).values() if isinstance(c, type)]
    tasks = {c.__name__ for c in classes if c.__module__ in modules and hasattr(c, "demand")}
    names = {re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower() for name in tasks - {"Task", "SkinInteraction"}}
    assert names == set(CASES)


@pytest.fixture
def skin():
    """A patch on the arm and one on the hand, all of whose taxels feel, see and are warm."""
    rng = np.random.default_rng(0)

    def patch(name, link):
        rotations = np.linalg.qr(rng.normal(size=(3, 3, 3)))[0]
        return SkinPatch(name, link, rng.uniform(-0.1, 0.1, (3, 3)), rotations, np.full(3, 7e-4))

    return BodySkin([patch("arm", ARM), patch("hand", HAND)])


@pytest.mark.parametrize("floating", [False, True])
@pytest.mark.parametrize("name", CASES)
def test_jacobian_and_drift_are_derivatives(random_chain, skin, name, floating):
    make, moves = CASES[name]
    rng = np.random.default_rng(7)
    robots = [random_chain(np.random.default_rng(11), JOINTS, floating) for _ in range(3)]
    model = robots[0].model
    velocity = rng.uniform(-1.0, 1.0, model.nv)
    middle = model.qpos0.copy()
    mujoco.mj_integratePos(model, middle, rng.uniform(-1.0, 1.0, model.nv), 1.0)
    for robot, step in zip(robots, (-STEP, 0.0, STEP), strict=True):
        position = middle.copy()
        mujoco.mj_integratePos(model, position, velocity, step)
        robot.update(position, velocity, 0.0)
    reading = Reading(0.0, np.ones(6), np.full(6, 0.02), np.full(6, 60.0))
    before, now, after = (make(robot, skin).demand(robot, reading) for robot in robots)
    given = (robots[0], robots[2], robots[1], skin)
    moving = moves(*given[: moves.__code__.co_argcount]) / (2.0 * STEP)
    assert np.allclose(now.jacobian @ velocity, moving, rtol=1e-6, atol=1e-6)
    if now.acceleration is not None:
        speeds = (after.jacobian @ velocity - before.jacobian @ velocity) / (2.0 * STEP)
        drift = np.zeros_like(speeds) if now.drift is None else now.drift
        assert np.allclose(drift, speeds, rtol=1e-6, atol=1e-6)
