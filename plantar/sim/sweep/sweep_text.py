"""The result of a sweep in words."""

from collections.abc import Mapping
from typing import Any

_ODD = 1e-3  # Agreement of the runs with one curve below which it is doubted: once in a thousand searches by chance


def sweep_text(result: Mapping[str, Any], scene: str) -> str:
    """Returns lines of `run_sweep`'s `result`: completed runs and failures, or limits, and files.

    `scene` names a sweep without a grid.
    """
    lines = [_limit_text(found, scene) for found in result.get("limits", ())]
    for point in result.get("points", ()):
        why = ", ".join(f"{criterion.replace('_', ' ')} {count}" for criterion, count in point["reasons"].items())
        found = f"{point['completed']} of {point['runs']} completed{f'; failed by: {why}' if why else ''}"
        lines.append(f"{_name(point, scene)}: {found}")
    return "\n".join([*lines, *(f"  {name}" for name in result["files"])])


def sweep_errors(result: Mapping[str, Any], scene: str) -> list[str]:
    """Returns a line for each error of a `result`; `scene` as of `sweep_text`."""
    return [
        f"{_name(point, scene)}: {point['errors'].count(error)} run(s) could not be: {error}"
        for point in (*result.get("points", ()), *result.get("limits", ()))
        for error in dict.fromkeys(point["errors"])
    ]


def _limit_text(found: Mapping[str, Any], scene: str) -> str:
    low, high = found["range"]
    unit = f" {found['unit']}" if found["unit"] else ""
    counted = f"{found['completed']} of {found['runs']} runs completed"
    if found["limit"] is None:
        return f"{_name(found, scene)}: no limit of {found['setting']} from {low:g} to {high:g}{unit}; {counted}"
    begin, end = found["interval"]
    enough = "" if found["reached"] else "; more seeds are needed to know it as well as was asked for"
    holds = "larger" if found["rising"] else "smaller"
    odd = ""
    if found["agreement"] < _ODD:
        odd = (
            f"; no single limit explains these runs (p = {found['agreement']:.0e}): if the seed chooses what it "
            "depends on, as the side of a push, fix that by --set or --grid"
        )
    return (
        f"{_name(found, scene)}: half of the runs are completed at {found['setting']} {found['limit']:.3g}{unit}, "
        f"95 % interval {begin:.3g} to {end:.3g}{unit}; {holds} values hold; {counted}{enough}{odd}"
    )


def _name(point: Mapping[str, Any], scene: str) -> str:
    return " ".join(f"{k}={v}" for k, v in point["settings"].items()) or scene
