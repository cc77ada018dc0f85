"""Bipeds that are drawn by lot, with what there is to be found in them: no robot that anybody has seen."""

from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]
X, Y, Z = np.eye(3)
ORDERS = (
    (Z, X, Y, Y, Y, X),
    (Y, X, Z, Y, Y, X),
    (X, Z, Y, Y, X, Y),
    (X, Y, Z, Y, Y, X),
    (Z, X, Y, Y, Y),
    (X, Z, Y, Y, Y),
    (Z, X, Y, Y, Z, Y, X),
)
"""Axes of a leg's hinges from hip to ankle: six, five without ankle roll, and seven with a turn below the knee."""

FEET = ("box", "boxes", "balls", "capsules", "mesh", "plate and ball")


@dataclass(frozen=True)
class Truth:
    """What is to be found in a biped.

    Attributes:
        file: Its MJCF.
        joints: Names of the hinges of each leg.
        feet: Names of the feet's bodies.
        soles: The middle (3,) of each sole and the rotation (3, 3) of its body's frame, both in the world of the model.
        pitched: Rotation (3, 3) of the soles against level ground in the model's posture.
        size: Length and width of a sole in m.
        rotation: Rotation (3, 3) from x forward, y left, z up to the model's world.
        mass: In kg.
        imu: Whether it has one.
    """

    file: Path
    joints: dict[str, list[str]]
    feet: dict[str, str]
    soles: dict[str, tuple[Array, Array]]
    pitched: Array
    size: tuple[float, float]
    rotation: Array
    mass: float
    imu: bool


class _Link:
    """A body being built, at a place of the world with a frame of its own."""

    def __init__(self, body: mujoco.MjsBody, position: Array, rotation: Array) -> None:
        self.body, self.position, self.rotation = body, position, rotation

    def child(self, name: str, position: Array, rotation: Array) -> "_Link":
        body = self.body.add_body(
            name=name, pos=self.rotation.T @ (position - self.position), quat=_quaternion(self.rotation.T @ rotation)
        )
        return _Link(body, position, rotation)

    def hinge(self, name: str, axis: Array, low: float, high: float) -> None:
        self.body.add_joint(
            name=name, axis=self.rotation.T @ axis, range=[low, high], limited=mujoco.mjtLimited.mjLIMITED_TRUE
        )

    def mass(self, mass: float, center: Array, size: float) -> None:
        self.body.mass, self.body.ipos = mass, self.rotation.T @ (center - self.position)
        self.body.inertia, self.body.explicitinertial = np.full(3, 0.1 * mass * size**2), True

    def geom(self, kind: str, center: Array, turn: Array, **options: object) -> None:
        self.body.add_geom(
            type=getattr(mujoco.mjtGeom, f"mjGEOM_{kind.upper()}"),
            pos=self.rotation.T @ (center - self.position),
            quat=_quaternion(self.rotation.T @ turn),
            mass=0.0,
            **options,
        )


def _quaternion(rotation: Array) -> Array:
    return np.roll(Rotation.from_matrix(rotation).as_quat(), 1)


def random_biped(seed: int, folder: Path, order: tuple[Array, ...] = ()) -> Truth:
    """Draw a biped and write its model; its legs have the axes of an order, or drawn ones."""
    rng = np.random.default_rng(seed)
    world = (
        np.eye(3)
        if rng.random() < 0.7
        else Rotation.from_euler("z", rng.choice([90.0, 180.0, -90.0]), True).as_matrix()
    )
    mass = float(np.exp(rng.uniform(np.log(3.0), np.log(95.0))))
    leg = 0.17 * mass**0.33 * rng.uniform(0.9, 1.1)
    thigh = leg * rng.uniform(0.45, 0.55)
    axes = ORDERS[int(rng.integers(len(ORDERS)))]
    axes = order or axes
    hip, ankle = leg * rng.uniform(0.12, 0.2), leg * rng.uniform(0.1, 0.18)
    length = max(0.11, leg * rng.uniform(0.3, 0.42))
    width = max(0.05, length * rng.uniform(0.35, 0.5))
    heel = rng.uniform(0.25, 0.42)
    spec = mujoco.MjSpec()
    spec.modelname, spec.compiler.degree = "drawn", False
    labels = rng.permutation(1000)[:60].tolist()
    name = iter([f"part {k}" if rng.random() < 0.5 else f"b{k}_left" for k in labels])

    def turn(chance: float) -> Array:
        return (
            Rotation.random(random_state=int(rng.integers(1 << 30))).as_matrix() if rng.random() < chance else np.eye(3)
        )

    def at(x: float, y: float, z: float) -> Array:
        return np.asarray(world @ np.array([x, y, z]))

    height = leg + ankle + 0.05
    base = turn(0.3)
    pelvis = _Link(
        spec.worldbody.add_body(name="trunk", pos=at(0, 0, height), quat=_quaternion(base)), at(0, 0, height), base
    )
    if rng.random() < 0.6:
        pelvis.body.add_freejoint()
    pelvis.mass(0.6 * mass, at(0.0, 0.0, height + 0.3 * leg), leg)
    pelvis.geom("box", at(0, 0, height + 0.3 * leg), world, size=[0.1 * leg, 0.2 * leg, 0.3 * leg])
    imu = bool(rng.random() < 0.5)
    if imu:
        pelvis.body.add_site(name="sensor")
        spec.add_sensor(name="g", type=mujoco.mjtSensor.mjSENS_GYRO, objtype=mujoco.mjtObj.mjOBJ_SITE, objname="sensor")
    kind, foot_turns = FEET[int(rng.integers(len(FEET)))], {s: turn(0.8) for s in ("left", "right")}
    pitched = Rotation.from_euler("y", float(rng.uniform(-15, 15)) * (rng.random() < 0.3), True).as_matrix()
    toes = bool(rng.random() < 0.3)
    joints: dict[str, list[str]] = {}
    feet, soles = {}, {}
    for side in rng.permutation(["left", "right"]).tolist():
        y = hip if side == "left" else -hip
        link, joints[side], pitches = pelvis, [], 0
        for k, axis in enumerate(axes):
            pitches += axis is Y
            down = (0.0, 0.0, thigh, leg)[min(pitches, 3)] if k < len(axes) - 1 or axis is not X else leg
            down = leg if k >= len(axes) - (2 if axis is X or axes[-1] is X else 1) and k > 2 else down
            sign = rng.choice([-1.0, 1.0])
            last = k == len(axes) - 1
            body = next(name)
            link = link.child(body, at(0.0, y, height - down), foot_turns[side] if last else turn(0.2))
            joints[side].append(f"hinge {next(name)} {side == 'left'}")
            low, high = (-0.1, 2.4) if axis is Y and pitches == 2 else (-1.2, 1.2)
            link.hinge(joints[side][-1], sign * world @ axis, *((low, high) if sign > 0 else (-high, -low)))
            link.mass(0.2 * mass / len(axes), at(0.0, y, height - down - 0.02 * leg), 0.3 * leg)
        feet[side] = body
        joint, flat = at(0.0, y, height - leg), world @ pitched
        middle = joint + flat @ np.array([(0.5 - heel) * length, 0.0, -ankle])
        soles[side] = (middle, foot_turns[side])
        rear = length
        if toes:  # the front third hangs on a hinge of its own
            rear = 0.67 * length
            ahead = middle + flat @ np.array([0.5 * rear, 0.0, 0.0])
            toe = link.child(f"toe {side}", ahead, np.eye(3))
            toe.hinge(f"toe hinge {side}", flat @ Y, -0.5, 0.5)
            toe.mass(0.005 * mass, ahead, 0.1 * leg)
            _add_foot(spec, toe, "box", ahead, flat, (length - rear, width, ankle), f"{side} toe")
            middle = middle - flat @ np.array([0.5 * (length - rear), 0.0, 0.0])
        _add_foot(spec, link, kind, middle, flat, (rear, width, ankle), side)
    _add_arms(pelvis, rng, at, world, height, leg, mass)
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1])
    spec.compile()
    file = folder / f"drawn_{seed}.xml"
    file.write_text(spec.to_xml())
    total = float(np.sum([b.mass for b in spec.bodies]))
    return Truth(file, joints, feet, soles, pitched, (length, width), world, total, imu)


def _add_foot(spec, link, kind, middle, world, size, side):
    """Shapes of a foot whose sole has its middle at a point of the world."""
    length, width, height = size
    half, thick = np.array([0.5 * length, 0.5 * width]), 0.15 * height

    def at(x: float, y: float, z: float) -> Array:
        return np.asarray(middle + world @ np.array([x, y, z]))

    if kind == "box":
        link.geom("box", at(0, 0, thick), world, size=[*half, thick])
    elif kind == "boxes":
        for x in (-0.5, 0.0, 0.5):
            link.geom("box", at(x * half[0], 0, thick), world, size=[0.5 * half[0], half[1], thick])
    elif kind == "balls":
        for x in (-1, 1):
            for y in (-1, 1):
                link.geom("sphere", at(x * (half[0] - thick), y * (half[1] - thick), thick), world, size=[thick, 0, 0])
    elif kind == "capsules":
        along = world @ Rotation.from_euler("y", 90, True).as_matrix()
        for y in (-1, 1):
            link.geom("capsule", at(0, y * (half[1] - thick), thick), along, size=[thick, half[0] - thick, 0])
    elif kind == "mesh":
        corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (0, 2)]) * [*half, thick]
        corners = np.vstack([corners, [[0.0, 0.0, 0.6 * height]]])
        local = (corners @ world.T + middle - link.position) @ link.rotation
        faces = ConvexHull(local).simplices
        out = np.cross(local[faces[:, 1]] - local[faces[:, 0]], local[faces[:, 2]] - local[faces[:, 0]])
        inward = np.einsum("ij,ij->i", out, local[faces[:, 0]] - local.mean(axis=0)) < 0
        faces[inward] = faces[inward][:, ::-1]
        spec.add_mesh(name=f"foot {side}", uservert=local.ravel(), userface=faces.ravel())
        link.body.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=f"foot {side}", mass=0.0, contype=0, conaffinity=0)
    else:
        link.geom("box", at(0, 0, thick), world, size=[*half, thick], contype=0, conaffinity=0)
        link.geom("sphere", at(0, 0, height), world, size=[0.4 * thick, 0, 0])


def _add_arms(pelvis, rng, at, world, height, leg, mass):
    """Arms of many hinges that hang down, not as far as the feet."""
    for y in (-0.25 * leg, 0.25 * leg):
        link = pelvis
        count = int(rng.integers(1, 8))
        for k in range(count):
            place = at(0.0, y, height + 0.5 * leg - 0.8 * leg * k / 7)
            link = link.child(f"arm {y:.4f} {k}", place, np.eye(3))
            link.hinge(f"turn {y:.4f} {k}", world @ (X, Y, Z)[int(rng.integers(3))], -2.0, 2.0)
            link.mass(0.1 * mass / count, place, 0.2 * leg)
            link.geom("sphere", place, world, size=[0.04 * leg, 0, 0])
