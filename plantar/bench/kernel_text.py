"""The kernels' comparison in words."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

__all__ = ["kernel_text"]


def kernel_text(result: Mapping[str, Any]) -> str:
    """The kernels' medians and errors, and what of the wanted is met, for people.

    Args:
        result: What `measure_kernels` gave.

    Returns:
        Lines.
    """
    kernel, lines = "", []
    for row in result["results"]:
        if row["kernel"] != kernel:
            kernel = row["kernel"]
            lines.append(f"{kernel:58}{'median us':>12}{'spread':>8}{'ratio':>9}{'error':>10}")
        error = "-" if row["error"] is None else f"{row['error']:.1e}"
        route = f"  {row['size']}: {row['route']}"
        lines.append(f"{route:58}{row['median_us']:>12.2f}{row['spread']:>8.0%}{row['ratio']:>9.1f}{error:>10}")
    lines.append("wanted and reached, at the worst size:")
    for target in result["targets"]:
        sign = ">=" if target["at_least"] else "<="
        line = f"{target['what']}: {target['figure']:.3g} {target['unit']}".rstrip()
        wanted = f"wanted {sign} {target['wanted']:g}; {target['where']}"
        lines.append(f"  {'met    ' if target['met'] else 'NOT MET'} {line} ({wanted})")
    return "\n".join(lines)
