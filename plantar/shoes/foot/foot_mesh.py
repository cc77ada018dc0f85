"""Foot from its surface: unit, upright direction, sole and floor contact."""

import math
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.optional_library import missing_libraries
from plantar.common.sides import Side
from plantar.errors import FootError, InputError
from plantar.layouts.source_pose import SourcePose
from plantar.shoes.foot.foot import FOOT_LENGTHS, Foot
from plantar.shoes.foot.mesh_file import Unit, read_mesh
from plantar.shoes.foot.orientation import (
    AXES,
    Axis,
    check_level,
    check_one_body,
    check_upright,
    flat_share,
    forward_axis,
    levelled,
    rotation_forward,
    rotation_up,
    straightened,
)
from plantar.shoes.foot.scan_floor import floor_of_scan
from plantar.shoes.geometry.outline import cut_below, outline_of, outlines_below, touching
from plantar.shoes.geometry.surface import convex_outline, is_closed
from plantar.shoes.units import to_m

UNIT_SIZE: dict[str, float] = {"m": 1000.0, "cm": 10.0, "mm": 1.0, "in": 25.4}  # length of each unit in mm

_SOLE_SHARE = 0.4  # of the silhouette: a body whose lowest band is smaller is round below
_WIDER = (10.0, 15.0, 20.0)  # mm: bands in which a rounded sole may cover that share
_HEIGHT_MIN = 0.5  # mm
_PLATE = 5.0  # mm: a body that is thinner along one axis is a plate
_TOUCHING = 1.0  # mm: what lies lower touches the floor

Triangles = NDArray[np.float64]


@dataclass(frozen=True)
class Link:
    """Link of a robot's model that a foot's triangles belong to.

    `file`: name of the model's file; `rotation` (3, 3) from the triangles' axes to the link's frame, of one origin.
    """

    file: str
    body: str
    rotation: Triangles


@missing_libraries("shoes")
def foot_from_mesh(
    path: str | os.PathLike[str],
    *,
    mesh_side: Side = "left",
    unit: Unit | None = None,
    up: Axis | None = None,
    sole_z: float | None = None,
    forward: Axis | None = None,
    sole_band: float = 5.0,
) -> Foot:
    """Read a foot's mesh, watertight or not; find its sole.

    Args:
        path: STL, OBJ, PLY, OFF, 3MF or STEP file.
        mesh_side: Shown foot; a right one is mirrored.
        unit: Of the file; None detects it by size.
        up: Upward axis; None takes z, or the one with a sole.
        sole_z: Sole plane in mm; None takes the lowest point.
        forward: Axis to the toes, z up; None finds it.
        sole_band: Sole height in mm from the lowest point.

    Returns:
        Left foot; `notes` show what was detected.

    Raises:
        FootError: If no mesh, or no foot.
    """
    triangles, file_unit = read_mesh(path)
    return foot_from_triangles(
        Path(path).stem,
        triangles,
        where=str(path),
        mesh_side=mesh_side,
        unit=unit,
        file_unit=file_unit,
        up=up,
        sole_z=sole_z,
        forward=forward,
        sole_band=sole_band,
    )


def foot_from_triangles(
    name: str,
    triangles: Triangles,
    *,
    where: str,
    mesh_side: Side = "left",
    unit: Unit | None = None,
    file_unit: Unit | None = None,
    up: Axis | None = None,
    sole_z: float | None = None,
    forward: Axis | None = None,
    sole_band: float = 5.0,
    links: Triangles | None = None,
    link: Link | None = None,
) -> Foot:
    """Foot from triangles; options as in `foot_from_mesh`.

    `triangles` (n, 3, 3), ankle at the origin; `up`: upward axis; `sole_z`: sole plane in mm; `sole_band`: sole height
    in mm; `links`: points (n, 3) of other robot links, likewise; `link`: the robot link that the triangles
    are of, whose frame shows where the toes are and is never turned but by quarters.
    """
    if forward is not None and forward not in AXES[:4]:
        raise InputError(f"forward axis is {forward!r}; allowed: {', '.join(AXES[:4])}")
    if up is not None and up not in AXES:
        raise InputError(f"axis that points up is {up!r}; allowed: {', '.join(AXES)}")
    if sole_z is not None and not math.isfinite(sole_z):
        raise InputError(f"sole plane is at {sole_z} mm; allowed: a finite height")
    scale, note = unit_scale(float(np.ptp(triangles.reshape(-1, 3), axis=0).max()), unit, file_unit, where)
    read = triangles
    triangles = triangles * scale
    notes = [note, *([] if is_closed(triangles) else ["the mesh is not closed; only its outline is used"])]
    settings: dict[str, Any] = {
        "where": where, "mesh_side": mesh_side, "sole_z": sole_z, "forward": forward, "sole_band": sole_band,
        "read": read, "scale": scale, "links": links, "link": link,
    }  # fmt: skip
    if up is None:
        size = np.ptp(triangles.reshape(-1, 3), axis=0)
        if size.min() < _PLATE:
            thin = AXES[2 * int(size.argmin())]
            notes.append(
                f"a plate of {size.min():.3g} mm: nothing shows which face is up, its {thin} axis is taken to point up"
            )
            return _standing(name, triangles @ rotation_up(thin).T, notes=notes, up_given=True, **settings)
    else:
        notes += [f"the mesh's {up} axis points up, as given"] if up != "z" else []
        return _standing(name, triangles @ rotation_up(up).T, notes=notes, up_given=True, **settings)
    above = None if links is None else links.mean(axis=0) - read.mean(axis=(0, 1))
    if above is not None and above[2] < -0.7 * np.linalg.norm(above):
        notes.append("the robot's links are below its foot, seen along z: the mesh's -z axis is taken to point up")
        return _standing(name, triangles @ rotation_up("-z").T, notes=notes, up_given=True, **settings)
    try:
        return _standing(name, triangles, notes=notes, **settings)
    except FootError as error:
        if sole_z is not None or "no flat sole" not in str(error):
            raise
        others = [a for a in AXES if a != "z" and flat_share(triangles @ rotation_up(a).T) >= _SOLE_SHARE]
        if above is not None:  # the links above the foot show where up is
            others = [a for a in others if rotation_up(a)[2] @ above > 0.7 * np.linalg.norm(above)]
        if len(others) != 1:  # none, or the foot could be any of them
            raise
        notes.append(f"no sole below, seen along z: the mesh's {others[0]} axis is taken to point up")
        return _standing(name, triangles @ rotation_up(others[0]).T, notes=notes, **settings)


def _standing(
    name: str,
    triangles: Triangles,
    *,
    where: str,
    mesh_side: Side,
    sole_z: float | None,
    forward: Axis | None,
    sole_band: float,
    notes: list[str],
    read: Triangles,
    scale: float,
    links: Triangles | None,
    link: Link | None,
    up_given: bool = False,
) -> Foot:
    """Foot from triangles in mm, z up, that were `read` in a unit of `scale` mm; links move with them."""
    notes = list(notes)
    tilt = 0.0
    if sole_z is None:
        triangles, tilt = levelled(triangles)
        if tilt > 0.0:
            notes.append(f"levelled: the plane that the foot rests on was tilted by {tilt:.1f} degrees")
    if sole_z is None and link is None:
        floor = floor_of_scan(triangles)
        if floor.any():
            triangles = triangles[~floor]
            read = read[~floor]
            notes.append("a floor around the foot is left out: a single sheet, level with the sole")
    _check_height(triangles, where)
    upright = triangles
    triangles, facing = _facing(triangles, where, forward, sole_band, link is not None)
    notes += facing
    rotation = _rotation_between(read, triangles)
    flip_y = np.array([1.0, -1.0 if mesh_side == "right" else 1.0, 1.0])
    if mesh_side == "right":
        triangles = triangles[:, ::-1] * flip_y
        notes.append("the mesh is a right foot; mirrored to the left")
    lowest = float(triangles[..., 2].min())
    plane = lowest if sole_z is None else sole_z
    if sole_z is None:
        notes.append(f"sole plane at the mesh's lowest point, z = {plane:.1f} mm")
    else:
        notes.append(f"sole plane at z = {plane:.1f} mm as given")
        if plane - lowest > 1e-6:
            notes.append(f"{plane - lowest:.1f} mm of the mesh lie below the sole plane and are ignored")
    origin = np.array([0.0, 0.0, plane])  # of the sole frame, in axes that are turned already
    triangles = triangles - origin
    flip = np.array([1.0, 1.0, -1.0])
    triangles = cut_below(triangles * flip, 0.0) * flip
    if not len(triangles):
        raise FootError(f"{where}: no part of the mesh lies above the sole plane z = {plane:g} mm")
    sole = _checked_sole(triangles, sole_band, forward, where)
    box = sole.bounds
    if not _box_holds(box, 0.5):
        middle = np.array([0.5 * (box[0] + box[2]), 0.5 * (box[1] + box[3]), 0.0]).round(3)
        triangles = triangles - middle
        origin = origin + middle
        sole = _checked_sole(triangles, sole_band, forward, where)
        notes.append("the mesh's origin lies far from the sole: the layout's origin is the middle of the sole instead")
    notes.append(f"sole {box[2] - box[0]:.1f} x {box[3] - box[1]:.1f} mm (lowest {sole_band:g} mm of the mesh)")
    lifted = triangles + np.array([0.0, 0.0, 0.0 if sole_z is None else -float(triangles[..., 2].min())])
    if not up_given and sole_z is None:
        notes += [*check_upright(upright, where), *check_level(upright, where, tilt)]
    support = touching(lifted, _TOUCHING).intersection(sole)
    if links is not None:
        links = links * scale @ rotation.T * flip_y - origin
    position = to_m(rotation.T @ (origin * flip_y))
    file = Path(where).name
    if link is None:
        pose = SourcePose(file, None, position, rotation.T)
    else:
        pose = SourcePose(link.file, link.body, link.rotation @ position, link.rotation @ rotation.T)
    return Foot(
        name,
        sole,
        outlines_below(triangles),
        float(triangles[..., 2].max()),
        tuple(notes),
        lifted,
        support if support.area > 1.0 else None,
        links=links,
        poses={mesh_side: pose},
    )


def _facing(
    triangles: Triangles, where: str, forward: Axis | None, sole_band: float, of_link: bool
) -> tuple[Triangles, list[str]]:
    """Triangles with the toes along x, and notes."""
    notes: list[str] = []
    if forward is not None:
        notes += [] if forward == "x" else [f"the mesh's {forward} axis points to the toes, as given"]
        return triangles @ rotation_forward(forward).T, notes
    check_one_body(triangles, where)
    if not of_link:
        triangles, notes = straightened(triangles, where, sole_band=sole_band)
    try:
        axis, how = forward_axis(triangles, where)
    except FootError:
        # That there is no sole below comes first: on a foot that lies on its side no axis shows the toes.
        _checked_sole(triangles - np.array([0.0, 0.0, triangles[..., 2].min()]), sole_band, forward, where)
        raise
    return triangles @ rotation_forward(axis).T, [*notes, how]


def _rotation_between(start: Triangles, end: Triangles) -> Triangles:
    """Rotation (3, 3) that turns triangles into others of the same shape, whatever their scale and place (Kabsch)."""
    a, b = (t.reshape(-1, 3) - t.reshape(-1, 3).mean(axis=0) for t in (start, end))
    u, _, v = np.linalg.svd(b.T @ a)
    return np.asarray(u @ np.diag([1.0, 1.0, np.linalg.det(u @ v)]) @ v)


def _check_height(triangles: Triangles, where: str) -> None:
    high = float(np.ptp(triangles[..., 2]))
    if high < _HEIGHT_MIN:
        raise FootError(
            f"{where}: the mesh is {high:.3g} mm high ({len(triangles)} triangles); allowed: a foot's body of "
            f"{_HEIGHT_MIN:g} mm or more, or an outline (.dxf, .svg, .geojson)"
        )


_ALONE = ", without a leg or a floor that reaches farther"


def unit_scale(extent: float, unit: Unit | None, file_unit: Unit | None, where: str) -> tuple[float, str]:
    """Gives scale to mm and a note for a foot of an extent: user's unit, the file_unit stated in the file, or detected;
    where is the file's name.
    """
    low, high = FOOT_LENGTHS
    fitting = [u for u, scale in UNIT_SIZE.items() if low <= extent * scale <= high]
    mends = " or ".join(f"--unit {u}, {extent * UNIT_SIZE[u]:.4g} mm long" for u in fitting)
    allowed = f"allowed: a foot of {low:g} to {high:g} mm" + (f" ({mends})" if mends else "") + _ALONE
    for given, source in ((unit, "as given"), (file_unit, "as the file states")):
        if given is None:
            continue
        size = extent * UNIT_SIZE[given]
        if given not in fitting:
            raise FootError(f"{where}: the foot is {size:.6g} mm long (unit {given} {source}); {allowed}")
        return UNIT_SIZE[given], f"unit {given} {source}"
    for guess in ("m", "mm"):
        if guess in fitting:
            return UNIT_SIZE[guess], f"unit {guess}, detected from the size ({extent:.4g} {guess} long)"
    raise FootError(f"{where}: the foot is {extent:.4g} long, which fits neither m nor mm; {allowed}")


def _checked_sole(triangles: Triangles, sole_band: float, forward: Axis | None, path: str) -> Any:
    points = triangles.reshape(-1, 3)
    length, width, height = (float(v) for v in np.ptp(points, axis=0))
    _check_height(triangles, path)
    try:
        sole = outline_of(cut_below(triangles, sole_band), sole_band)
    except FootError as error:
        raise FootError(f"{path}: {error}") from None
    block = max(length, width) < 1.15 * min(length, width) and height > 0.5 * length
    silhouette = convex_outline(points[:, :2]).area
    if sole.area < _SOLE_SHARE * silhouette:
        way = "the axis that points up (--up), or "
        bands = (b for b in _WIDER if b > sole_band and not block)
        if all(flat_share(triangles @ rotation_up(a).T) < _SOLE_SHARE for a in AXES if a != "z"):
            wide = [b for b in bands if outline_of(cut_below(triangles, b), b).area >= _SOLE_SHARE * silhouette]
            way = f"--set sole_band={wide[0]:g} for a rounded sole, or " if wide else ""
        raise FootError(
            f"{path}: no flat sole: the lowest {sole_band:g} mm cover {100 * sole.area / silhouette:.0f} % of the "
            f"silhouette; allowed: {100 * _SOLE_SHARE:.0f} % or more (or give {way}the sole plane's height, --sole-z)"
        )
    if forward is None and width > 1.05 * length:
        raise FootError(
            f"{path}: the foot is {length:.0f} mm along x and {width:.0f} mm along y; x must point forward "
            f"(or give the forward axis: {', '.join(AXES[:4])})"
        )
    if block:
        raise FootError(
            f"{path}: {length:.0f} x {width:.0f} x {height:.0f} mm is a block, not a foot; allowed: longer than wide, "
            "or flatter than half its length"
        )
    box = sole.bounds
    if box[2] - box[0] < FOOT_LENGTHS[0] * 0.5 or box[3] - box[1] < 15.0:
        raise FootError(
            f"{path}: the sole is {box[2] - box[0]:.0f} x {box[3] - box[1]:.0f} mm; "
            f"allowed: {FOOT_LENGTHS[0] / 2:g} x 15 mm or more"
        )
    return sole


def _box_holds(box: tuple[float, float, float, float], slack: float) -> bool:
    dx = slack * (box[2] - box[0])
    dy = slack * (box[3] - box[1])
    return box[0] - dx <= 0.0 <= box[2] + dx and box[1] - dy <= 0.0 <= box[3] + dy
