"""Taxels, and a sole's center of pressure and support polygon, drawn into a MuJoCo scene."""

from typing import Any

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import number
from plantar.layouts.layout import SoleLayout
from plantar.mujoco.bound_skin import BoundSkin
from plantar.percepts.percept import Percept

_LIFT = 0.001  # m below the sole, where the ground does not hide it
_UNLOADED = np.array([0.55, 0.6, 0.65, 0.5])
_LOADED = np.array([0.9, 0.15, 0.1, 0.9])
_EDGE = np.array([0.1, 0.35, 0.9, 1.0])
_COP = np.array([1.0, 0.85, 0.1, 1.0])


def draw_skin(scene: Any, feel: BoundSkin, data: Any, *, full: float | None = None, lift: float = _LIFT) -> int:
    """Add a skin to `viewer.user_scn`, or a renderer's `scene` after `update_scene`.

    Args:
        scene: The `mujoco.MjvScene`, as far as it has room.
        feel: The skin.
        data: The MjData.
        full: Force in N of a taxel in full color; None for the reading's largest.
        lift: Distance in m outside the sole.

    Returns:
        Number of added geoms.
    """
    reading = feel(data)
    pose = feel.pose(data)
    turn = pose.rotation_sole_to_world
    top = max(float(reading.force.max(initial=0.0)), 1e-9) if full is None else number(full, "full force", finite=True)
    start = scene.ngeom
    kinds = mujoco.mjtGeom
    cells = feel.layout
    for place, frame, force, area in zip(cells.positions, cells.rotations, reading.force, cells.areas, strict=True):
        share = min(force / top, 1.0)
        size = [0.45 * float(np.sqrt(area))] * 2 + [3e-4]
        color = (1.0 - share) * _UNLOADED + share * _LOADED
        _add(scene, kinds.mjGEOM_CYLINDER, size, pose.to_world(place - lift * frame[:, 2]), turn @ frame, color)
    if feel.is_patch or not isinstance(cells, SoleLayout):
        return int(scene.ngeom - start)
    ring = Percept(cells, reading).support_polygon_in_sole
    for first, second in zip(ring, np.roll(ring, -1, axis=0), strict=True):
        line = _add(scene, kinds.mjGEOM_CAPSULE, np.zeros(3), np.zeros(3), np.eye(3), _EDGE)
        if line is not None:
            ends = pose.to_world([*first, -lift]), pose.to_world([*second, -lift])
            mujoco.mjv_connector(line, kinds.mjGEOM_CAPSULE, 0.0015, *ends)
    cop = reading.position_cop_in_sole
    if cop is not None:
        _add(scene, kinds.mjGEOM_SPHERE, [0.006] * 3, pose.to_world([*cop, 0.0]), turn, _COP)
    return int(scene.ngeom - start)


def _add(
    scene: Any, kind: Any, size: ArrayLike, place: NDArray[np.float64], turn: NDArray[np.float64], colour: ArrayLike
) -> Any:
    if scene.ngeom >= scene.maxgeom:
        return None
    geom = scene.geoms[scene.ngeom]
    scene.ngeom = scene.ngeom + 1
    mujoco.mjv_initGeom(geom, kind, np.asarray(size), place, turn.ravel(), np.asarray(colour, dtype=np.float32))
    geom.category = mujoco.mjtCatBit.mjCAT_DECOR
    return geom
