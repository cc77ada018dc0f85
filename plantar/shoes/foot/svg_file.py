"""SVG drawings: the lines of their shapes."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FootError
from plantar.files.input_file import read_input
from plantar.files.xml_file import XML_MOST, parse_xml
from plantar.optional_library import optional_library
from plantar.shoes.foot.mesh_file import Unit

__all__ = ["lines_of_svg"]

Lines = list[NDArray[np.float64]]  # lines of points (k, 2)

MOST_POINTS = 20_000  # points that a drawing may have, those on its curves counted

_LONGEST_PATH, _LONGEST_TRANSFORM = 1_000_000, 10_000  # characters
_MOST_USES = 20  # of each other
_LINK = "{http://www.w3.org/1999/xlink}href"
_SVG_UNITS: dict[str, tuple[Unit, float]] = {
    "mm": ("mm", 1.0),
    "cm": ("cm", 1.0),
    "in": ("in", 1.0),
    "px": ("in", 1.0 / 96.0),  # as SVG has it; a number without a unit has none
}

_PER_PX: dict[Unit, float] = {"mm": 25.4 / 96.0, "cm": 2.54 / 96.0, "in": 1.0 / 96.0}


def lines_of_svg(file: Path) -> tuple[Lines, Unit | None, float]:
    """Lines (k, 2), y upwards, of an SVG's shapes with their transforms; the stated unit or None; and the size of a
    number in it.

    Raises:
        FootError: If it cannot be read, or holds more than MOST_POINTS points.
        ValueError: If a path or a transform is damaged.
    """
    with optional_library("fontTools", "shoes"):
        from fontTools.pens.recordingPen import DecomposingRecordingPen
        from fontTools.svgLib.path import parse_path
        from fontTools.svgLib.path.shapes import PathBuilder

    root = parse_xml(read_input(file, FootError, XML_MOST), FootError, str(file))
    unit, factor, start = _svg_unit(root)
    lines: Lines = []
    count = walked = 0
    named = {e.get("id", ""): e for e in root.iter()}

    def walk(element: ElementTree.Element, outer: NDArray[np.float64], uses: int = 0) -> None:
        nonlocal count, walked
        tag = str(element.tag).rpartition("}")[2]
        walked += 1
        if walked > MOST_POINTS or uses > _MOST_USES:
            raise FootError(f"{file}: has more than {MOST_POINTS} shapes, or a shape that uses itself; reduce it")
        if tag == "use":
            used = named.get(element.get("href", element.get(_LINK, "")).removeprefix("#"))
            place = np.eye(3)
            place[:2, 2] = [float(_plain_length(k, element.get(k, "0"))) for k in ("x", "y")]
            here = outer @ _svg_transform(element.get("transform")) @ place
            if used is not None:
                for drawn in used if str(used.tag).endswith("symbol") else (used,):
                    walk(drawn, here, uses + 1)
            return
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
    """The unit, the size of a number in it, and the turn that points y upwards."""
    upright = np.diag([1.0, -1.0, 1.0])
    box = [float(v) for v in re.split(r"[\s,]+", root.get("viewBox", "").strip()) if v]
    match = re.fullmatch(r"\s*([0-9.eE+-]+)\s*([a-z]*)\s*", root.get("width", ""))
    if match is None:
        return None, 1.0, upright
    size, name = float(match[1]), match[2]
    if name in _SVG_UNITS:
        unit, factor = _SVG_UNITS[name]
        return unit, factor * size / box[2] if len(box) == 4 and box[2] > 0.0 else _PER_PX[unit], upright
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
    lines: list[list[Any]] = []
    for name, arguments in commands:
        at = [np.array(a, dtype=float) for a in arguments if a is not None]
        if name == "moveTo":
            lines.append([at[0]])
        elif not lines:
            continue
        elif name == "lineTo":
            lines[-1].append(at[0])
        elif name == "closePath":
            lines[-1].append(lines[-1][0])
        else:
            lines[-1] += _curve(name, lines[-1][-1], at)
    return [np.array(points) @ matrix[:2, :2].T + matrix[:2, 2] for points in lines]


def _curve(name: str, a: NDArray[np.float64], at: list[NDArray[np.float64]]) -> list[NDArray[np.float64]]:
    share = np.linspace(0.0, 1.0, 25)[1:, None]
    if name == "curveTo" and len(at) == 3:
        b, c, d = at
        return list(
            (1 - share) ** 3 * a + 3 * (1 - share) ** 2 * share * b + 3 * (1 - share) * share**2 * c + share**3 * d
        )
    if name == "qCurveTo" and len(at) == 2:
        b, c = at
        return list((1 - share) ** 2 * a + 2 * (1 - share) * share * b + share**2 * c)
    return []
