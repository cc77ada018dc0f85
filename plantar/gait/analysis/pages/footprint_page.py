"""The page of a footprint image."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from plantar.gait.analysis.pages.heading import facts_of_image
from plantar.gait.analysis.prints.regions import REGIONS
from plantar.pages.page import Section, figures_of, number, page, row, scaled, table, titled, warning_list

__all__ = ["footprint_page"]

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
    """The page of a footprint image as text.

    Args:
        metrics: Result of `analyse_image`.
        figures: PNG files to embed, with their captions.
        title: Title of the page, for example the file's name.

    Returns:
        HTML that refers to no other file and no network.
    """
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
