"""How many taxels touch the ground when their seats scatter, and the pad that is soft enough for it. Lengths in mm.

Print and ground are rigid. Each taxel with the pad below it is a spring, its seat's height scattered by the process's
standard deviation. The print sinks and tilts under half the robot's weight in the middle of the cells until forces and
moments balance.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from plantar.gravity import GRAVITY
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.load_share import taxel_stiffness
from plantar.shoes.plan.shoe_plan import ShoePlan
from plantar.shoes.plan.strength import LoadCase

__all__ = ["ACTIVE_LEAST", "AREA_OFF", "COP_OFF", "Touching", "check_touching", "softened"]

ACTIVE_LEAST, AREA_OFF, COP_OFF = 0.95, 0.10, 1.0
"""Least share of taxels that are active at half the weight; most that the footprint's area (share) and the center of
pressure (mm) may be off."""

_SHOES = 200  # that are drawn
_RESERVE = 0.01  # of the share of active taxels, for the draw
_FOAMS = (
    120.0,
    92.0,
    63.0,
    35.0,
    24.0,
    14.0,
    7.0,
)  # kPa at 25 %: upper ends of ASTM D1056's grades 4 to 0, and between
_THICKER, _THICKEST = 0.5, 8.0  # mm of pad
_STRAIN = 0.8  # of the foam at the load case

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Touching:
    """Taxels that touch flat rigid ground at half the robot's weight, seats scattered.

    Attributes:
        scatter: Standard deviation of the seats' heights in mm.
        stiffness: Of a median taxel with its pad in N/mm.
        active: Mean share of taxels above their threshold, 0..1.
        touching: Mean share of those that carry any load, 0..1.
        area: Mean share of the cells' area of the active ones, 0..1.
        cop_error: Distance in mm of the active taxels' center of pressure from the load, 95th percentile.
    """

    scatter: float
    stiffness: float
    active: float
    touching: float
    area: float
    cop_error: float

    def holds(self, reserve: float = 0.0) -> bool:
        """Whether enough of them are active, by a reserve."""
        good = self.active >= ACTIVE_LEAST + reserve and self.area >= 1.0 - AREA_OFF + reserve
        return good and self.cop_error <= COP_OFF * (1.0 - 10.0 * reserve)


def check_touching(plan: ShoePlan, load: LoadCase, parameters: ShoeParameters) -> Touching:
    """Gives what touches in drawn shoes whose seats scatter, by plan, load and parameters; deterministic."""
    force, area = 0.5 * load.mass * GRAVITY, np.array([c.area for c in plan.cells])
    points = np.array([c.centroid.coords[0] for c in plan.cells])
    bed = taxel_stiffness(plan, parameters, force / float(area.sum()))
    scatter = parameters.made_by.scatter
    heights = scatter * np.random.default_rng(1).standard_normal((_SHOES, len(area)))
    middle = (area @ points) / area.sum()
    forces = _forces(points - middle, bed * area, heights, force)
    active = forces >= plan.layout.force_threshold
    read = np.where(active, forces, 0.0)
    total = read.sum(axis=1)
    off = np.full(_SHOES, np.inf)
    off[total > 0.0] = np.hypot(*((read @ points)[total > 0.0] / total[total > 0.0, None] - middle).T)
    return Touching(
        scatter,
        round(float(np.median(bed * area)), 2),
        round(float(active.mean()), 4),
        round(float((forces > 0.0).mean()), 4),
        round(float((active @ area).mean() / area.sum()), 4),
        round(float(min(1e3, np.quantile(off, 0.95))), 3),
    )


def _forces(points: Array, stiffness: Array, heights: Array, force: float) -> Array:
    """Force (shoes, n) of each spring below a plate with a load in the origin: Newton's method on the convex energy."""
    u = np.column_stack([np.ones(len(points)), points / max(1.0, float(np.abs(points).max()))])
    sunk = np.zeros((len(heights), 3))
    sunk[:, 0] = heights.std() + force / stiffness.sum()
    load = np.array([force, 0.0, 0.0])

    def energy(at: Array) -> Array:
        way = np.maximum(at @ u.T + heights, 0.0)
        return np.asarray(0.5 * (way**2) @ stiffness - at @ load)

    for _ in range(60):
        way = np.maximum(sunk @ u.T + heights, 0.0)
        slope = (way * stiffness) @ u - load
        if np.abs(slope).max() < 1e-9 * force:
            break
        bent = np.einsum("sn,ni,nj->sij", stiffness * (way > 0.0), u, u) + 1e-9 * stiffness.sum() * np.eye(3)
        step = np.linalg.solve(bent, slope[..., None])[..., 0]
        rate, before = np.ones(len(heights)), energy(sunk)
        for _ in range(12):
            worse = energy(sunk - rate[:, None] * step) > before
            if not worse.any():
                break
            rate[worse] *= 0.5
        sunk = sunk - rate[:, None] * step
    return np.asarray(stiffness * np.maximum(sunk @ u.T + heights, 0.0))


def softened(plan: ShoePlan, load: LoadCase, parameters: ShoeParameters) -> tuple[ShoeParameters, tuple[str, ...]]:
    """Soften the pad until enough taxels touch: the thinnest, and of that the firmest, foam available.

    Args:
        plan: The sole.
        load: The load case.
        parameters: Dimensions; with `strengthen` no, a given foam, or no pad they stay.

    Returns:
        The parameters, and a note where the pad was changed.
    """
    p = parameters
    if p.strengthen == "no" or p.pad_foam > 0.0 or p.pad_thickness <= 0.0 or check_touching(plan, load, p).holds():
        return p, ()
    pressure = load.force / (p.load_share * sum(c.area for c in plan.cells))
    for thickness in np.arange(p.pad_thickness, _THICKEST + 1e-9, _THICKER).round(3).tolist():
        for foam in _FOAMS:
            soft = replace(p, pad_foam=foam, pad_thickness=thickness)
            strain = pressure / (3e-3 * foam + pressure)
            if strain > _STRAIN or strain * thickness > p.taxel_protrusion:
                break
            if check_touching(plan, load, soft).holds(_RESERVE):
                thicker = "" if thickness == p.pad_thickness else f", {thickness:g} mm instead of {p.pad_thickness:g}"
                return soft, (
                    f"the pad is foam of at most {foam:g} kPa at 25 %{thicker}: seats that scatter by "
                    f"{p.made_by.scatter:g} mm would keep taxels on rubber off the ground",
                )
    return p, ()
