"""What a sweep found in words."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

__all__ = ["sweep_errors", "sweep_text"]

_ODD = 1e-3
"""Agreement of the runs with one curve below which it is doubted: once in a thousand searches by chance."""


def sweep_text(result: Mapping[str, Any], scene: str) -> str:
    """How many runs of each grid point were completed and why the others were not, or its limit; and the files.

    Args:
        result: What `run_sweep` gave.
        scene: Name of the scene, for a sweep without a grid.

    Returns:
        Lines.
    """
    lines = [_limit_text(told, scene) for told in result.get("limits", ())]
    for point in result.get("points", ()):
        why = ", ".join(f"{criterion.replace('_', ' ')} {count}" for criterion, count in point["reasons"].items())
        told = f"{point['completed']} of {point['runs']} completed{f'; failed by: {why}' if why else ''}"
        lines.append(f"{_name(point, scene)}: {told}")
    return "\n".join([*lines, *(f"  {name}" for name in result["files"])])


def sweep_errors(result: Mapping[str, Any], scene: str) -> list[str]:
    """The runs that could not be, a line for each grid point and error.

    Args:
        result: What `run_sweep` gave.
        scene: Name of the scene, for a sweep without a grid.

    Returns:
        Lines; empty where every run came to an end.
    """
    return [
        f"{_name(point, scene)}: {point['errors'].count(error)} run(s) could not be: {error}"
        for point in (*result.get("points", ()), *result.get("limits", ()))
        for error in dict.fromkeys(point["errors"])
    ]


def _limit_text(told: Mapping[str, Any], scene: str) -> str:
    low, high = told["range"]
    unit = f" {told['unit']}" if told["unit"] else ""
    counted = f"{told['completed']} of {told['runs']} runs completed"
    if told["limit"] is None:
        return f"{_name(told, scene)}: no limit of {told['setting']} from {low:g} to {high:g}{unit}; {counted}"
    begin, end = told["interval"]
    enough = "" if told["reached"] else "; more seeds are needed to know it as well as was asked for"
    holds = "larger" if told["rising"] else "smaller"
    odd = ""
    if told["agreement"] < _ODD:
        odd = (
            f"; no one limit tells these runs (p = {told['agreement']:.0e}): if the seed chooses what it depends on, "
            "as the side of a push, fix that by --set or --grid"
        )
    return (
        f"{_name(told, scene)}: half of the runs are completed at {told['setting']} {told['limit']:.3g}{unit}, "
        f"95 % interval {begin:.3g} to {end:.3g}{unit}; {holds} values hold; {counted}{enough}{odd}"
    )


def _name(point: Mapping[str, Any], scene: str) -> str:
    return " ".join(f"{k}={v}" for k, v in point["settings"].items()) or scene
