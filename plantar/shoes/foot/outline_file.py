"""Outline of a sole from a drawing: DXF, SVG or GeoJSON."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterator
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.common.files.gate import read_apart
from plantar.common.files.input_file import check_input, read_input
from plantar.common.files.structured_text import read_json
from plantar.common.files.xml_file import XML_MOST, parse_xml
from plantar.common.optional_library import optional_library
from plantar.common.sides import Side
from plantar.errors import DependencyError, FootError, InputError
from plantar.layouts.source_pose import SourcePose
from plantar.shoes.foot.foot import Foot, foot_from_outline
from plantar.shoes.foot.foot_mesh import unit_scale
from plantar.shoes.foot.mesh_file import Unit
from plantar.shoes.foot.orientation import AXES, Axis, rotation_forward
from plantar.shoes.geometry.outline import single_outline
from plantar.shoes.units import to_m

OUTLINE_FORMATS: tuple[str, ...] = (".dxf", ".svg", ".geojson", ".json")  # file endings of drawings that are read

# bytes
_LARGEST = 10e6
_LARGEST_DXF = 4e6
_FARTHEST = 1e9  # in the drawing's unit
_MEETINGS = 50  # segments that one meets, on average
_BLOCK = 200  # segments
_DXF_UNITS: dict[int, tuple[Unit, float]] = {1: ("in", 1), 2: ("in", 12), 4: ("mm", 1), 5: ("cm", 1), 6: ("m", 1)}
_SECOND = 0.25  # of the largest outline: what lies apart and is smaller is a part of the foot
_LOOP_MAX = 0.01  # of the enclosed area: a loop where a line's ends overlap, and no more
# degrees off an axis at which a sole is pointed out that is so much longer than wide
_TURN_MAX = 10.0
_LONG = 1.3


def foot_from_drawing(
    path: str | os.PathLike[str],
    *,
    mesh_side: Side = "left",
    unit: Unit | None = None,
    forward: Axis | None = None,
) -> Foot:
    """Straight-sided foot from a drawing of its sole from above.

    `path`: DXF, SVG or GeoJSON with closed lines; `unit` of the file; None takes the stated one, or detects it;
    `forward`: axis to the toes; None takes the longer one. Returns left foot; origin is the drawing's if inside the
    sole, else its middle.
    """
    if forward is not None and forward not in AXES[:4]:
        raise InputError(f"forward axis is {forward!r}; allowed: {', '.join(AXES[:4])}")
    lines, file_unit, factor = read_outline(path)
    outline = _closed_area(lines, str(path), forward is not None)
    notes = _what_was_drawn(outline, lines)
    box = outline.bounds
    scale, note = unit_scale(max(box[2] - box[0], box[3] - box[1]) * factor, unit, file_unit, str(path))
    notes = [note, *notes]
    axis: Axis = forward or ("y" if box[3] - box[1] > 1.05 * (box[2] - box[0]) else "x")
    notes.append(f"the drawing's {axis} axis points to the toes, {'as given' if forward else 'its longer side'}")
    rotation = rotation_forward(axis)
    turn = rotation[:2, :2] * scale * factor
    if mesh_side == "right":
        turn = np.diag([1.0, -1.0]) @ turn
        notes.append("the drawing is of a right foot; mirrored to the left")
    outline = shapely.transform(outline, lambda points: points @ turn.T)
    low_x, low_y, high_x, high_y = outline.bounds
    x = 0.0
    y = 0.0
    if not (low_x <= 0.0 <= high_x and low_y <= 0.0 <= high_y):
        x = round(0.5 * (low_x + high_x), 3)
        y = round(0.5 * (low_y + high_y), 3)
        outline = shapely.affinity.translate(outline, -x, -y)
        notes.append("the drawing's origin lies outside the sole: the layout's origin is the middle of the sole")
    origin = np.array([x, -y if mesh_side == "right" else y, 0.0])
    pose = SourcePose(Path(path).name, None, to_m(rotation.T @ origin), rotation.T)
    return replace(foot_from_outline(Path(path).stem, outline, tuple(notes)), poses={mesh_side: pose})


def read_outline(path: str | os.PathLike[str]) -> tuple[Lines, Unit | None, float]:
    """Read lines of a DXF, SVG or GeoJSON file: points (k, 2), y upwards; stated unit or None; size of
    a number in it.
    """
    file = Path(path)
    kind = file.suffix.lower()
    readers = {".dxf": _read_dxf, ".svg": _lines_of_svg, ".geojson": _read_geojson, ".json": _read_geojson}
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


def _closed_area(lines: Lines, where: str, in_parts: bool) -> Any:
    extent = float(np.ptp(np.concatenate(lines), axis=0).max())
    if extent <= 0.0:
        raise FootError(f"{where}: the drawing has no size")
    _refuse_tangle(lines, where)
    grid = 1e-4 * extent  # ends of lines that meet are drawn on the same point, about
    for line in lines:
        _refuse_crossing(line, grid, where)
    united = shapely.union_all(shapely.set_precision([shapely.LineString(line) for line in lines], grid))
    area = shapely.union_all([shapely.Polygon(f.exterior) for f in shapely.polygonize([united]).geoms])
    if area.is_empty or area.area < 1e-3 * extent**2:
        raise FootError(f"{where}: no closed line; draw the outline of the sole as one")
    parts = sorted(part.area for part in shapely.get_parts(area))
    if not in_parts and len(parts) > 1 and parts[-2] > _SECOND * parts[-1]:
        raise FootError(f"{where}: outlines apart from each other, two feet maybe; draw one, or give the forward axis")
    # `single_outline` thinks in mm: bring a foot of any unit to about its size.
    to_mm = 250.0 / extent
    large = shapely.affinity.scale(area, to_mm, to_mm, origin=(0.0, 0.0))
    one = single_outline(large, large.convex_hull) if large.geom_type != "Polygon" else shapely.Polygon(large.exterior)
    return shapely.affinity.scale(one, 1.0 / to_mm, 1.0 / to_mm, origin=(0.0, 0.0))


def _refuse_tangle(lines: Lines, where: str) -> None:
    """Their crossings would grow with the square of their number."""
    drawn = shapely.linestrings(np.concatenate([np.stack([line[:-1], line[1:]], axis=1) for line in lines]))
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
    areas = sorted(f.area for f in shapely.polygonize([shapely.union_all(shapely.set_precision([drawn], grid))]).geoms)
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
        if kind in ("FeatureCollection", "Feature", "GeometryCollection"):
            within = [*item.get("features", ()), *item.get("geometries", ())]
            for part in within if kind != "Feature" else [item["geometry"]]:
                yield from rings(part, depth + 1)
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


Lines = list[NDArray[np.float64]]  # lines of points (k, 2)

MOST_POINTS = 20_000  # points that a drawing may have, those on its curves counted

# characters
_LONGEST_PATH = 1_000_000
_LONGEST_TRANSFORM = 10_000
_MOST_USES = 20  # of each other
_LINK = "{http://www.w3.org/1999/xlink}href"
_SVG_UNITS: dict[str, tuple[Unit, float]] = {
    "mm": ("mm", 1.0),
    "cm": ("cm", 1.0),
    "in": ("in", 1.0),
    "pt": ("in", 1.0 / 72.0),
    "pc": ("in", 1.0 / 6.0),
    "px": ("in", 1.0 / 96.0),  # as SVG has it; a number without a unit has none
}


def _lines_of_svg(file: Path) -> tuple[Lines, Unit | None, float]:
    """Lines (k, 2), y upwards; stated unit or None; size of a number in it."""
    with optional_library("fontTools", "shoes"):
        from fontTools.pens.recordingPen import DecomposingRecordingPen
        from fontTools.svgLib.path import parse_path
        from fontTools.svgLib.path.shapes import PathBuilder

    root = parse_xml(read_input(file, FootError, XML_MOST), FootError, str(file))
    unit, factor, start = _svg_unit(root)
    lines: Lines = []
    count = 0
    walked = 0
    named = {e.get("id", ""): e for e in root.iter()}

    def walk(element: ElementTree.Element, outer: NDArray[np.float64], uses: int = 0) -> None:
        nonlocal count, walked
        tag = str(element.tag).rpartition("}")[2]
        walked += 1
        if walked > MOST_POINTS or uses > _MOST_USES:
            raise FootError(f"{file}: has more than {MOST_POINTS} shapes, or a shape that uses itself; reduce it")
        look = f"display:{element.get('display', '')};{element.get('style', '')}"
        if tag in ("defs", "symbol", "clipPath", "mask", "marker", "pattern") or re.search(r"display\s*:\s*none", look):
            return
        if tag == "use":
            used = named.get(element.get("href", element.get(_LINK, "")).removeprefix("#"))
            place = np.eye(3)
            place[:2, 2] = [float(_plain_length(k, element.get(k, "0"))) for k in ("x", "y")]
            here = outer @ _svg_transform(element.get("transform")) @ place
            if used is not None:
                for drawn in used if str(used.tag).endswith("symbol") else (used,):
                    walk(drawn, here, uses + 1)
            return
        here = outer @ _svg_transform(element.get("transform"))
        plain = ElementTree.Element(
            element.tag, {k: _plain_length(k, v) for k, v in element.attrib.items() if k != "transform"}
        )
        builder = PathBuilder()
        if tag in ("path", "rect", "circle", "ellipse", "polygon", "polyline", "line"):
            builder.add_path_from_element(plain)
        for text in builder.paths:
            if len(text) > _LONGEST_PATH:
                raise FootError(f"{file}: a path of more than {_LONGEST_PATH} characters; reduce the drawing")
            pen = DecomposingRecordingPen({})
            parse_path(text, pen)
            found = _flattened(pen.value, here)
            lines.extend(found)
            count += sum(map(len, found))
            if count > MOST_POINTS:
                raise FootError(f"{file}: has more than {MOST_POINTS} points; reduce the drawing")
        for child in element:
            walk(child, here, uses)

    with np.errstate(all="ignore"):  # what is not finite is refused later
        walk(root, start)
    return lines, unit, factor


def _plain_length(name: str, value: str) -> str:
    return re.sub(r"px$", "", value.strip()) if name not in ("d", "points", "id", "class", "style") else value


def _svg_unit(root: ElementTree.Element) -> tuple[Unit | None, float, NDArray[np.float64]]:
    """Unit, size of a number in it, and the turn to y upwards."""
    upright = np.diag([1.0, -1.0, 1.0])
    box = [float(v) for v in re.split(r"[\s,]+", root.get("viewBox", "").strip()) if v]
    match = re.fullmatch(r"\s*([0-9.eE+-]+)\s*([a-z]*)\s*", root.get("width", ""))
    if match is None:
        return None, 1.0, upright
    size = float(match[1])
    name = match[2]
    if name in _SVG_UNITS:
        unit, factor = _SVG_UNITS[name] if len(box) == 4 and box[2] > 0.0 else _SVG_UNITS["px"]
        return unit, factor * size / box[2] if len(box) == 4 and box[2] > 0.0 else factor, upright
    return None, 1.0, upright


def _svg_transform(text: str | None) -> NDArray[np.float64]:
    out = np.eye(3)
    if len(text or "") > _LONGEST_TRANSFORM:
        raise ValueError("a transform too long")
    for name, arguments in re.findall(r"(\w+)\s*\(([^)]*)\)", text or ""):
        v = [float(a) for a in re.split(r"[\s,]+", arguments.strip()) if a]
        step = np.eye(3)
        if name == "matrix":
            step[:2] = np.array(v).reshape(3, 2).T
        elif name == "translate":
            step[:2, 2] = [v[0], v[1] if len(v) > 1 else 0.0]
        elif name == "scale":
            step[0, 0] = v[0]
            step[1, 1] = v[1] if len(v) > 1 else v[0]
        elif name == "rotate":
            c = math.cos(math.radians(v[0]))
            s = math.sin(math.radians(v[0]))
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
    """Lines of a pen's commands, with 24 points on each Bezier curve."""
    lines: list[list[Any]] = []
    for name, arguments in commands:
        at = [np.array(a, dtype=float) for a in arguments if a is not None]
        if name == "moveTo":
            lines.append([at[0]])
        elif lines and name == "closePath":
            lines[-1].append(lines[-1][0])
        elif lines and at:
            n = len(at)
            share = np.linspace(0.0, 1.0, 25 if len(at) > 1 else 2)[1:, None]
            corners = enumerate([lines[-1][-1], *at])
            lines[-1] += list(sum(math.comb(n, k) * (1 - share) ** (n - k) * share**k * p for k, p in corners))
    return [np.array(points) @ matrix[:2, :2].T + matrix[:2, 2] for points in lines]
