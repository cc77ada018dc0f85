"""Figure of footprints in an image: their contours, axes, thirds and toe lines on the picture."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.formats.footprint_image import FootprintImage, Print
from plantar.gait.analysis.prints.footprint import Footprint
from plantar.plotting import COLOURS, draw_raster, new_figure
from plantar.sides import Side

__all__ = ["draw_footprints"]


@dataclass(frozen=True)
class _Scale:
    """Scale of lengths in the figure: mm where the image's is known, else pixels."""

    name: str
    of_pixel: float
    of_length: float


def draw_footprints(image: FootprintImage, prints: Mapping[Side, Footprint]) -> Any:
    """Returns a figure of the prints of an image, in its order, drawn on it."""
    scale = _Scale("pixels", 1.0, 1.0) if image.pixel is None else _Scale("mm", 1e3 * image.pixel, 1e3)
    height, width = image.picture.shape[:2]
    figure, axes = new_figure(min(9.0, 1.5 + 6.0 * width / height) if width < 1.6 * height else 9.0, 6.4)
    draw_raster(axes, image.picture, scale.of_pixel)
    for part, (side, print_) in zip(image.prints, prints.items(), strict=True):
        _draw_contours(axes, part, side, height, scale)
        _draw_lines(axes, print_, scale)
        axes.plot([], [], color=COLOURS[side], label=f"{side} foot: contour")
    axes.plot([], [], color=COLOURS["cop"], label="foot axis")
    axes.plot([], [], ":", color="#111111", label="thirds without toes")
    if any(p.toe_line is not None for p in prints.values()):
        axes.plot([], [], "--", color=COLOURS["polygon"], label="toe line")
    axes.set_xlabel(f"to the right ({scale.name})")
    axes.set_ylabel(f"up ({scale.name})")
    figure.legend(loc="outside right upper", fontsize=8)
    return figure


def _draw_contours(axes: Any, part: Print, side: Side, height: int, scale: _Scale) -> None:
    for contour in part.contours:
        ring = np.vstack([contour, contour[:1]]) + 0.5
        axes.plot(
            ring[:, 0] * scale.of_pixel, (height - ring[:, 1]) * scale.of_pixel, color=COLOURS[side], linewidth=1.4
        )


def _draw_lines(axes: Any, print_: Footprint, scale: _Scale) -> None:
    """Draw the thirds without toes, the axis and the toe line of a footprint."""

    def place(points: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.asarray(print_.from_foot(points)[:, ::-1] * (-scale.of_length, scale.of_length)).T

    low, high = float(print_.rings[:, :, 1].min()), float(print_.rings[:, :, 1].max())
    for k in range(4):
        u = k * print_.toeless_length / 3.0
        axes.plot(*place(np.array([[u, low], [u, high]])), color="#111111", linewidth=0.8, linestyle=":")
    axes.plot(*place(np.array([[0.0, 0.0], [print_.length, 0.0]])), color=COLOURS["cop"], linewidth=1.4)
    if print_.toe_line is not None:
        v = np.linspace(low, high, 20)
        line = np.column_stack([np.interp(v, *print_.toe_line.T), v])
        axes.plot(*place(line), color=COLOURS["polygon"], linewidth=1.4, linestyle="--")
