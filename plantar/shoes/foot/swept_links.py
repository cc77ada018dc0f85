"""Where the robot's other links pass around its foot while the ankle moves: points in the frame of the foot's body."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FootError
from plantar.shoes.foot.model_source import ModelSource, geom_surface
from plantar.shoes.geometry.surface import corner_numbers, surface_points

__all__ = ["swept_points"]

_JOINTS, _LINKS = 2, 3  # of the ankle, and links above the foot that are looked at
_POSES = 5  # of each joint, from end to end of its range
_UNLIMITED = 0.6  # rad to either side of a joint without limits
_NEAR = 0.05  # m around the foot
_SPACING = 0.004  # m between points

Array = NDArray[np.float64]


def swept_points(source: ModelSource, name: str, surface: Array) -> tuple[Array | None, str]:
    """Points of the links above a foot over the range of its ankle: of its last two hinges.

    Args:
        source: The robot's model.
        name: The foot's body.
        surface: Its triangles (k, 3, 3) in m; only what passes near them is kept.

    Returns:
        Points (n, 3) in m about the body's origin, turned as at the zero pose, None where they cannot be read; a note.
    """
    import mujoco

    try:
        model, data = source.links_above(name, _LINKS)
    except FootError as error:
        reason = str(error).removeprefix(f"{source.file}: ")[:100]
        return None, f"the robot's other links are not read: {reason}"
    foot = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name)
    flat = (mujoco.mjtGeom.mjGEOM_PLANE, mujoco.mjtGeom.mjGEOM_HFIELD)
    geoms = [g for g in range(model.ngeom) if model.geom_type[g] not in flat]
    if not geoms:
        return None, "the links above the foot have no shape"
    joints = _ankle(model, foot)
    start = data.xmat[foot].reshape(3, 3).copy()
    places = {g: _thinned(surface_points(geom_surface(model, g, str(source.file)), _SPACING)) for g in geoms}
    low, high = surface.min(axis=(0, 1)) - _NEAR, surface.max(axis=(0, 1)) + _NEAR
    found = []
    for angles in itertools.product(*(np.linspace(*_range(model, j), _POSES) for j in joints)):
        for joint, angle in zip(joints, angles, strict=True):
            data.qpos[model.jnt_qposadr[joint]] = angle
        mujoco.mj_kinematics(model, data)
        turn = start @ data.xmat[foot].reshape(3, 3).T
        for geom, points in places.items():
            world = points @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom]
            near = (world - data.xpos[foot]) @ turn.T
            found.append(near[((near > low) & (near < high)).all(axis=1)])
    spans = ", ".join(f"{np.degrees(np.ptp(_range(model, j))):.0f}" for j in joints)
    swept = _thinned(np.concatenate(found))
    note = f"the links above the foot are swept over {len(joints)} joint(s), {spans} degrees"
    return (swept, note) if len(swept) else (None, "no link above the foot passes near it")


def _thinned(points: Array) -> Array:
    """A point of each cube of the spacing."""
    _, first = np.unique(corner_numbers(1e-3 * points / _SPACING), return_index=True)
    return np.asarray(points[first])


def _ankle(model: Any, foot: int) -> list[int]:
    """The last hinges above a body, the nearest first."""
    import mujoco

    joints: list[int] = []
    body = foot
    while body > 0 and len(joints) < _JOINTS:
        first, count = int(model.body_jntadr[body]), int(model.body_jntnum[body])
        hinges = [j for j in range(first, first + count) if model.jnt_type[j] == mujoco.mjtJoint.mjJNT_HINGE]
        joints += hinges[::-1]
        body = int(model.body_parentid[body])
    return joints[:_JOINTS]


def _range(model: Any, joint: int) -> tuple[float, float]:
    low, high = (float(v) for v in model.jnt_range[joint])
    return (low, high) if model.jnt_limited[joint] and low < high else (-_UNLIMITED, _UNLIMITED)
