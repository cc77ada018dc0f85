"""What a sweep found in words."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

__all__ = ["sweep_errors", "sweep_text"]


def sweep_text(result: Mapping[str, Any], scene: str) -> str:
    """How many runs of each grid point were completed, why the others were not, and the files.

    Args:
        result: What `run_sweep` gave.
        scene: Name of the scene, for a sweep without a grid.

    Returns:
        Lines.
    """
    lines = []
    for point in result["points"]:
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
        for point in result["points"]
        for error in dict.fromkeys(point["errors"])
    ]


def _name(point: Mapping[str, Any], scene: str) -> str:
    return " ".join(f"{k}={v}" for k, v in point["settings"].items()) or scene
