"""Printing processes: the gaps that parts need to go together, and the scatter of their seats. Lengths in mm.

Gaps are a side. FDM: advice of printers' makers for a 0.4 mm nozzle. SLS and MJF: services promise 0.3 mm, or 0.3 %;
SLA: 0.1 mm. The scatter, one standard deviation, is a third of that promise, for lack of a published figure. A coupon
of your printer replaces them: parameters `gap_press`, `gap_slide`, `gap_play` and `seat_scatter`.
"""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["PROCESSES", "Process"]


@dataclass(frozen=True)
class Process:
    """A printing process.

    Attributes:
        press: Gap a side of what is pushed in and stays.
        slide: Gap a side of what slides.
        play: Gap a side of what moves freely.
        scatter: Standard deviation of the height of a taxel's seat.
        sag: How far a bridged ceiling may sag.
        foot: How far the first layer spreads (elephant's foot).
        shrinkage: Shrinkage beyond the printer's correction, in %.
        supports: Whether what hangs over needs support.
        finish: Work before parts are fitted.
    """

    name: str
    press: float
    slide: float
    play: float
    scatter: float
    sag: float
    foot: float
    shrinkage: float
    supports: bool
    finish: str


PROCESSES: dict[str, Process] = {
    p.name: p
    for p in (
        Process("FDM", 0.10, 0.25, 0.40, 0.10, 0.40, 0.20, 0.3, True,
                "5 outlines and 100 % infill, as strength and mass assume; 0.2 mm of elephant's foot taken off by the "
                "slicer"),
        Process("SLS", 0.20, 0.40, 0.50, 0.08, 0.0, 0.0, 0.3, False, "powder blown out of pockets and channel"),
        Process("MJF", 0.15, 0.30, 0.40, 0.08, 0.0, 0.0, 0.3, False, "powder blown out of pockets and channel"),
        Process("SLA", 0.05, 0.15, 0.30, 0.05, 0.05, 0.10, 0.2, True, "washed and cured, supports above alone"),
    )
}  # fmt: skip
"""The processes by name."""
