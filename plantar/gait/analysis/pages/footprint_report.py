"""Footprint image: analysis, figure and page."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.pages.page import Section, figures_of, number, page, row, scaled, table, titled, warning_list
from plantar.common.sides import SIDES, Side
from plantar.common.table_writer import csv_text
from plantar.formats.footprint_image import FootprintImage, Print, read_footprints
from plantar.gait.analysis.pages.figure_files import write_figures
from plantar.gait.analysis.pages.report import facts_of_image
from plantar.gait.analysis.pages.sole_figures import draw_lines
from plantar.gait.analysis.prints.footprint import Footprint, footprint_of_pixels
from plantar.gait.analysis.prints.platform_walk import side_by_shape
from plantar.gait.analysis.prints.regions import REGIONS, regions_of, with_toe_line
from plantar.gait.analysis.subject import Subject
from plantar.plotting import COLOURS, draw_raster, new_figure

_LENGTHS = (0.08, 0.40)  # Lengths in m of footprints, from a child who begins to walk to the largest feet
_MOST_PIXELS = 40_000  # Pixels a footprint is measured with; finer masks are thinned


def analyse_image(
    path: Path,
    folder: Path,
    mm_per_pixel: float | None,
    side: Side | None = None,
    subject: Subject | None = None,
    figures: bool = True,
) -> dict[str, Any]:
    """Measure footprints in an image; write metrics.json, footprints.csv, a figure and report.html.

    `mm_per_pixel`: as of `analyse_recording`, like `subject` and `figures`; `side` of a single footprint; inferred from
    shape where None. Returns contents of metrics.json. FormatError for no image or no footprint.
    """
    image = read_footprints(path, mm_per_pixel)
    pixel = image.pixel if image.pixel is not None else 1.0
    sides, assumed = _sides(image, pixel, side)
    prints = {s: footprint_in_image(p, pixel, s) for s, p in zip(sides, image.prints, strict=True)}
    doubts = [
        f"the {s} footprint is {print_.length:.3g} m long, feet are {_LENGTHS[0]:g} to {_LENGTHS[1]:g} m: check the "
        "image's resolution (--mm-per-pixel)"
        for s, print_ in prints.items()
        if image.pixel is not None and not _LENGTHS[0] <= print_.length <= _LENGTHS[1]
    ] + [
        f"no gap parts the {s} foot's toes from its forefoot: its arch index is that of the whole print"
        for s, print_ in prints.items()
        if print_.toe_line is None
    ]
    feet = {s: measures_of_footprint(p, image.pixel is not None) for s, p in prints.items()}
    metrics: dict[str, Any] = {
        "format": "image",
        "kind": "image",
        "subject": asdict(subject or Subject()),
        "frames": 1,
        "rate_hz": None,
        "size_px": [image.picture.shape[1], image.picture.shape[0]],
        "mm_per_pixel": None if image.pixel is None else 1e3 * image.pixel,
        "feet": {s: {"steps": 0, "events": [], "footprint": values} for s, values in feet.items()},
        "gait": {},
        "warnings": [*image.warnings, *assumed, *doubts],
    }
    (folder / "footprints.csv").write_text(_csv(feet), encoding="utf-8")
    (folder / "metrics.json").write_text(json.dumps(metrics, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    if figures:
        caption = "Footprints with their contours, axes, thirds and toe lines"
        embedded = write_figures([("footprint", draw_footprints(image, prints), caption)], folder)
        (folder / "report.html").write_text(
            footprint_page(metrics, embedded, path.name), encoding="utf-8", errors="replace"
        )
    return metrics


def footprint_in_image(part: Print, pixel: float, side: Side) -> Footprint:
    """Returns footprint with toe line of an image part's mask, for a pixel's size in m and a side.

    The narrower end of its longest axis is the heel.
    """
    rows, columns = np.nonzero(part.mask)
    every = max(1, round(float(np.sqrt(len(rows) / _MOST_PIXELS))))
    keep = (rows % every == 0) & (columns % every == 0)
    centres = _centres(part, pixel)[keep]
    return with_toe_line(footprint_of_pixels(centres, pixel * every, side, _forward(centres)))


def _forward(centres: NDArray[np.float64]) -> NDArray[np.float64]:
    values, vectors = np.linalg.eigh(np.cov((centres - centres.mean(axis=0)).T))
    axis = vectors[:, int(np.argmax(values))]
    if axis[0] < 0.0:
        axis = -axis
    along = centres @ axis
    across = centres @ np.array([-axis[1], axis[0]])
    low = float(along.min())
    high = float(along.max())
    third = (high - low) / 3.0

    def width(first: float, last: float) -> float:
        inside = (along >= first) & (along <= last)
        return float(np.ptp(np.percentile(across[inside], [2.0, 98.0]))) if inside.sum() > 2 else 0.0

    return np.asarray(axis if width(high - third, high) >= width(low, low + third) else -axis)


def _sides(image: FootprintImage, pixel: float, stated: Side | None) -> tuple[list[Side], list[str]]:
    if len(image.prints) == 2:
        tops = [_forward(_centres(p, pixel)) for p in image.prints]
        up = tops[0][0] + tops[1][0] >= 0.0
        note = "the picture is taken as seen from above: the foot to the left, toes up, is the left one"
        return list(SIDES if up else reversed(SIDES)), [note]
    if stated is not None:
        return [stated], []
    side = side_by_shape(footprint_in_image(image.prints[0], pixel, "right"))
    note = f"the image does not state which foot it is: taken as the {side} one from its arch (--side overrides)"
    return [side], [note]


def _centres(part: Print, pixel: float) -> NDArray[np.float64]:
    rows, columns = np.nonzero(part.mask)
    return np.column_stack([part.mask.shape[0] - rows - 0.5, -columns - 0.5]) * pixel


def measures_of_footprint(print_: Footprint, scaled: bool) -> dict[str, Any]:
    """Returns measures of footprint `print_` by key, lengths and areas None unless scaled (in m).

    axis_angle_deg is to the image's vertical, left positive.
    """

    def size(value: float) -> float | None:
        return value if scaled else None

    length = print_.toeless_length
    region = regions_of(print_)
    areas = {name: float(print_.areas[region == i].sum()) for i, name in enumerate(REGIONS) if (region == i).any()}
    heel, fore = (_widest(print_, a * length, b * length) for a, b in ((0.0, 1.0 / 3.0), (2.0 / 3.0, 1.0)))
    arch = print_.arch_index()
    return {
        "length_m": size(print_.length),
        "width_m": size(print_.width),
        "area_m2": size(float(print_.areas.sum())),
        "toeless_length_m": size(length),
        "toeless_area_m2": size(float(print_.areas[~print_.is_toe].sum())),
        "heel_width_m": size(heel),
        "forefoot_width_m": size(fore),
        "arch_index": arch if np.isfinite(arch) else None,
        "axis_angle_deg": float(np.degrees(np.arctan2(print_.axis[1], print_.axis[0]))),
        "toes_told_apart": print_.toe_line is not None,
        "region_areas_m2": {name: size(value) for name, value in areas.items()},
        "region_area_percent": {name: 100.0 * value / sum(areas.values()) for name, value in areas.items()},
    }


def _widest(print_: Footprint, low: float, high: float) -> float:
    centre = print_.centres
    inside = (centre[:, 0] >= low) & (centre[:, 0] <= high) & ~print_.is_toe
    return float(np.ptp(print_.rings[inside][:, :, 1])) if inside.any() else 0.0


def _csv(feet: dict[Side, dict[str, Any]]) -> str:
    names = [k for k in next(iter(feet.values())) if not isinstance(next(iter(feet.values()))[k], dict)]
    return csv_text(["side", *names], ([side, *(values[n] for n in names)] for side, values in feet.items()))


@dataclass(frozen=True)
class _Scale:
    name: str
    of_pixel: float
    of_length: float


def draw_footprints(image: FootprintImage, prints: Mapping[Side, Footprint]) -> Any:
    """Returns figure of an image's prints in order, drawn on it."""
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
    axes.set(xlabel=f"to the right ({scale.name})", ylabel=f"up ({scale.name})")
    figure.legend(loc="outside right upper", fontsize=8)
    return figure


def _draw_contours(axes: Any, part: Print, side: Side, height: int, scale: _Scale) -> None:
    for contour in part.contours:
        ring = np.vstack([contour, contour[:1]]) + 0.5
        axes.plot(
            ring[:, 0] * scale.of_pixel, (height - ring[:, 1]) * scale.of_pixel, color=COLOURS[side], linewidth=1.4
        )


def _draw_lines(axes: Any, print_: Footprint, scale: _Scale) -> None:
    draw_lines(axes, print_, scale.of_length, color=COLOURS["cop"])
    if print_.toe_line is not None:
        v = np.linspace(float(print_.rings[:, :, 1].min()), float(print_.rings[:, :, 1].max()), 20)
        x, y = scale.of_length * print_.from_foot(np.column_stack([np.interp(v, *print_.toe_line.T), v])).T
        axes.plot(-y, x, color=COLOURS["polygon"], linewidth=1.4, linestyle="--")


_FOOTPRINT = (
    ("length_m", "Length", "mm", 1e3),
    ("width_m", "Width", "mm", 1e3),
    ("toeless_length_m", "Length without toes", "mm", 1e3),
    ("heel_width_m", "Width of the heel", "mm", 1e3),
    ("forefoot_width_m", "Width of the forefoot", "mm", 1e3),
    ("area_m2", "Area", "cm²", 1e4),
    ("toeless_area_m2", "Area without toes", "cm²", 1e4),
    ("arch_index", "Arch index", "", 1.0),
    ("axis_angle_deg", "Angle of the axis to the vertical, to the left", "°", 1.0),
)


def footprint_page(metrics: Mapping[str, Any], figures: Sequence[tuple[Path, str]], title: str) -> str:
    """Returns footprint page as HTML without other files, by metrics, PNG figures with captions and title."""
    sections = [Section("measures", "Measures", _table(metrics))]
    if metrics["warnings"]:
        sections.append(Section("assumed", "What was assumed", warning_list(metrics["warnings"])))
    sections.append(figures_of(figures))
    return page(f"Footprint: {title}", facts_of_image(metrics, title), sections)


def _table(metrics: Mapping[str, Any]) -> str:
    feet = {side: foot["footprint"] for side, foot in metrics["feet"].items()}
    values = {
        titled(name, unit): [scaled(foot[key], factor) for foot in feet.values()]
        for key, name, unit, factor in _FOOTPRINT
    }
    values |= {
        f"{name} (% of area)": [foot["region_area_percent"].get(region) for foot in feet.values()]
        for region, name in REGIONS.items()
    }
    rows = [row(name, map(number, own)) for name, own in values.items() if any(v is not None for v in own)]
    head = ["Measure", *(f"{side} foot" for side in feet)]
    return table("Measures of the footprints", "Measures of the footprints.", head, rows)
