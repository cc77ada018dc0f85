"""A model's shapes as 3D viewer primitives in body frames."""

from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.mujoco.mesh_surface import mesh_surface
from plantar.mujoco.quaternions import rotation_of
from plantar.recordings.foxglove import Message, cube, cylinder, entity, pose, sphere, triangles

_SHOWN = (0, 1, 2)  # groups of geoms that MuJoCo's own viewer shows at first
_UNSET = (0.5, 0.5, 0.5, 1.0)  # colour of a geom that takes its material's
_FLOOR = 20.0  # m: side of what is drawn of an endless plane
_FACES = 60_000  # of all meshes of a model together; what is finer is drawn coarser

_Geom = mujoco.mjtGeom


def frame_name(model: Any, body: int) -> str:
    """Returns the name of a `body` of a `model`, else its number; "world" for the world."""
    return str(model.body(body).name) or f"body_{body}"


def drawn_bodies(model: Any) -> list[int]:
    """Ids of visible bodies, without the world."""
    return sorted({int(model.geom_bodyid[i]) for i in range(model.ngeom) if _is_shown(model, i)} - {0})


def body_entity(model: Any, body: int) -> Message:
    """Returns a `body` of a `model`, its visible geoms, as `plantar.recordings.foxglove.entity` in its frame."""
    name = frame_name(model, body)
    geoms = [i for i in range(model.ngeom) if model.geom_bodyid[i] == body and _is_shown(model, i)]
    return entity(name, name, *(part for i in geoms for part in _primitives(model, i)))


def _is_shown(model: Any, geom: int) -> bool:
    return int(model.geom_group[geom]) in _SHOWN and _colour(model, geom)[3] > 0.0


def _colour(model: Any, geom: int) -> tuple[float, ...]:
    rgba = model.geom_rgba[geom].astype(float)
    material = int(model.geom_matid[geom])
    if material >= 0:
        rgba = model.mat_rgba[material].astype(float) if tuple(rgba) == _UNSET else rgba
        texture = int(model.mat_texid[material, mujoco.mjtTextureRole.mjTEXROLE_RGB])
        if texture >= 0:
            count = int(model.tex_height[texture]) * int(model.tex_width[texture]) * int(model.tex_nchannel[texture])
            first = int(model.tex_adr[texture])
            pixels = model.tex_data[first : first + count].reshape(-1, int(model.tex_nchannel[texture]))
            rgba[:3] *= pixels[:, :3].mean(axis=0) / 255.0
    return tuple(rgba.round(4).tolist())


def _primitives(model: Any, geom: int) -> list[Message]:
    kind = int(model.geom_type[geom])
    colour = _colour(model, geom)
    a, b, c = map(float, model.geom_size[geom])
    position = tuple(map(float, model.geom_pos[geom]))
    w, x, y, z = map(float, model.geom_quat[geom])
    rotation = (x, y, z, w)
    place = pose(position, rotation)
    if kind == _Geom.mjGEOM_PLANE:
        thin = 1e-3
        below = np.array(position) - thin * _axis(model, geom)
        return [cube(pose(tuple(below.tolist()), rotation), (2 * a or _FLOOR, 2 * b or _FLOOR, 2 * thin), colour)]
    ball = (2 * a, 2 * a, 2 * a)
    if kind == _Geom.mjGEOM_BOX:
        return [cube(place, (2 * a, 2 * b, 2 * c), colour)]
    if kind in (_Geom.mjGEOM_SPHERE, _Geom.mjGEOM_ELLIPSOID):
        return [sphere(place, ball if kind == _Geom.mjGEOM_SPHERE else (2 * a, 2 * b, 2 * c), colour)]
    if kind in (_Geom.mjGEOM_CYLINDER, _Geom.mjGEOM_CAPSULE):
        ends = (b, -b) if kind == _Geom.mjGEOM_CAPSULE else ()
        tops = [tuple((np.array(position) + end * _axis(model, geom)).tolist()) for end in ends]
        caps = [sphere(pose(top, rotation), ball, colour) for top in tops]
        return [cylinder(place, (2 * a, 2 * a, 2 * b), colour), *caps]
    return [_mesh(model, geom, colour)] if kind == _Geom.mjGEOM_MESH else []


def _axis(model: Any, geom: int) -> NDArray[np.float64]:
    """A geom's z axis (3,) in its body's frame."""
    return rotation_of(model.geom_quat[geom])[:, 2]


def _mesh(model: Any, geom: int, colour: tuple[float, ...]) -> Message:
    vertices, faces = mesh_surface(model, int(model.geom_dataid[geom]))
    share = _FACES / model.nmeshface
    if share < 1.0:
        vertices, faces = coarse_mesh(vertices, faces, max(4, int(share * len(faces))))
    placed = vertices @ rotation_of(model.geom_quat[geom]).T + model.geom_pos[geom]
    return triangles(np.round(placed, 5).tolist(), faces, colour)


def coarse_mesh(
    vertices: NDArray[np.float64], faces: NDArray[np.int64], most: int
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Returns corners and triangles of `vertices` (v, 3) in m and `faces` (f, 3), at most `most`.

    Vertices in one cell of a lattice merge (Rossignac and Borrel, 1993).
    """
    size = float(np.ptp(vertices, axis=0).max())
    cells = 128
    coarse = vertices
    kept = faces
    while len(kept) > most and cells > 0:
        lattice = np.floor((vertices - vertices.min(axis=0)) / (size / cells)).astype(np.int64).clip(max=cells - 1)
        owner = np.unique(lattice, axis=0, return_inverse=True)[1].ravel()
        counts = np.bincount(owner)
        coarse = np.column_stack([np.bincount(owner, weights=column) / counts for column in vertices.T])
        moved = owner[faces]
        whole = (moved != np.roll(moved, 1, axis=1)).all(axis=1)
        kept = np.unique(moved[whole], axis=0)
        cells = int(0.8 * cells)
    return coarse, kept
