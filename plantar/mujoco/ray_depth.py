"""How deep in a link the rays of its taxels may begin."""

from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.sensing.link_skin import SkinPatch

_BELOW = 1e-4  # m below a taxel, where it is looked for the link's shapes
_ON = 1e-3  # m: taxels that are farther off a shape are not on it
# Kinds with no other side, or whose rays need a plugin
_ONE_SIDED = (mujoco.mjtGeom.mjGEOM_PLANE, mujoco.mjtGeom.mjGEOM_HFIELD, mujoco.mjtGeom.mjGEOM_SDF)


def ray_depths(model: Any, body: int, patch: SkinPatch, most: float) -> NDArray[np.float64]:
    """Depth (n,) in m below each taxel of a `patch` on a `body`, an id: `most`, or half of a link that is thinner.

    Deeper, a ray would begin in what touches the other side of the link, and take it for what sinks in.
    """
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    turn = data.xmat[body].reshape(3, 3)
    inward = np.ascontiguousarray(patch.rotations[:, :, 2] @ turn.T)
    starts = patch.positions @ turn.T + data.xpos[body] + _BELOW * inward
    own = [g for g in range(model.ngeom) if model.geom_bodyid[g] == body and model.geom_type[g] not in _ONE_SIDED]
    touchable = [g for g in own if model.geom_contype[g] | model.geom_conaffinity[g]]
    depths = np.full(len(patch), most)
    for i, (start, way) in enumerate(zip(starts, inward, strict=True)):
        around = [g for g in touchable or own if 0.0 <= ray_to_geom(model, data, g, start, -way) < _ON]
        through = [ray_to_geom(model, data, g, start, way) for g in around]
        thickness = max(through, default=-1.0) + _BELOW
        if 0.0 < thickness < 2.0 * most - 1e-6:
            depths[i] = 0.5 * thickness
    return depths


def ray_to_geom(
    model: Any,
    data: Any,
    geom: int,
    start: NDArray[np.float64],
    way: NDArray[np.float64],
    normal: NDArray[np.float64] | None = None,
) -> float:
    """Length in m of a ray from a `start` (3,) along a unit `way` (3,) to a geom's surface; -1 for a miss.

    Where it hits, the surface's `normal` (3,) in the world frame is written.
    """
    if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_MESH:
        return float(mujoco.mj_rayMesh(model, data, geom, start, way, normal))
    solid = (data.geom_xpos[geom], data.geom_xmat[geom], model.geom_size[geom])
    return float(mujoco.mju_rayGeom(*solid, start, way, int(model.geom_type[geom]), normal))
