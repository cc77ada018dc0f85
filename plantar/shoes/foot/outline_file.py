"""The outline of a sole from a drawing: DXF, SVG or GeoJSON."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Literal

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.errors import DependencyError, FootError, InputError
from plantar.files.gate import read_apart
from plantar.files.input_file import check_input
from plantar.files.structured_text import read_json
from plantar.shoes.foot.foot import Foot, foot_from_outline
from plantar.shoes.foot.foot_mesh import unit_scale
from plantar.shoes.foot.mesh_file import Unit
from plantar.shoes.foot.orientation import AXES, Axis, rotation_forward
from plantar.shoes.foot.svg_file import MOST_POINTS, Lines, lines_of_svg
from plantar.shoes.geometry.outline import single_outline

__all__ = ["foot_from_drawing", "read_outline"]

OUTLINE_FORMATS: tuple[str, ...] = (".dxf", ".svg", ".geojson", ".json")  # file endings of drawings that are read

_LARGEST, _LARGEST_DXF = 10e6, 4e6  # bytes
_FARTHEST = 1e9  # in the drawing's unit
_MEETINGS = 50  # segments that one meets, on average
_BLOCK = 200  # segments
_DXF_UNITS: dict[int, tuple[Unit, float]] = {1: ("in", 1.0), 4: ("mm", 1.0), 5: ("cm", 1.0), 6: ("m", 1.0)}
_LOOP_MAX = 0.01  # of the enclosed area: a loop where a line's ends overlap, and no more
_TURN_MAX, _LONG = 10.0, 1.3  # degrees off an axis at which a sole is pointed out that is so much longer than wide


def foot_from_drawing(
    path: str | os.PathLike[str],
    *,
    mesh_side: Literal["left", "right"] = "left",
    unit: Unit | None = None,
    forward: Axis | None = None,
) -> Foot:
    """A foot with straight sides from a drawing of its sole, seen from above.

    Args:
        path: DXF, SVG or GeoJSON file with one or more closed lines.
        mesh_side: Which foot it shows; a right foot is mirrored.
        unit: Unit of the file; None takes the stated one, or detects it.
        forward: Axis of the drawing to the toes; None takes the longer one.

    Returns:
        The left foot; its origin is the drawing's if inside the sole, otherwise the sole's middle.

    Raises:
        FootError: If the file cannot be read, or holds no closed line of a foot's size.
    """
    if forward is not None and forward not in AXES[:4]:
        raise InputError(f"forward axis is {forward!r}; allowed: {', '.join(AXES[:4])}")
    lines, file_unit, factor = read_outline(path)
    outline = _closed_area(lines, str(path))
    notes = _what_was_drawn(outline, lines)
    box = outline.bounds
    extent = max(box[2] - box[0], box[3] - box[1]) * factor
    scale, note = unit_scale(extent, unit, file_unit, str(path))
    notes = [note, *notes]
    axis: Axis = forward or ("y" if box[3] - box[1] > 1.05 * (box[2] - box[0]) else "x")
    if axis != "x":
        given = "as given" if forward else "its longer side"
        notes.append(f"the drawing's {axis} axis points to the toes, {given}")
    turn = rotation_forward(axis)[:2, :2] * scale * factor
    if mesh_side == "right":
        turn = np.diag([1.0, -1.0]) @ turn
        notes.append("the drawing is of a right foot; mirrored to the left")
    outline = shapely.transform(outline, lambda points: points @ turn.T)
    low_x, low_y, high_x, high_y = outline.bounds
    if not (low_x <= 0.0 <= high_x and low_y <= 0.0 <= high_y):
        x, y = round(0.5 * (low_x + high_x), 3), round(0.5 * (low_y + high_y), 3)
        outline = shapely.affinity.translate(outline, -x, -y)
        notes.append("the drawing's origin lies outside the sole: the layout's origin is the middle of the sole")
    return foot_from_outline(Path(path).stem, outline, tuple(notes))


def read_outline(path: str | os.PathLike[str]) -> tuple[Lines, Unit | None, float]:
    """Read the lines of a DXF, SVG or GeoJSON file: points (k, 2), y upwards; the stated unit or None; and the size of
    a number in it.

    Raises:
        FootError: If the file cannot be read.
    """
    file = Path(path)
    kind = file.suffix.lower()
    readers = {".dxf": _read_dxf, ".svg": lines_of_svg, ".geojson": _read_geojson, ".json": _read_geojson}
    if kind not in readers:
        raise FootError(f"{file}: '{kind}' is no drawing that is read; allowed: {', '.join(OUTLINE_FORMATS)}")
    if not check_input(file, FootError, _LARGEST):
        raise FootError(f"{file}: the file is empty; give a drawing (DXF, SVG, GeoJSON)")
    try:
        lines, unit, factor = readers[kind](file)
    except (FootError, DependencyError):
        raise
    except Exception as error:  # the readers raise of every kind on a damaged file
        reason = " ".join(str(error).split())[:80] or type(error).__name__
        raise FootError(f"{file}: not a readable {kind[1:].upper()} drawing ({reason})") from None
    lines = [line for line in lines if len(line) > 1]
    if not lines:
        raise FootError(f"{file}: holds no lines; draw the outline of the sole as a closed line")
    points = np.concatenate(lines)
    if len(points) > MOST_POINTS:
        raise FootError(f"{file}: has {len(points)} points; allowed: up to {MOST_POINTS}; reduce the drawing")
    if not (np.abs(points) <= _FARTHEST).all():
        raise FootError(f"{file}: holds a coordinate that is not finite, or beyond {_FARTHEST:g}")
    return lines, unit, factor


def _closed_area(lines: Lines, where: str) -> Any:
    extent = float(np.ptp(np.concatenate(lines), axis=0).max())
    if extent <= 0.0:
        raise FootError(f"{where}: the drawing has no size")
    _refuse_tangle(lines, where)
    grid = 1e-4 * extent  # ends of lines that meet are drawn on the same point, about
    for line in lines:
        _refuse_crossing(line, grid, where)
    united = shapely.union_all(shapely.set_precision([shapely.LineString(line) for line in lines], grid))
    faces = shapely.polygonize([united])
    area = shapely.union_all([shapely.Polygon(f.exterior) for f in faces.geoms])
    if area.is_empty or area.area < 1e-3 * extent**2:
        raise FootError(f"{where}: no closed line; draw the outline of the sole as one")
    # `single_outline` thinks in mm: bring a foot of any unit to about its size.
    to_mm = 250.0 / extent
    large = shapely.affinity.scale(area, to_mm, to_mm, origin=(0.0, 0.0))
    one = single_outline(large, large.convex_hull) if large.geom_type != "Polygon" else shapely.Polygon(large.exterior)
    return shapely.affinity.scale(one, 1.0 / to_mm, 1.0 / to_mm, origin=(0.0, 0.0))


def _refuse_tangle(lines: Lines, where: str) -> None:
    """Their crossings would grow with the square of their number."""
    ends = np.concatenate([np.stack([line[:-1], line[1:]], axis=1) for line in lines])
    drawn = shapely.linestrings(ends)
    tree = shapely.STRtree(drawn)
    met = 0
    for start in range(0, len(drawn), _BLOCK):
        met += tree.query(drawn[start : start + _BLOCK], predicate="intersects").shape[1]
        if met > _MEETINGS * len(drawn) + 10_000:
            raise FootError(
                f"{where}: its lines cross each other in too many places; draw the outline of the sole alone"
            )


def _refuse_crossing(line: NDArray[np.float64], grid: float, where: str) -> None:
    drawn = shapely.LineString(line)
    if drawn.is_simple:
        return
    faces = shapely.polygonize([shapely.union_all(shapely.set_precision([drawn], grid))])
    areas = sorted(f.area for f in faces.geoms)
    if len(areas) > 1 and areas[-2] > _LOOP_MAX * sum(areas):
        raise FootError(f"{where}: the outline crosses itself; draw the outline of the sole as one closed line")


def _what_was_drawn(outline: Any, lines: Lines) -> list[str]:
    notes = []
    extent = max(np.ptp(np.array(outline.exterior.coords), axis=0))
    within = outline.buffer(-1e-3 * extent)
    inner = sum(bool(within.contains(shapely.LineString(line))) for line in lines)
    if inner:
        notes.append(f"{inner} line(s) within the outline left out: a sole has no holes")
    corners = np.array(outline.minimum_rotated_rectangle.exterior.coords)[:3]
    short, long = sorted(np.diff(corners, axis=0), key=lambda side: float(np.hypot(*side)))
    turn = math.degrees(math.atan2(long[1], long[0])) % 90.0
    off = min(turn, 90.0 - turn)
    if off > _TURN_MAX and np.hypot(*long) > _LONG * np.hypot(*short):
        notes.append(
            f"the sole lies {off:.0f} degrees askew on the sheet and stays so: turn the drawing if it should not"
        )
    return notes


def _read_dxf(file: Path) -> tuple[Lines, Unit | None, float]:
    if find_spec("ezdxf") is None:
        raise DependencyError("ezdxf", "shoes")
    check_input(file, FootError, _LARGEST_DXF)
    held = read_apart("dxf", file, FootError)
    lines = np.split(held["points"], np.cumsum(held["counts"])[:-1])
    return list(lines), *_DXF_UNITS.get(int(held["unit"]), (None, 1.0))


def _read_geojson(file: Path) -> tuple[Lines, Unit | None, float]:
    source = read_json(file, FootError, f"{file}:", "a readable GeoJSON drawing")

    def rings(item: Any, depth: int = 0) -> Iterator[Any]:
        if not isinstance(item, dict) or depth > 20:
            raise ValueError("not a GeoJSON object")
        kind = item.get("type")
        if kind == "FeatureCollection":
            for feature in item["features"]:
                yield from rings(feature, depth + 1)
        elif kind == "Feature":
            yield from rings(item["geometry"], depth + 1)
        elif kind == "GeometryCollection":
            for geometry in item["geometries"]:
                yield from rings(geometry, depth + 1)
        elif kind == "Polygon":
            yield from ([*ring, ring[0]] for ring in item["coordinates"])  # a ring that was left open too
        elif kind == "MultiPolygon":
            yield from ([*ring, ring[0]] for polygon in item["coordinates"] for ring in polygon)
        elif kind == "LineString":
            yield item["coordinates"]
        elif kind == "MultiLineString":
            yield from item["coordinates"]
        elif kind not in ("Point", "MultiPoint"):
            raise ValueError(f"type is {kind!r}")

    return [np.array([p[:2] for p in r], dtype=float) for r in rings(source)], None, 1.0
