"""Printed materials, typical of data sheets, and printing processes. In mm.

Gaps are a side, by printer makers' advice (FDM, 0.4 mm nozzle) or services' promises (SLS and MJF 0.3 mm, SLA 0.1 mm).
Seat scatter, one standard deviation, is a third of that promise, for lack of a published figure. A coupon of your
printer replaces them: parameters `gap_press`, `gap_slide`, `gap_play` and `seat_scatter`.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Material:
    """Printed material.

    `density` in g/cm^3; `modulus`: young's modulus in MPa; `strength`: tensile, within a layer, in MPa; `across`:
    strength share across layers, 0..1; `strain`: allowed in a clip, 0..1.
    """

    name: str
    process: str
    density: float
    modulus: float
    strength: float
    across: float
    strain: float


# The printed materials by name
MATERIALS: dict[str, Material] = {
    m.name: m
    for m in (
        Material("PA12", "MJF", 1.01, 1700.0, 48.0, 0.85, 0.040),
        Material("PETG", "FDM", 1.27, 2000.0, 45.0, 0.55, 0.025),
        Material("PLA", "FDM", 1.24, 3000.0, 50.0, 0.50, 0.015),
        Material("TPU", "FDM", 1.21, 30.0, 30.0, 0.80, 0.0),
        Material("resin", "SLA", 1.18, 1600.0, 42.0, 0.90, 0.015),
    )
}


@dataclass(frozen=True)
class Process:
    """Printing process; gaps a side in mm.

    `scatter`: seat height's standard deviation; `foot`: spread of the first layer; `shrinkage`: beyond the printer's
    correction, in %; `supports`: whether overhangs need support; `finish`: work before fitting.
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


# The processes by name
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
