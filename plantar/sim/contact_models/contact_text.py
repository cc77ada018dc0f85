"""The comparison of contact models in words."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

__all__ = ["contact_text"]


def contact_text(result: Mapping[str, Any]) -> str:
    """The comparison's main figures for people.

    Args:
        result: What `measure_contact` gave.

    Returns:
        Lines.
    """
    lines = [f"{'contact model':24}{'CoP max mm':>12}{'edge mm':>10}{'step us':>10}{'read us':>10}"]
    for row in result["models"]:
        x, y = row["edge_x_mm"], row["edge_y_mm"]
        edge = "-" if None in (x, y) else f"{round(x if abs(x) >= abs(y) else y, 2) + 0.0:.2f}"
        cop = "-" if row["cop_max_mm"] is None else f"{row['cop_max_mm']:.2f}"
        lines.append(f"{row['name']:24}{cop:>12}{edge:>10}{row['step_us']:>10.1f}{row['read_us']:>10.1f}")
    lines.append(f"chosen: {result['chosen']}, {'holds' if result['holds'] else 'DOES NOT HOLD'} what is required")
    return "\n".join(lines)
