"""The main figures of an analysis in words."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

__all__ = ["analysis_text"]


def analysis_text(metrics: Mapping[str, Any], name: str = "") -> str:
    """Returns the main figures of an analysis as lines, from its metrics; with a name for one of two."""
    rate = "" if metrics["rate_hz"] is None else f" at {metrics['rate_hz']:.6g} Hz"
    lines = [f"{name + ': ' if name else ''}{metrics['format']}: {metrics['frames']} frame(s){rate}"]
    for side, foot in metrics["feet"].items():
        if "footprint" in foot:
            print_, arch = foot["footprint"], foot["footprint"]["arch_index"]
            length = "" if print_["length_m"] is None else f"{1e3 * print_['length_m']:.0f} mm long, "
            lines.append(f"  {side} footprint: {length}arch index {'-' if arch is None else f'{arch:.3f}'}")
            continue
        contact = foot["measures"]["contact_time_s"]["mean"]
        lines.append(f"  {side}: {foot['steps']} complete steps" + (f", contact {contact:.3f} s" if contact else ""))
    cadence = metrics["gait"].get("cadence_steps_per_min")
    if cadence is not None:
        lines.append(f"  cadence {cadence:.1f} steps/min")
    return "\n".join(lines)
