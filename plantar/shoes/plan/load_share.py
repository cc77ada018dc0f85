"""Load share on taxels: rigid print and ground, springs between.

Under a taxel the pad's sheet and the taxel are in series; next to taxels the pad carries once the relief below the
print closes. Each is a bonded rubber layer with the apparent modulus

    E_c = E (1 + 2 k S^2)                                                        (Gent and Lindley 1959, eq. 11)

with the shape factor S = loaded area / (perimeter x thickness), k by the hardness (Lindley, "Engineering design with
natural rubber", table 3), and for H degrees Shore A

    E = 0.0981 (56 + 7.62336 H) / (0.137505 (254 - 2.54 H))  in MPa              (Gent 1958)

Foam has no shape factor; its gas cells give a pressure s at a compression per thickness of e

    s = E e / (1 - e)     with the secant modulus     s / e = E + s, E three times the pressure at 25 %.
"""

# Gent: "On the relation between indentation hardness and Young's modulus", Trans. IRI 34, 1958. Gent, Lindley: "The
# compression of bonded rubber blocks", Proc. IMechE 173, 1959. Foam: 4 % off the data sheet of Plastazote LD33.

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.ground_plate import has_ground_plate, plate_carries
from plantar.shoes.plan.shoe_plan import ShoePlan, pad_rim
from plantar.shoes.plan.strength import LoadCase

_POINTS = 3000  # springs of a sole
_HARD = 1e3  # N/mm^3: print on the ground, without a pad
_RESERVE = 1.25  # relief over the taxels' compression at the largest load
_STEP = 0.1  # mm
_HALF = 0.9  # share on half the sole that the relief is raised for
# k by hardness
_HARDNESS = (30.0, 40.0, 50.0, 60.0, 70.0)
_FACTOR = (0.93, 0.85, 0.73, 0.57, 0.53)

Array = NDArray[np.float64]


@dataclass(frozen=True)
class LoadShare:
    """Load share of the taxels.

    `flat` on flat ground, 0..1; `half` on the worst half foothold of four: heel, toes, left, right; 0..1;
    `compression`: print's travel on flat ground in mm; `rim_stiffness`: stiffness per area next to the taxels over a
    taxel's, on flat ground.
    """

    flat: float
    half: float
    worst_half: str
    compression: float
    rim_stiffness: float


def shore_modulus(hardness: float) -> float:
    """Young's modulus in MPa of rubber by degrees Shore A.

    Example:
        >>> round(shore_modulus(40.0), 2), round(shore_modulus(60.0), 2)
        (1.69, 3.61)
    """
    return 0.0981 * (56.0 + 7.62336 * hardness) / (0.137505 * (254.0 - 2.54 * hardness))


def apparent_modulus(hardness: float, area: float, perimeter: float, thickness: float) -> float:
    """Gives modulus in MPa of a bonded rubber layer: hardness in degrees Shore A, area in mm^2, perimeter and thickness
    in mm.
    """
    shape = area / (perimeter * thickness)
    return shore_modulus(hardness) * (1.0 + 2.0 * float(np.interp(hardness, _HARDNESS, _FACTOR)) * shape**2)


def pad_modulus(parameters: ShoeParameters, area: float, perimeter: float, thickness: float, pressure: float) -> float:
    """Gives modulus in MPa of a pad layer by parameters, loaded area in mm^2, perimeter and thickness in mm, and for
    foam pressure in MPa.
    """
    if parameters.pad_foam > 0.0:
        return 3e-3 * parameters.pad_foam + pressure
    return apparent_modulus(parameters.pad_hardness, area, perimeter, thickness)


def taxel_stiffness(plan: ShoePlan, parameters: ShoeParameters, pressure: float) -> float:
    """Gives pressure over compression, in N/mm^3, of a plan's median taxel and pad in series (of films and sheets body,
    land and pad), by parameters and pressure in MPa.
    """
    p = parameters
    blocks = plan.lands or plan.cells
    area = float(np.median([c.area for c in blocks]))
    perimeter = float(np.median([c.length for c in blocks]))
    height = p.taxel_protrusion + p.pocket_depth
    hardness = p.taxel_hardness
    soft = 0.0
    if plan.cell is not None:
        height -= plan.cell.thickness
        if plan.cell.stiffness:
            soft = float(np.median([c.area for c in plan.cells])) / plan.cell.stiffness
    if height > 0.0:
        own = plan.lands and p.pad_thickness > 0.0
        of_head = pad_modulus(p, area, perimeter, height, pressure) if own else 0.0
        soft += height / (of_head or apparent_modulus(hardness, area, perimeter, height))
    if p.pad_thickness > 0.0 and p.pad_kind == "soft":
        soft += p.pad_thickness / pad_modulus(p, area, perimeter, p.pad_thickness, pressure)
    return 1.0 / soft


def relieved(plan: ShoePlan, load: LoadCase, parameters: ShoeParameters) -> tuple[ShoeParameters, tuple[str, ...]]:
    """Gives parameters with the pad's relief raised by 0.1 mm until a plan's taxels carry the load, and a note."""
    p = parameters
    if p.strengthen == "no" or has_ground_plate(plan):
        return p, ()
    pressure = load.force / (p.load_share * sum(c.area for c in plan.cells))
    needed = _RESERVE * pressure / taxel_stiffness(plan, p, pressure)
    relief = max(p.pad_relief, math.ceil(needed / _STEP - 1e-6) * _STEP)
    # Where the taxels stand on one side of a foothold the print tilts towards its other.
    while relief < p.taxel_protrusion and check_load_share(plan, load, replace(p, pad_relief=relief)).half < _HALF:
        relief += 2.0 * _STEP
    relief = round(min(p.taxel_protrusion, relief), 3)
    if relief <= p.pad_relief:
        return p, ()
    note = f"pad_relief raised from {p.pad_relief:g} to {relief:g} mm by the load case"
    return replace(p, pad_relief=relief), (note,)


def check_load_share(plan: ShoePlan, load: LoadCase, parameters: ShoeParameters) -> LoadShare:
    """Gives taxels' share of a load in the middle of the ground, flat and half footholds, by plan and parameters."""
    if has_ground_plate(plan):
        return _plate_share(plan)
    springs = _Springs.of(plan, parameters, load.force / sum(c.area for c in plan.cells))
    flat, sunk = springs.share(np.ones(len(springs.points), dtype=bool), load.force)
    shares = {name: springs.share(_within(half, springs.points), load.force)[0] for name, half in _halves(plan).items()}
    worst = min(shares, key=lambda name: shares[name])
    beside = float((~springs.taxel).sum()) / max(1, int(springs.taxel.sum()))
    stiffness = max(0.0, 1.0 - flat) / (flat * beside) if flat > 0.0 and beside > 0.0 else 0.0
    return LoadShare(flat, shares[worst], worst, sunk, stiffness)


def _halves(plan: ShoePlan) -> dict[str, Any]:
    """Shapely boxes about each half of a plan's face."""
    low_x, low_y, high_x, high_y = plan.contact.bounds
    middle_x = 0.5 * (low_x + high_x)
    middle_y = 0.5 * (low_y + high_y)
    return {
        "heel": shapely.box(low_x, low_y, middle_x, high_y),
        "toes": shapely.box(middle_x, low_y, high_x, high_y),
        "left": shapely.box(low_x, middle_y, high_x, high_y),
        "right": shapely.box(low_x, low_y, high_x, middle_y),
    }


def _plate_share(plan: ShoePlan) -> LoadShare:
    shares = {name: plate_carries(plan, plan.contact & half) for name, half in _halves(plan).items()}
    worst = min(shares, key=lambda name: shares[name])
    return LoadShare(plate_carries(plan, plan.contact), shares[worst], worst, 0.0, 0.0)


@dataclass(frozen=True)
class _Springs:
    """Springs (n,) on a grid: place, whether a taxel's, free travel in mm, stiffness in N/mm."""

    points: Array
    taxel: NDArray[np.bool_]
    gap: Array
    stiffness: Array

    @classmethod
    def of(cls, plan: ShoePlan, p: ShoeParameters, pressure: float) -> "_Springs":
        step = math.sqrt(plan.contact.area / _POINTS)
        points = square_grid(plan.contact, step)
        rim = pad_rim(plan, p)
        taxel = _within(shapely.union_all(plan.cells), points)
        raised = _within(rim, points)
        gap = np.where(taxel, 0.0, np.where(raised, p.pad_relief, p.taxel_protrusion))
        beside = _HARD
        if p.pad_thickness > 0.0:
            across = plan.contact.area, plan.contact.length
            beside = pad_modulus(p, *across, p.pad_thickness, pressure) / p.pad_thickness
        thick = p.pad_thickness + p.pad_rim_height
        rim_stiffness = 0.0 if rim.is_empty else pad_modulus(p, rim.area, rim.length, thick, pressure) / thick
        stiffness = (
            np.where(taxel, taxel_stiffness(plan, p, pressure), np.where(raised, rim_stiffness, beside)) * step**2
        )
        return cls(points, taxel, gap, stiffness)

    def share(self, held: NDArray[np.bool_], force: float) -> tuple[float, float]:
        if not held.any():
            return 0.0, 0.0
        points = self.points[held]
        at = points - points.mean(axis=0)  # the load acts in the middle
        forces, travel = spring_forces(at, self.stiffness[held], self.gap[held][None], force)
        return float(forces[0, self.taxel[held]].sum() / forces.sum()), float(travel[0])


def square_grid(face: Any, step: float) -> Array:
    """Gives middles (n, 2) of squares with a side, step, that lie in a shapely face, row by row."""
    low_x, low_y, high_x, high_y = face.bounds
    x, y = (np.arange(low + 0.5 * step, high, step) for low, high in ((low_x, high_x), (low_y, high_y)))
    grid = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    return np.asarray(grid[_within(face, grid)])


def spring_forces(points: Array, stiffness: Array, gaps: Array, force: float) -> tuple[Array, Array]:
    """Gives force (k, n) in N and travel (k,) in mm of k rigid plates on pushing springs: points (n, 2) from the load
    in mm, stiffness (n,) in N/mm, gaps (k, n) of free travel in mm, force in N; Newton's method on the convex energy
    with line search.
    """
    u = np.column_stack([np.ones(len(points)), points / max(1.0, float(np.abs(points).max()))])
    load = np.array([force, 0.0, 0.0])
    sunk = np.zeros((len(gaps), 3))
    sunk[:, 0] = np.median(gaps, axis=1) + force / stiffness.sum()

    def pressed(at: Array) -> Array:
        return np.asarray(np.maximum(at @ u.T - gaps, 0.0))

    def energy(at: Array) -> Array:
        return np.asarray(0.5 * pressed(at) ** 2 @ stiffness - at @ load)

    for _ in range(60):
        way = pressed(sunk)
        slope = (way * stiffness) @ u - load
        if np.abs(slope).max() < 1e-9 * force:
            break
        bent = np.einsum("sn,ni,nj->sij", stiffness * (way > 0.0), u, u) + 1e-9 * stiffness.sum() * np.eye(3)
        step = np.linalg.solve(bent, slope[..., None])[..., 0]
        rate = np.ones(len(gaps))
        before = energy(sunk)
        for _ in range(20):
            worse = energy(sunk - rate[:, None] * step) > before
            if not worse.any():
                break
            rate[worse] *= 0.5
        sunk = sunk - rate[:, None] * step
    return stiffness * pressed(sunk), sunk[:, 0]


def _within(shape: Any, points: Array) -> NDArray[np.bool_]:
    shapely.prepare(shape)
    return np.asarray(shapely.contains_xy(shape, points[:, 0], points[:, 1]))
