"""A shoe's report in words: its main figures, and the checks that do not hold."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

__all__ = ["failed_checks", "shoe_text"]


def shoe_text(summary: Mapping[str, Any]) -> str:
    """The shoe's figures for people."""
    lines = [f"  {note}" for note in summary["notes"]]
    bound = summary["whole_taxels_bound"]
    size = f"{summary['cell_area_mm2']:g} mm^2{' or less' if summary['smallest_cell_share'] < 1.0 else ''}"
    lines.append(
        f"{summary['taxels']} taxels of {size} cover "
        f"{100 * summary['covered_area_ratio']:.0f} % of the sole, blind rim {summary['blind_rim_mm']:.0f} mm; "
        f"overhang {summary['overhang_mm']:g} mm"
        + ("" if bound is None else f"; at most {bound} whole ones fit there (proven)")
    )
    if "mass_g" in summary:
        size = " x ".join(f"{v:.1f}" for v in summary["size_mm"])
        lines.append(
            f"{size} mm, {summary['volume_cm3']:.1f} cm^3, {summary['mass_g']:.0f} g printed, "
            f"{summary['worn_mass_g']:.0f} g worn, {summary['print_hours']:g} h to print, thinnest wall "
            f"{summary['min_wall_mm']:g} mm, {'watertight' if summary['watertight'] else 'NOT watertight'}; "
            f"{'all checks hold' if summary['holds'] else 'A CHECK DOES NOT HOLD'}"
        )
    return "\n".join([*lines, *(f"  {name}" for name in summary["files"])])


def failed_checks(summary: Mapping[str, Any]) -> list[str]:
    """A line for each check that does not hold: side, name, value and what is allowed."""
    return [
        f"{side}: {check['name']} is {check['value']}, allowed {check['allowed']}"
        for side, shoe in summary.get("sides", {}).items()
        for check in shoe["checks"]
        if not check["holds"]
    ]
