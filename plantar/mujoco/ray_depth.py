"""How deep in a link the rays of its taxels may begin."""

from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.sensing.link_skin import SkinPatch

_BELOW = 1e-4  # m below a taxel, where it is looked for the link's shapes
_ON = 1e-3  # m: taxels that are farther off a shape are not on it
_SHAPES = (mujoco.mjtGeom.mjGEOM_PLANE, mujoco.mjtGeom.mjGEOM_HFIELD, mujoco.mjtGeom.mjGEOM_SDF)


def ray_depths(model: Any, body: int, patch: SkinPatch, most: float) -> NDArray[np.float64]:
    """Depth (n,) in m below each taxel of a `patch` on a `body`, an id: `most`, or half of a link that is thinner.

    Deeper, a ray would begin in what touches the other side of the link, and take it for what sinks in.
    """
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    turn = data.xmat[body].reshape(3, 3)
    inward = np.ascontiguousarray(patch.rotations[:, :, 2] @ turn.T)
    starts = patch.positions @ turn.T + data.xpos[body] + _BELOW * inward
    own = [g for g in range(model.ngeom) if model.geom_bodyid[g] == body and model.geom_type[g] not in _SHAPES]
    touchable = [g for g in own if model.geom_contype[g] | model.geom_conaffinity[g]]
    depths = np.full(len(patch), most)
    for i, (start, way) in enumerate(zip(starts, inward, strict=True)):
        around = [g for g in touchable or own if 0.0 <= _ray(model, data, g, start, -way) < _ON]
        through = [_ray(model, data, g, start, way) for g in around]
        thickness = max(through, default=-1.0) + _BELOW
        if 0.0 < thickness < 2.0 * most - 1e-6:
            depths[i] = 0.5 * thickness
    return depths


def _ray(model: Any, data: Any, geom: int, start: NDArray[np.float64], way: NDArray[np.float64]) -> float:
    """Length in m of a ray to a geom's surface; -1 for a miss."""
    if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_MESH:
        return float(mujoco.mj_rayMesh(model, data, geom, start, way))
    solid = (data.geom_xpos[geom], data.geom_xmat[geom], model.geom_size[geom])
    return float(mujoco.mju_rayGeom(*solid, start, way, int(model.geom_type[geom])))
