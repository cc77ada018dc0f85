"""Whether a robot moved its partner far enough."""

from __future__ import annotations

from typing import Any

__all__ = ["LED", "partner_reasons"]

LED = 0.5
"""Share of its planned way that a robot which leads has to have moved its partner by: the rest is lost to the gap
before they touch and to a partner that swings back towards where it rests."""


def partner_reasons(role: str, way: float, moved: float) -> list[dict[str, Any]]:
    """Returns the failed criteria, as `verdict.reasons`, of a planned `way` in m towards a partner that `moved` so far.

    With a `role` "leader" only a completed walk is asked.
    """
    needed = LED * way
    if role == "leader" or -moved >= needed:
        return []
    text = f"the partner was led {-moved:.3f} m; a walk of {way:.3f} m towards it needs {needed:.3f} m"
    return [{"criterion": "led", "value": round(-moved, 4), "limit": round(needed, 4), "text": text}]
