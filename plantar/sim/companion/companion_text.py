"""A run of the companion in words."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

__all__ = ["companion_text"]

_COMMON = {
    *("scene", "robot", "seed", "completed", "reasons", "fell", "sim_time_s", "wall_time_s", "real_time_factor"),
    *("control_us", "skipped", "figures"),
}


def companion_text(summary: Mapping[str, Any]) -> str:
    """A run's figures for people.

    Args:
        summary: What `run_companion` gave.

    Returns:
        Lines.
    """
    end = "completed" if summary["completed"] else ("FELL" if summary["fell"] else "NOT COMPLETED")
    tick = summary["control_us"]
    head = f"{summary['scene']} with {summary['robot']}, seed {summary['seed']}: {end}, {summary['sim_time_s']:.1f} s"
    return "\n".join(
        [
            head,
            *(f"  not completed, {r['criterion'].replace('_', ' ')}: {r['text']}" for r in summary["reasons"]),
            *(f"  {name}: {_told(value)}" for name, value in summary.items() if name not in _COMMON),
            f"  {summary['real_time_factor']:.1f} x real time; control tick {tick['p50']:.0f} us (median), "
            f"{tick['p99']:.0f} us (99 %)",
            *(f"  {name}" for name in summary.get("figures", [])),
        ]
    )


def _told(value: Any) -> str:
    if isinstance(value, Mapping):
        return ", ".join(f"{name} {_told(inner)}" for name, inner in value.items())
    if isinstance(value, list):
        return " ".join(_told(inner) for inner in value)
    return f"{value:g}" if isinstance(value, float) else str(value)
