"""A box of taxels about all that is welded to a walking robot's base.

Forces act along a face's normal. Taxels have 691 mm^2 on H1, and scale with the robot.
"""

from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.errors import RobotError
from plantar.layouts.hex_lattice import HexLattice
from plantar.mujoco.mesh_surface import mesh_surface
from plantar.sensing.link_skin import BodySkin, SkinPatch

FACES = {"front": (1.0, 0.0), "back": (-1.0, 0.0), "left": (0.0, 1.0), "right": (0.0, -1.0)}
"""Patches of the box and their outward normals, forward and to the left."""

_CELL = 691e-6 / 0.6**2  # leg^2: area of a taxel
_RANGE = 1 / 12  # leg: how far a taxel sees, as those of a sole do
_THRESHOLD = 0.15 / 843.0  # weight: force from which a taxel is active, 0.15 N for H1
_SIGNS = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
_SMALLEST = 0.05  # leg: least edge of the box


def upper_body_skin(model: Any, base: int, *, leg: float, weight: float) -> BodySkin:
    """Returns skin around all that is welded to the `base`, an id, of a robot's `model`: a patch of each of `FACES`,
    in the base frame.

    By its `leg` length in m and `weight` in N; a RobotError if there is no extent.
    """
    low, high = _extent(model, base)
    if (high - low < _SMALLEST * leg).any():
        size = " x ".join(f"{edge:.3f}" for edge in (high - low).tolist())
        raise RobotError(
            f"the upper body on '{model.body(base).name}' measures {size} m, which carries no skin; "
            f"allowed: shapes of {_SMALLEST * leg:.3f} m and more in each direction"
        )
    middle = 0.5 * (low + high)
    half = 0.5 * (high - low)
    lattice = HexLattice(_CELL * leg * leg)
    patches = []
    for name, (forward, left) in FACES.items():
        inward = -np.array([forward, left, 0.0])
        across = np.array([-left, forward, 0.0])
        up = np.array([0.0, 0.0, 1.0])
        wide = float(np.abs(across) @ half)
        tall = float(half[2])
        cells = lattice.centres(lattice.cells_near(np.array([-wide, -tall]), np.array([wide, tall])))
        cells = cells[(np.abs(cells[:, 0]) <= wide) & (np.abs(cells[:, 1]) <= tall)]
        positions = middle - inward * (np.abs(inward) @ half) + cells[:, :1] * across + cells[:, 1:] * up
        turn = np.column_stack([np.cross(up, inward), up, inward])
        patches.append(
            SkinPatch(
                name=name,
                link=model.body(base).name,
                positions=positions,
                rotations=np.tile(turn, (len(cells), 1, 1)),
                areas=np.full(len(cells), lattice.area),
                force_threshold=_THRESHOLD * weight,
                proximity_range=_RANGE * leg,
            )
        )
    return BodySkin(patches)


def _extent(model: Any, base: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    # Lowest and highest coordinates (3,) in the base frame of welded shapes, or inertial boxes.
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    turn = data.xmat[base].reshape(3, 3)
    origin = data.xpos[base]
    welded = model.body_weldid[model.geom_bodyid] == model.body_weldid[base]
    points = [_corners(model, data, g) for g in np.flatnonzero(welded).tolist()]
    if not points:
        links = np.flatnonzero((model.body_weldid == model.body_weldid[base]) & (model.body_mass > 0.0))
        points = [_inertial_box(model, data, b) for b in links.tolist()]
    if not points:
        raise RobotError(f"the upper body on '{model.body(base).name}' has neither shapes nor mass to carry skin")
    local = (np.vstack(points) - origin) @ turn
    return local.min(axis=0), local.max(axis=0)


def _corners(model: Any, data: Any, geom: int) -> NDArray[np.float64]:
    rotation = data.geom_xmat[geom].reshape(3, 3)
    place = data.geom_xpos[geom]
    if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_MESH:
        local = mesh_surface(model, int(model.geom_dataid[geom]))[0]
    else:
        box = model.geom_aabb[geom]
        local = box[:3] + _SIGNS * box[3:]
    return np.asarray(local @ rotation.T + place)


def _inertial_box(model: Any, data: Any, body: int) -> NDArray[np.float64]:
    # Corners (8, 3) in the world of the solid box with a link's mass and inertia.
    inertia = model.body_inertia[body]
    mass = float(model.body_mass[body])
    half = np.sqrt(np.maximum(1.5 / mass * (inertia.sum() - 2.0 * inertia), 0.0))
    return np.asarray(_SIGNS * half @ data.ximat[body].reshape(3, 3).T + data.xipos[body])
