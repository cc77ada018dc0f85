"""The outline of a sole from a drawing: DXF, SVG or GeoJSON."""

from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Literal
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from plantar.errors import DependencyError, FootError, InputError
from plantar.optional_library import optional_library
from shoes.foot.foot import Foot, foot_from_outline
from shoes.foot.foot_mesh import unit_scale
from shoes.foot.mesh_file import Unit
from shoes.foot.orientation import AXES, Axis, rotation_forward
from shoes.geometry.outline import single_outline

__all__ = ["OUTLINE_FORMATS", "foot_from_drawing", "read_outline"]

OUTLINE_FORMATS: tuple[str, ...] = (".dxf", ".svg", ".geojson", ".json")
"""File endings of drawings that are read."""

_SIZE_MAX = 50_000_000  # bytes
_DXF_UNITS: dict[int, tuple[Unit, float]] = {1: ("in", 1.0), 4: ("mm", 1.0), 5: ("cm", 1.0), 6: ("m", 1.0)}
_SVG_UNITS: dict[str, tuple[Unit, float]] = {"mm": ("mm", 1.0), "cm": ("cm", 1.0), "in": ("in", 1.0)}
_LOOP_MAX = 0.01  # of the enclosed area: a loop where a line's ends overlap, and no more
_TURN_MAX, _LONG = 10.0, 1.3  # degrees off an axis at which a sole is pointed out that is so much longer than wide
_FINE = 0.002  # of the drawing's size: how far a curve's chord may lie from it

Lines = list[NDArray[np.float64]]


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
        unit: Unit of the file; None takes what the file states, or detects it from the size.
        forward: Axis of the drawing to the toes, its y axis upwards on the sheet; None takes the longer one.

    Returns:
        The left foot; its origin is the drawing's where that lies within the sole, otherwise the sole's middle.

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
    import shapely

    outline = shapely.transform(outline, lambda points: points @ turn.T)
    low_x, low_y, high_x, high_y = outline.bounds
    if not (low_x <= 0.0 <= high_x and low_y <= 0.0 <= high_y):
        x, y = round(0.5 * (low_x + high_x), 3), round(0.5 * (low_y + high_y), 3)
        outline = shapely.affinity.translate(outline, -x, -y)
        notes.append("the drawing's origin lies outside the sole: the layout's origin is the middle of the sole")
    return foot_from_outline(Path(path).stem, outline, tuple(notes))


def read_outline(path: str | os.PathLike[str]) -> tuple[Lines, Unit | None, float]:
    """Lines of a drawing.

    Args:
        path: DXF, SVG or GeoJSON file.

    Returns:
        Lines of points (k, 2), y upwards; the unit that the file states, or None; and how many of that unit (or of the
        file's own, where it states none) a number of the file is.

    Raises:
        FootError: If the file cannot be read.
    """
    file = Path(path)
    kind = file.suffix.lower()
    try:
        data = file.read_bytes() if file.stat().st_size <= _SIZE_MAX else None
    except OSError as error:
        raise FootError(f"{file}: cannot be read ({error.strerror}); give a drawing (DXF, SVG, GeoJSON)") from None
    if data is None:
        raise FootError(f"{file}: larger than {_SIZE_MAX // 1_000_000} MB; reduce the drawing")
    if not data.strip():
        raise FootError(f"{file}: the file is empty; give a drawing (DXF, SVG, GeoJSON)")
    readers = {".dxf": _read_dxf, ".svg": _read_svg, ".geojson": _read_geojson, ".json": _read_geojson}
    if kind not in readers:
        raise FootError(f"{file}: '{kind}' is no drawing that is read; allowed: {', '.join(OUTLINE_FORMATS)}")
    try:
        lines, unit, factor = readers[kind](data)
    except (FootError, DependencyError):
        raise
    except Exception as error:  # the readers raise of every kind on a damaged file
        reason = " ".join(str(error).split())[:80] or type(error).__name__
        raise FootError(f"{file}: not a readable {kind[1:].upper()} drawing ({reason})") from None
    lines = [line for line in lines if len(line) > 1]
    if not lines:
        raise FootError(f"{file}: holds no lines; draw the outline of the sole as a closed line")
    if not all(np.isfinite(line).all() for line in lines):
        raise FootError(f"{file}: holds a coordinate that is not finite")
    return lines, unit, factor


def _closed_area(lines: Lines, where: str) -> Any:
    """The one outline that lines enclose."""
    import shapely

    extent = float(np.ptp(np.concatenate(lines), axis=0).max())
    if extent <= 0.0:
        raise FootError(f"{where}: the drawing has no size")
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


def _refuse_crossing(line: NDArray[np.float64], grid: float, where: str) -> None:
    """Refuse a line that crosses itself and encloses two areas or more, as an eight does: no sole is meant by it."""
    import shapely

    drawn = shapely.LineString(line)
    if drawn.is_simple:
        return
    faces = shapely.polygonize([shapely.union_all(shapely.set_precision([drawn], grid))])
    areas = sorted(f.area for f in faces.geoms)
    if len(areas) > 1 and areas[-2] > _LOOP_MAX * sum(areas):
        raise FootError(f"{where}: the outline crosses itself; draw the outline of the sole as one closed line")


def _what_was_drawn(outline: Any, lines: Lines) -> list[str]:
    """Notes on lines that are left out, and on a sole that lies askew on the sheet."""
    import shapely

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


def _read_dxf(data: bytes) -> tuple[Lines, Unit | None, float]:
    """Lines of a DXF's model space."""
    import io

    with optional_library("ezdxf", "shoes"):
        from ezdxf import path as paths
        from ezdxf import recover
        from ezdxf.lldxf.const import DXFError
    document, _ = recover.read(io.BytesIO(data))
    unit, factor = _DXF_UNITS.get(int(document.header.get("$INSUNITS", 0)), (None, 1.0))
    found = []
    for entity in document.modelspace():
        try:
            found.append(paths.make_path(entity))
        except (TypeError, DXFError):
            continue  # texts, dimensions, hatches: no line
    points = [[(v.x, v.y) for v in p.control_vertices()] for p in found if len(p)]
    flat = np.array([v for line in points for v in line])
    fine = _FINE * float(np.ptp(flat, axis=0).max()) if len(flat) else 1.0
    lines = [np.array([(v.x, v.y) for v in p.flattening(fine)]) for p in found if len(p)]
    return lines, unit, factor


def _read_geojson(data: bytes) -> tuple[Lines, Unit | None, float]:
    """Rings of the polygons, and closed lines, of a GeoJSON object."""
    source = json.loads(data.decode("utf-8-sig"))

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


def _read_svg(data: bytes) -> tuple[Lines, Unit | None, float]:
    """Lines of an SVG's shapes, with the transforms of their groups."""
    with optional_library("fontTools", "shoes"):
        from fontTools.pens.recordingPen import DecomposingRecordingPen
        from fontTools.svgLib.path import parse_path
        from fontTools.svgLib.path.shapes import PathBuilder

    root = ElementTree.fromstring(data)
    unit, factor, start = _svg_unit(root)
    lines: Lines = []

    def walk(element: ElementTree.Element, outer: NDArray[np.float64]) -> None:
        tag = str(element.tag).rpartition("}")[2]
        if tag in ("defs", "symbol", "clipPath", "mask", "marker", "pattern"):
            return
        here = outer @ _svg_transform(element.get("transform"))
        plain = ElementTree.Element(
            element.tag, {k: _plain_length(k, v) for k, v in element.attrib.items() if k != "transform"}
        )
        builder = PathBuilder()
        if tag in ("path", "rect", "circle", "ellipse", "polygon", "polyline", "line"):
            builder.add_path_from_element(plain)
        for text in builder.paths:
            pen = DecomposingRecordingPen({})
            parse_path(text, pen)
            lines.extend(_flattened(pen.value, here))
        for child in element:
            walk(child, here)

    walk(root, start)
    return lines, unit, factor


def _plain_length(name: str, value: str) -> str:
    """A length without the px behind it."""
    return re.sub(r"px$", "", value.strip()) if name not in ("d", "points", "id", "class", "style") else value


def _svg_unit(root: ElementTree.Element) -> tuple[Unit | None, float, NDArray[np.float64]]:
    """Unit of an SVG's numbers as its size states it, how many of it one is, and the turn that points y upwards."""
    upright = np.diag([1.0, -1.0, 1.0])
    box = [float(v) for v in re.split(r"[\s,]+", root.get("viewBox", "").strip()) if v]
    match = re.fullmatch(r"\s*([0-9.eE+-]+)\s*([a-z]*)\s*", root.get("width", ""))
    if match is None:
        return None, 1.0, upright
    size, name = float(match[1]), match[2]
    if name in _SVG_UNITS:
        unit, factor = _SVG_UNITS[name]
        return unit, factor * (size / box[2] if len(box) == 4 and box[2] > 0.0 else _per_px(name)), upright
    return None, 1.0, upright


def _per_px(name: str) -> float:
    """How many of a unit a px is: 96 px are an inch."""
    return {"mm": 25.4, "cm": 2.54, "in": 1.0}[name] / 96.0


def _svg_transform(text: str | None) -> NDArray[np.float64]:
    """Matrix (3, 3) of a transform attribute."""
    out = np.eye(3)
    for name, arguments in re.findall(r"(\w+)\s*\(([^)]*)\)", text or ""):
        v = [float(a) for a in re.split(r"[\s,]+", arguments.strip()) if a]
        step = np.eye(3)
        if name == "matrix":
            step[:2] = np.array(v).reshape(3, 2).T
        elif name == "translate":
            step[:2, 2] = [v[0], v[1] if len(v) > 1 else 0.0]
        elif name == "scale":
            step[0, 0], step[1, 1] = v[0], v[1] if len(v) > 1 else v[0]
        elif name == "rotate":
            c, s = math.cos(math.radians(v[0])), math.sin(math.radians(v[0]))
            about = np.array(v[1:3] if len(v) > 2 else [0.0, 0.0])
            step[:2, :2] = [[c, -s], [s, c]]
            step[:2, 2] = about - step[:2, :2] @ about
        elif name in ("skewX", "skewY"):
            step[(0, 1) if name == "skewX" else (1, 0)] = math.tan(math.radians(v[0]))
        else:
            raise ValueError(f"transform '{name}'")
        out = out @ step
    return out


def _flattened(commands: list[tuple[str, tuple[Any, ...]]], matrix: NDArray[np.float64]) -> Lines:
    """Pen commands as lines of points."""
    share = np.linspace(0.0, 1.0, 25)[1:, None]
    lines: Lines = []
    points: list[Any] = []
    for name, arguments in commands:
        at = [np.array(a, dtype=float) for a in arguments if a is not None]
        if name == "moveTo":
            points = [at[0]]
            lines.append(np.empty((0, 2)))
        elif name == "lineTo":
            points.append(at[0])
        elif name == "curveTo" and len(at) == 3:
            a, (b, c, d) = points[-1], at
            points += list(
                (1 - share) ** 3 * a + 3 * (1 - share) ** 2 * share * b + 3 * (1 - share) * share**2 * c + share**3 * d
            )
        elif name == "qCurveTo" and len(at) == 2:
            a, (b, c) = points[-1], at
            points += list((1 - share) ** 2 * a + 2 * (1 - share) * share * b + share**2 * c)
        elif name == "closePath":
            points.append(points[0])
        if lines:
            flat = np.array(points) @ matrix[:2, :2].T + matrix[:2, 2]
            lines[-1] = flat
    return lines
