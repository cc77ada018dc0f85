"""Collision shapes between the legs: the model's own, or massless capsules along the links."""

from collections.abc import Collection, Mapping
from itertools import product
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.robots.robot import Robot

COLLIDES: Mapping[Side, tuple[int, int]] = {"left": (4, 8), "right": (8, 4)}
"""MuJoCo's contype and conaffinity of each leg's shapes."""

_LONG = 0.125  # of the CoM height: shorter links get no capsule
_SLENDER = 0.15  # radius of a capsule as a share of the link's length
_HIP_SHARE = 0.2  # of a link at its upper end that is left out: thighs meet in the hip
_FOOT_HEIGHT = 0.05  # of the CoM height, above the shoe
_CLEAR = 0.00625  # of the CoM height between the legs in the robot's posture
_SMALLER = 0.8
_TRIES = 12
_KINDS = tuple(
    getattr(mujoco.mjtGeom, f"mjGEOM_{name}") for name in ("SPHERE", "CAPSULE", "ELLIPSOID", "CYLINDER", "BOX")
)


def add_leg_shapes(spec: Any, robot: Robot, own: Collection[str] = ()) -> None:
    """Give each leg shapes that collide only with the other's.

    Takes `spec`, `robot` and `own`.
    """
    for side in SIDES:
        chain = _links(spec, robot, side)
        for body, child in zip(chain, [*chain[1:], None], strict=True):
            kept = [g for g in body.geoms if g.name in own and g.type in _KINDS]
            for geom in kept:
                _collide(geom, side)
            if child is not None and not kept:
                _add_capsule(body, np.array(child.pos), side, _LONG * robot.com_height)
        _add_foot(spec, side, _FOOT_HEIGHT * robot.com_height)


def _links(spec: Any, robot: Robot, side: Side) -> list[Any]:
    leg = robot.legs[side]
    chain = [spec.body(leg.foot_body)]
    first = spec.joint(leg.joints[0]).parent
    while chain[-1].name != first.name:
        chain.append(chain[-1].parent)
    return chain[::-1]


def _add_capsule(body: Any, end: NDArray[np.float64], side: Side, least: float) -> None:
    """A link's shape up to the next link at `end` (3,) in m; none below `least` in m."""
    length = float(np.linalg.norm(end))
    if length < least:
        return
    ends = [*(_HIP_SHARE * end), *end]
    shape = body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_CAPSULE, fromto=ends, size=[_SLENDER * length, 0.0, 0.0], group=4, mass=0.0
    )
    _collide(shape, side)


def _add_foot(spec: Any, side: Side, height: float) -> None:
    sole = spec.geom(f"{side}_sole_box")
    half = np.array(sole.size)
    half[2] += 0.5 * height
    box = sole.parent.add_geom(name=f"{side}_foot_shape", type=mujoco.mjtGeom.mjGEOM_BOX, size=half, group=4, mass=0.0)
    box.pos = np.array(sole.pos) + np.array([0.0, 0.0, 0.5 * height])
    _collide(box, side)


def _collide(geom: Any, side: Side) -> None:
    geom.contype, geom.conaffinity = COLLIDES[side]
    geom.condim = 1  # no friction: what counts is that they touch
    geom.margin = 0.0
    geom.gap = 0.0
    geom.solref = [0.005, 1.0]
    geom.solimp = [0.95, 0.99, 0.001, 0.5, 2]


def keep_apart(model: Any, robot: Robot) -> None:
    """Shrink the legs' shapes, except feet, until apart and off the ground in the robot's posture, or disable them.

    Takes `model`.
    """
    data = mujoco.MjData(model)
    for side in SIDES:
        for name, angle in zip(robot.legs[side].joints, robot.posture[side], strict=True):
            data.qpos[model.joint(name).qposadr[0]] = angle
    mujoco.mj_kinematics(model, data)
    feet = {model.geom(f"{s}_foot_shape").id for s in SIDES}
    legs = {s: [g for g in range(model.ngeom) if int(model.geom_contype[g]) == COLLIDES[s][0]] for s in SIDES}
    for side in SIDES:
        ground = float(data.site_xpos[model.site(robot.legs[side].sole_site).id, 2])
        for geom in legs[side]:
            if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_CAPSULE:
                _lift(model, data, geom, ground + _CLEAR * robot.com_height)
    for a, b in product(legs["left"], legs["right"]):
        free = [g for g in (a, b) if g not in feet]
        if free:
            _clear(model, data, (a, b), free, _CLEAR * robot.com_height)


def _lift(model: Any, data: Any, capsule: int, least: float) -> None:
    """Thin a capsule whose round end, about a low ankle, is below the height `least` in m."""
    radius, half, _ = model.geom_size[capsule].tolist()
    end = float(data.geom_xpos[capsule, 2]) - half * abs(float(data.geom_xmat[capsule, 8]))
    if end - radius < least < end:
        model.geom_size[capsule, 0] = end - least


def _clear(model: Any, data: Any, pair: tuple[int, int], free: list[int], least: float) -> None:
    """Shrink two geoms until `least` m apart; disable them if that fails."""
    for _ in range(_TRIES):
        if mujoco.mj_geomDistance(model, data, *pair, least, None) >= least:
            return
        model.geom_size[free] *= _SMALLER
    model.geom_contype[free] = 0
    model.geom_conaffinity[free] = 0
