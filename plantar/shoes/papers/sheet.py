"""Drawing sheet in mm on paper (ISO 128 lines, ISO 129 dimensions)."""

import math
import os
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.plotting import new_figure, save_figure

_SIZE = (420.0, 297.0)  # A3
_INCH = 25.4
# Width in mm, dashes and colour of each kind of line
_KINDS: dict[str, tuple[float, str, str]] = {
    "OUTLINE": (0.5, "solid", "#111111"),
    "THIN": (0.25, "solid", "#111111"),
    "HATCH": (0.13, "solid", "#6c757d"),
    "HIDDEN": (0.25, "dashed", "#111111"),
    "CENTRE": (0.18, "dashdot", "#111111"),
    "FOOT": (0.35, "dotted", "#111111"),
    "CABLE": (0.35, "solid", "#e4572e"),
}
_ARROW = 2.2  # mm
_HATCH = 2.5  # mm between lines

Array = NDArray[np.float64]
Point = tuple[float, float]


@dataclass
class Sheet:
    """A3 sheet, origin at the lower left.

    `lines`: kind and points (k, 2); `texts`: place, text, height in mm, angle in degrees, alignment.
    """

    lines: list[tuple[str, Array]] = field(default_factory=list)
    areas: list[tuple[str, Array]] = field(default_factory=list)
    texts: list[tuple[Point, str, float, float, str]] = field(default_factory=list)

    def line(self, points: Any, kind: str = "THIN") -> None:
        """Line of a kind through points (k, 2)."""
        self.lines.append((kind, np.asarray(points, dtype=float)))

    def box(self, low: Point, high: Point, kind: str = "THIN") -> None:
        """Rectangle from low to high, in lines of a kind."""
        self.line([low, (high[0], low[1]), high, (low[0], high[1]), low], kind)

    def text(self, at: Point, text: str, height: float = 2.5, *, turn: float = 0.0, align: str = "left") -> None:
        """Write text of a height in mm, turn in degrees; align left, right or center at a place."""
        self.texts.append((at, text, height, turn, align))

    def arrow(self, tip: Point, way: Point) -> None:
        """Filled arrow head, tip along a way."""
        x, y = np.array(way) / math.hypot(*way)
        back = np.array(tip) - _ARROW * np.array([x, y])
        side = _ARROW / 6.0 * np.array([-y, x])
        self.areas.append(("#111111", np.array([tip, back + side, back - side])))

    def dimension(self, start: Point, end: Point, text: str, off: float) -> None:
        """Level or upright dimension from start to end with a text, so far off the start, up or right."""
        level = abs(end[0] - start[0]) >= abs(end[1] - start[1])
        a, b = (
            ((start[0], start[1] + off), (end[0], start[1] + off))
            if level
            else ((start[0] + off, start[1]), (start[0] + off, end[1]))
        )
        for point, foot in ((start, a), (end, b)):
            if math.dist(point, foot) > 0.5:
                over = 1.5 * np.sign(off) * (np.array([0.0, 1.0]) if level else np.array([1.0, 0.0]))
                self.line([point, np.array(foot) + over])
        way = (b[0] - a[0], b[1] - a[1])
        inside = math.hypot(*way) > 3.0 * _ARROW
        self.line(
            [a, b] if inside else [np.array(a) - 2.0 * np.sign(way) * _ARROW, np.array(b) + 2.0 * np.sign(way) * _ARROW]
        )
        sign = 1.0 if inside else -1.0
        self.arrow(a, (-sign * way[0], -sign * way[1]))
        self.arrow(b, (sign * way[0], sign * way[1]))
        middle = (0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]))
        if level:
            self.text((middle[0], middle[1] + 0.8), text, align="center")
        else:
            self.text((middle[0] - 2.2, middle[1]), text, turn=90.0, align="center")

    def datum(self, tip: Point, letter: str, way: Point) -> None:
        """Datum triangle, tip on a line, with boxed letter (ISO 5459) along a way."""
        x, y = np.array(way) / math.hypot(*way)
        across = 1.3 * np.array([-y, x])
        at = np.array(tip)
        self.areas.append(("#111111", np.array([at + across, at - across, at + 2.2 * np.array([x, y])])))
        end = at + 6.0 * np.array([x, y])
        self.line([at + 2.2 * np.array([x, y]), end])
        middle = end + 2.2 * np.array([x, y])
        self.box((middle[0] - 2.2, middle[1] - 2.2), (middle[0] + 2.2, middle[1] + 2.2))
        self.text((float(middle[0]), float(middle[1]) - 1.2), letter, align="center")

    def table(self, at: Point, widths: Iterable[float], rows: Iterable[Iterable[str]], step: float = 4.0) -> None:
        """Table at its upper left corner: column widths, rows, first a head, row step, in mm."""
        columns = list(widths)
        lines = [list(row) for row in rows]
        edges = np.cumsum([at[0], *columns])
        text = 0.55 * step
        for i, row in enumerate(lines):
            low = at[1] - step * (i + 1)
            for x, cell in zip(edges.tolist(), row, strict=False):
                self.text((x + 0.7, low + 0.1 * step), cell, text)
            self.line([(at[0], low), (float(edges[-1]), low)], "OUTLINE" if i == 0 else "HATCH")
        bottom = at[1] - step * len(lines)
        for x in edges.tolist():
            self.line([(x, at[1]), (x, bottom)], "HATCH")
        self.box((at[0], bottom), (float(edges[-1]), at[1]))

    def write(self, *paths: str | os.PathLike[str]) -> list[Path]:
        """Draw the sheet once and save it to each of the paths, by its ending: .pdf, .png or .svg; returns these."""
        figure = self._drawn()
        return [save_figure(figure, path) for path in paths]

    def _drawn(self) -> Any:
        """The sheet as a matplotlib figure of its own size."""
        figure, axes = new_figure(_SIZE[0] / _INCH, _SIZE[1] / _INCH)
        figure.set_layout_engine(None)
        axes.set_position([0.0, 0.0, 1.0, 1.0])
        axes.set(xlim=(0.0, _SIZE[0]), ylim=(0.0, _SIZE[1]))
        axes.set_axis_off()
        points = 72.0 / _INCH
        for colour, corners in self.areas:
            axes.fill(*corners.T, facecolor=colour, lw=0)
        for kind, (width, dashes, colour) in _KINDS.items():
            own = [np.vstack([line, [np.nan, np.nan]]) for k, line in self.lines if k == kind]
            if own:
                axes.plot(*np.vstack(own).T, color=colour, lw=width * points, ls=dashes)
        for at, text, height, turn, align in self.texts:
            style: dict[str, Any] = {"rotation": turn, "ha": align, "va": "bottom" if turn == 0.0 else "center"}
            # Texts of axes are given a path to be cut along, which a sheet's never are.
            figure.text(*at, text, fontsize=1.25 * height * points, transform=axes.transData, **style)
        return figure


@dataclass(frozen=True)
class View:
    """Part view: point `of` in mm lies at `origin` on the sheet, at a scale paper over part."""

    sheet: Sheet
    scale: float
    origin: Point
    of: Point = (0.0, 0.0)

    def at(self, points: Any) -> Array:
        """Part points (..., 2) on the sheet."""
        return np.asarray(self.origin + self.scale * (np.asarray(points, dtype=float) - self.of))

    def place(self, x: float, y: float) -> Point:
        """Gives part point x, y on the sheet."""
        u, v = self.at((x, y)).tolist()
        return u, v

    def draw(self, shape: Any, kind: str = "THIN") -> None:
        """Border of a shapely shape, in a line kind."""
        for part in shapely.get_parts(shape):
            rings = [part.exterior, *part.interiors] if part.geom_type == "Polygon" else [part]
            for line in rings:
                if not line.is_empty:
                    self.sheet.line(self.at(np.asarray(line.coords)[:, :2]), kind)

    def hatch(self, shape: Any) -> None:
        """Cut area: border, and lines at 45 degrees."""
        self.draw(shape, "OUTLINE")
        if shape.is_empty:
            return
        low_x, low_y, high_x, high_y = shape.bounds
        tall = high_y - low_y
        step = math.sqrt(2.0) * _HATCH / self.scale
        starts = np.arange(low_x - tall, high_x, step)
        lines = shapely.linestrings([[(x, low_y), (x + tall, high_y)] for x in starts.tolist()])
        for line in shapely.get_parts(shapely.intersection(lines, shape)):
            if line.geom_type == "LineString" and line.length > 0.0:
                self.sheet.line(self.at(line.coords), "HATCH")
