"""Patches of skin: lattices of taxels laid on a link's geoms or meshes.

A patch's z points into the body. A flat lattice is shot along z, a wrapped one towards the x axis; taxels sit where
they meet the surface, turned to its normal.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.arrays import array
from plantar.common.settings.schema import Settings, number, tables, text, whole
from plantar.errors import InputError, LayoutError, RobotError
from plantar.layouts.hex_lattice import HexLattice
from plantar.mechanics.rotation import rotation_from_angles
from plantar.mujoco.ray_depth import ray_to_geom
from plantar.sensing.link_skin import BodySkin, SkinPatch

OBSTACLE_GROUP = 3
"""MuJoCo's group of geoms that skin measures."""

_GRAZING = 0.2  # least cosine between a taxel's ray and the surface's normal


class PatchShape(Settings):
    """One `[[patch]]` of a machine's file. Lengths in m.

    Attributes:
        name: Of the patch.
        link: Link that carries it.
        position: Frame's origin in the link's frame.
        rotation: Roll, pitch, yaw in degrees in the link's frame.
        size: Extent along x and y; with wrap, y goes around (0: all around).
        wrap: Radius around the x axis; 0 for a flat lattice.
        cell_area: Area of a taxel in m^2.
        taxels: Most, nearest to the middle; 0 for all that fit.
        reach: How far outside plane or radius rays begin.
        range: Of the proximity sensors; 0 without.
        threshold: In N, from which a taxel is active.
    """

    name: str = text("")
    link: str = text("")
    position: tuple[float, ...] = tables("a list of 3 numbers")
    rotation: tuple[float, ...] = tables("a list of 3 numbers")
    size: tuple[float, ...] = tables("a list of 2 numbers, 0 or more")
    wrap: float = number(0.0, "m", 0.0, 5.0)
    cell_area: float = number(691e-6, "m^2", 1e-7, 1.0)
    taxels: int = whole(0, "taxels", 0, 100000)
    reach: float = number(0.05, "m", 1e-4, 5.0)
    range: float = number(0.05, "m", 0.0, 5.0)
    threshold: float = number(0.15, "N", 0.0, 1000.0)


def skin_from_tables(model: Any, patches: Iterable[Mapping[str, Any]], where: str) -> BodySkin:
    """Returns the skin of a machine file's `patches`, its `[[patch]]` tables, laid on the links of a `model`, whose
    obstacles carry none.

    A RobotError with the file's name, `where`, if value or link is invalid; a LayoutError if a patch misses, or names
    repeat.
    """
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    found = []
    for i, table in enumerate(patches):
        place = f"{where}: [[patch]] {i + 1}"
        shape = PatchShape.from_table(table, place, RobotError)
        if not shape.name:
            raise RobotError(f"{place} has no 'name'; allowed: a text")
        found.append(_patch(model, data, shape, f"{where}: patch '{shape.name}'"))
    return BodySkin(found)


def _patch(model: Any, data: Any, shape: PatchShape, where: str) -> SkinPatch:
    names = [model.body(i).name for i in range(1, model.nbody)]
    if shape.link not in names:
        raise RobotError(f"{where} is on link '{shape.link}', which the robot has not; allowed: {', '.join(names)}")
    starts, ways, turn = _rays(shape, where)
    body = model.body(shape.link).id
    lengths, normals = _meet(model, data, body, starts, ways)
    longest = shape.wrap + shape.reach if shape.wrap else 2.0 * shape.reach
    on = (lengths >= 0.0) & (lengths <= longest) & (-np.einsum("ij,ij->i", normals, ways) >= _GRAZING)
    if not on.any():
        raise LayoutError(
            f"{where} meets no surface of link '{shape.link}' within {longest:g} m; move its frame, or raise 'reach'"
        )
    points = starts[on] + lengths[on, None] * ways[on]
    return SkinPatch(
        name=shape.name,
        link=shape.link,
        positions=points,
        rotations=_frames(-normals[on], turn[:, 0]),
        areas=np.full(len(points), shape.cell_area),
        force_threshold=shape.threshold,
        proximity_range=shape.range,
    )


def _rays(shape: PatchShape, where: str) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    # Starts (n, 3) and directions (n, 3) in the link's frame, and the patch's rotation (3, 3).
    origin = _vector(shape.position, "position", 3, where)
    roll, pitch, yaw = np.radians(_vector(shape.rotation, "rotation", 3, where)).tolist()
    turn = rotation_from_angles(yaw, pitch, roll)
    size = _vector(shape.size, "size", 2, where)
    if (size < 0.0).any() or (not shape.wrap and (size == 0.0).any()):
        raise RobotError(f"{where}: 'size' is {size.tolist()} m; allowed: above 0, and 0 for y with wrap")
    if shape.wrap and size[1] == 0.0:
        size[1] = 2.0 * math.pi * shape.wrap
    lattice = HexLattice(shape.cell_area)
    try:
        cells = lattice.centres(lattice.cells_near(-0.5 * size, 0.5 * size))
    except InputError as problem:
        raise RobotError(f"{where}: {problem}") from None
    cells = cells[(np.abs(cells[:, 0]) <= 0.5 * size[0]) & (cells[:, 1] >= -0.5 * size[1] - 1e-9)]
    cells = cells[cells[:, 1] < 0.5 * size[1] + (-1e-9 if shape.wrap else 1e-9)]
    if shape.taxels:
        nearest = np.argsort(np.round(np.hypot(*cells.T), 9), kind="stable")[: shape.taxels]
        cells = cells[np.sort(nearest)]
    if shape.wrap:
        angle = cells[:, 1] / shape.wrap
        ways = np.column_stack([np.zeros(len(cells)), -np.sin(angle), np.cos(angle)])
        starts = np.column_stack([cells[:, 0], np.zeros((len(cells), 2))]) - (shape.wrap + shape.reach) * ways
    else:
        ways = np.tile([0.0, 0.0, 1.0], (len(cells), 1))
        starts = np.column_stack([cells, np.full(len(cells), -shape.reach)])
    return origin + starts @ turn.T, ways @ turn.T, turn


def _meet(
    model: Any, data: Any, body: int, starts: NDArray[np.float64], ways: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    # Lengths (n,) of rays in a body's frame, -1 for misses, and surface normals (n, 3).
    place = data.xpos[body]
    turn = data.xmat[body].reshape(3, 3)
    begin = model.body_geomadr[body]
    geoms = [g for g in range(begin, begin + model.body_geomnum[body]) if model.geom_group[g] != OBSTACLE_GROUP]
    lengths = np.full(len(starts), -1.0)
    normals = np.zeros((len(starts), 3))
    normal = np.zeros(3)
    for i, (start, way) in enumerate(zip(starts @ turn.T + place, ways @ turn.T, strict=True)):
        for g in geoms:
            length = ray_to_geom(model, data, g, start, way, normal)
            if length >= 0.0 and (lengths[i] < 0.0 or length < lengths[i]):
                lengths[i] = length
                normals[i] = normal @ turn
    return lengths, normals


def _frames(inward: NDArray[np.float64], forward: NDArray[np.float64]) -> NDArray[np.float64]:
    # Rotations (n, 3, 3) with z along `inward` (n, 3) and x near `forward` (3,).
    x = forward - (inward @ forward)[:, None] * inward
    lost = np.linalg.norm(x, axis=1) < 1e-6
    x[lost] = np.cross(inward[lost], [[0.3, 0.5, 0.8]])
    x /= np.linalg.norm(x, axis=1)[:, None]
    return np.stack([x, np.cross(inward, x), inward], axis=2)


def _vector(value: Sequence[float], name: str, count: int, where: str) -> NDArray[np.float64]:
    given = value if value or name != "rotation" else (0.0, 0.0, 0.0)
    return array(list(given), f"{where}: '{name}'", (count,), RobotError, finite=True).copy()
