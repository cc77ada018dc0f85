"""A robot's foot as the shoe sees it: its outline at the sole and up to the rim, from a mesh or from dimensions."""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FootError, InputError
from shoes.mesh_file import Unit, read_mesh
from shoes.outline import cut_below, outline_below, rounded_rectangle
from shoes.units import MM_PER_M, to_mm

__all__ = ["Foot", "Forward", "foot_from_dimensions", "foot_from_mesh"]

Forward = Literal["x", "-x", "y", "-y"]
"""Axis of the mesh that points to the toes."""

_LENGTHS = (60.0, 450.0)  # mm: what counts as a robot's foot
_UNIT_SIZE = {"m": 1000.0, "cm": 10.0, "mm": 1.0, "in": 25.4}
_TURN = {"x": 0.0, "y": -90.0, "-x": 180.0, "-y": 90.0}
_SOLE_SHARE = 0.4  # of the silhouette: a body whose lowest band is smaller is round below
_HEIGHT_MIN = 5.0  # mm


@dataclass(frozen=True)
class Foot:
    """The left foot of a robot in mm: x forward, y left, z up, the sole plane at z = 0, origin below the ankle.

    Attributes:
        name: Name of the foot or robot.
        sole: Outline of the sole, a shapely polygon.
        outline_up_to: Gives the outline (shapely polygon) of the foot's part below a height above the sole plane.
        height: Height of the foot's geometry in mm; infinite where only dimensions are known.
        notes: What was detected or assumed.
    """

    name: str
    sole: Any
    outline_up_to: Callable[[float], Any]
    height: float
    notes: tuple[str, ...] = ()


def foot_from_dimensions(
    name: str, *, length: float, width: float, sole_center: tuple[float, float], corner_radius: float
) -> Foot:
    """A foot with a rectangular sole and straight sides, as robot files describe it.

    Args:
        name: Name of the robot.
        length: Extent along x in m.
        width: Extent along y in m.
        sole_center: Middle (2,) of the left foot's box against the ankle in m, x forward, y left.
        corner_radius: Corner radius in m.

    Returns:
        The left foot.

    Raises:
        FootError: If a dimension is out of what a foot can be.

    Example:
        >>> foot = foot_from_dimensions("a", length=0.2, width=0.1, sole_center=(0.02, 0.0), corner_radius=0.01)
        >>> foot.sole.bounds
        (-80.0, -50.0, 120.0, 50.0)
    """
    values = (length, width, *sole_center, corner_radius)
    if len(sole_center) != 2 or not all(math.isfinite(v) for v in values):
        raise FootError(f"foot of {name}: length, width, sole_center (x, y) and corner_radius must be finite numbers")
    low, high = _LENGTHS
    if not (low <= to_mm(length) <= high and 0.25 * low <= to_mm(width) <= high):
        raise FootError(
            f"foot of {name} is {length:g} x {width:g} m; allowed: {low / MM_PER_M:g} to {high / MM_PER_M:g} m long"
        )
    if not 0.0 <= corner_radius <= 0.5 * min(length, width):
        raise FootError(f"foot of {name}: corner_radius is {corner_radius:g} m; allowed: 0 to half the width")
    x, y = sole_center
    sole = rounded_rectangle(to_mm(length), to_mm(width), (to_mm(x), to_mm(y)), to_mm(corner_radius))
    note = (
        f"sole from dimensions: {to_mm(length):.1f} x {to_mm(width):.1f} mm, corner radius {to_mm(corner_radius):g} mm"
    )
    return Foot(name, sole, lambda height: sole, math.inf, (note,))


def foot_from_mesh(
    path: str | os.PathLike[str],
    *,
    mesh_side: Literal["left", "right"] = "left",
    unit: Unit | None = None,
    sole_z: float | None = None,
    forward: Forward | None = None,
    sole_band: float = 5.0,
) -> Foot:
    """Read a foot's mesh and find its sole. Watertight or not, loose parts allowed.

    Args:
        path: STL, OBJ, PLY, OFF or 3MF file, z up.
        mesh_side: Which foot the mesh shows; a right foot is mirrored.
        unit: Unit of the file; None detects it from the size.
        sole_z: Height of the sole plane in the mesh's frame in mm; None takes the lowest point.
        forward: Axis of the mesh that points to the toes; None takes x and refuses a foot that is wider than long.
        sole_band: Height in mm of the lowest part that counts as sole.

    Returns:
        The left foot; `notes` say what was detected.

    Raises:
        FootError: If the file is no mesh, or its geometry is no foot.
    """
    if forward is not None and forward not in _TURN:
        raise InputError(f"forward axis is {forward!r}; allowed: {', '.join(_TURN)}")
    if sole_z is not None and not math.isfinite(sole_z):
        raise InputError(f"sole plane is at {sole_z} mm; allowed: a finite height")
    name = Path(path).stem
    triangles, file_unit = read_mesh(path)
    notes: list[str] = []
    scale, note = _unit_scale(triangles, unit, file_unit, str(path))
    notes.append(note)
    triangles = _turned(triangles * scale, forward or "x")
    if forward not in (None, "x"):
        notes.append(f"turned: the mesh's {forward} axis points forward")
    if mesh_side == "right":
        triangles = triangles * np.array([1.0, -1.0, 1.0])
        notes.append("the mesh is a right foot; mirrored to the left")
    if not _is_closed(triangles):
        notes.append("the mesh is not closed; only its outline is used")
    lowest = float(triangles[..., 2].min())
    plane = lowest if sole_z is None else sole_z
    if sole_z is None:
        notes.append(f"sole plane at the mesh's lowest point, z = {plane:.1f} mm")
    else:
        notes.append(f"sole plane at z = {plane:.1f} mm as given")
        if plane - lowest > 1e-6:
            notes.append(f"{plane - lowest:.1f} mm of the mesh lie below the sole plane and are ignored")
    triangles = triangles - np.array([0.0, 0.0, plane])
    flip = np.array([1.0, 1.0, -1.0])
    triangles = cut_below(triangles * flip, 0.0) * flip
    if not len(triangles):
        raise FootError(f"{path}: no part of the mesh lies above the sole plane z = {plane:g} mm")
    sole = _checked_sole(triangles, sole_band, forward, str(path))
    if not _box_holds(sole.bounds, 0.5):
        notes.append("the mesh's origin lies far from the sole: the layout's origin is below it, not below an ankle")
    box = sole.bounds
    notes.append(f"sole {box[2] - box[0]:.1f} x {box[3] - box[1]:.1f} mm (lowest {sole_band:g} mm of the mesh)")
    return Foot(
        name, sole, lambda height: outline_below(triangles, height), float(triangles[..., 2].max()), tuple(notes)
    )


def _unit_scale(
    triangles: NDArray[np.float64], unit: Unit | None, file_unit: Unit | None, path: str
) -> tuple[float, str]:
    """Scale to mm and a note how it was found."""
    points = triangles.reshape(-1, 3)
    extent = float(np.ptp(points[:, :2], axis=0).max())
    low, high = _LENGTHS
    allowed = f"allowed: a foot of {low:g} to {high:g} mm"
    for given, source in ((unit, "as given"), (file_unit, "as the file states")):
        if given is None:
            continue
        size = extent * _UNIT_SIZE[given]
        if not low <= size <= high:
            raise FootError(f"{path}: the foot is {size:.4g} mm long (unit {given} {source}); {allowed}")
        return _UNIT_SIZE[given], f"unit {given} {source}"
    for guess in ("m", "mm"):
        if low <= extent * _UNIT_SIZE[guess] <= high:
            return _UNIT_SIZE[guess], f"unit {guess}, detected from the size ({extent:.4g} {guess} long)"
    raise FootError(
        f"{path}: the foot is {extent:.4g} long, which fits neither m nor mm; {allowed}, "
        "or give the unit (m, cm, mm, in)"
    )


def _turned(triangles: NDArray[np.float64], forward: Forward) -> NDArray[np.float64]:
    angle = math.radians(_TURN[forward])
    c, s = round(math.cos(angle)), round(math.sin(angle))
    return np.asarray(triangles @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]).T)


def _checked_sole(triangles: NDArray[np.float64], sole_band: float, forward: Forward | None, path: str) -> Any:
    """Outline of the lowest band, refused where the body cannot be a foot."""
    import shapely

    points = triangles.reshape(-1, 3)
    length, width, height = (float(v) for v in np.ptp(points, axis=0))
    if height < _HEIGHT_MIN:
        raise FootError(
            f"{path}: the mesh is {height:.3g} mm high ({len(triangles)} triangles); "
            f"allowed: a body of {_HEIGHT_MIN:g} mm or more"
        )
    try:
        sole = outline_below(triangles, sole_band)
    except FootError as error:
        raise FootError(f"{path}: {error}") from None
    share = sole.area / shapely.MultiPoint(points[:, :2]).convex_hull.area
    if share < _SOLE_SHARE:
        raise FootError(
            f"{path}: no flat sole: the lowest {sole_band:g} mm cover {100 * share:.0f} % of the silhouette; "
            f"allowed: {100 * _SOLE_SHARE:.0f} % or more, z up (or give the height of the sole plane)"
        )
    if forward is None and width > 1.05 * length:
        raise FootError(
            f"{path}: the foot is {length:.0f} mm along x and {width:.0f} mm along y; x must point forward "
            f"(or give the forward axis: {', '.join(_TURN)})"
        )
    if max(length, width) < 1.15 * min(length, width) and height > 0.5 * length:
        raise FootError(
            f"{path}: {length:.0f} x {width:.0f} x {height:.0f} mm is a block, not a foot; allowed: longer than wide, "
            "or flatter than half its length"
        )
    box = sole.bounds
    if box[2] - box[0] < _LENGTHS[0] * 0.5 or box[3] - box[1] < 15.0:
        raise FootError(
            f"{path}: the sole is {box[2] - box[0]:.0f} x {box[3] - box[1]:.0f} mm; "
            f"allowed: {_LENGTHS[0] / 2:g} x 15 mm or more"
        )
    return sole


def _box_holds(box: tuple[float, float, float, float], slack: float) -> bool:
    """Whether the origin lies in a box grown by a share of its size."""
    dx, dy = slack * (box[2] - box[0]), slack * (box[3] - box[1])
    return box[0] - dx <= 0.0 <= box[2] + dx and box[1] - dy <= 0.0 <= box[3] + dy


def _is_closed(triangles: NDArray[np.float64]) -> bool:
    """Whether every edge belongs to exactly two triangles."""
    points = np.round(triangles.reshape(-1, 3), 4) + 0.0
    _, index = np.unique(points, axis=0, return_inverse=True)
    faces = index.reshape(-1, 3)
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    edges = edges[edges[:, 0] != edges[:, 1]]
    _, count = np.unique(edges, axis=0, return_counts=True)
    return bool((count == 2).all())
