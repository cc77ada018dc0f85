"""Error of the center of pressure by what causes it: seats, gains, hysteresis, threshold, range, crosstalk, blind rim.

Half the robot's weight acts at places all over the face. Print and ground are rigid, each taxel with its pad is a
spring; a load beyond the hull of the taxels' centres acts on them at that hull. What a taxel reads of its force f is

    r = min(rated, (1 + g) (1 + h b) f)  where that reaches the threshold, else 0,

with the gain error g of a cell (normal, `gain_scatter`), its hysteresis h and b = 1 where its load falls, 0 where it
rises (by chance for each), and of r its neighbours have the share `crosstalk` together. In mm.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.common.gravity import GRAVITY
from plantar.shoes.cells.cell import Cell
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.load_share import spring_forces, square_grid, taxel_stiffness
from plantar.shoes.plan.shoe_plan import ShoePlan
from plantar.shoes.plan.strength import LoadCase
from plantar.shoes.plan.touching import ERROR

_PLACES = 100  # of the load, about so many, spread evenly over the face
_SHOES = 4  # drawn for each place
_QUANTILE = 0.95
_NEAR = 1.6  # of the distance to the nearest: neighbours of a cell
_OF_LENGTH = 0.05  # of the face's length: a walk's center of pressure runs over nearly all of it
_OF_WIDTH = 0.05  # of the face's width: half of the tenth that a balance keeps free along each edge

Array = NDArray[np.float64]


@dataclass(frozen=True)
class CopBudget:
    """Error of the center of pressure in mm, 95 % of places and shoes.

    Each cause alone, and all `together`; `limit` of the stated `use`; `seats` are those of the cells, of which low ones
    stay below the threshold, `range` what is beyond the rated load, `blind_rim` what lies beyond the taxels' hull.
    """

    seats: float
    gain: float
    hysteresis: float
    threshold: float
    range: float
    crosstalk: float
    blind_rim: float
    together: float
    limit: float
    use: str

    @property
    def holds(self) -> bool:
        return self.together <= self.limit


def check_cop_budget(plan: ShoePlan, load: LoadCase, parameters: ShoeParameters) -> CopBudget:
    """Gives the budget of a plan under half the weight of a load, by parameters; deterministic."""
    p = parameters
    cell = plan.cell or Cell(shape="square", size=20.0)  # skin: no figures of its response are published
    force = 0.5 * load.mass * GRAVITY
    areas = np.array([c.area for c in plan.cells])
    points = np.array([c.centroid.coords[0] for c in plan.cells])
    stiffness = taxel_stiffness(plan, p, force / float(areas.sum())) * areas
    chance = np.random.default_rng(3)
    places = square_grid(plan.contact, float(np.sqrt(plan.contact.area / _PLACES)))
    acting = _within_hull(points, places)
    heights = p.made_by.scatter * chance.standard_normal((_SHOES, len(points)))
    gaps = np.concatenate([np.zeros((1, len(points))), -heights])
    forces = _forces(points, acting, stiffness, force, gaps)
    even = np.repeat(forces[:, :1], _SHOES, axis=1)
    uneven = forces[:, 1:]
    gain = 1.0 + cell.gain_scatter * chance.standard_normal(even.shape)
    falling = 1.0 + cell.hysteresis * chance.integers(0, 2, even.shape)
    spread = _spread(points, cell.crosstalk)
    level = plan.layout.force_threshold
    rated = plan.layout.ranges["force"][1]

    def error(read: Array, from_places: Array) -> float:
        total = read.sum(axis=-1)
        silent = total <= 0.0
        at = (read @ points) / np.where(silent, 1.0, total)[..., None]
        off = np.where(silent, np.inf, np.hypot(*np.moveaxis(at - from_places[:, None], -1, 0)))
        return round(float(min(1e3, np.quantile(off, _QUANTILE, method="inverted_cdf"))), 2)

    def passed(read: Array) -> Array:
        return np.where(read >= level, read, 0.0)

    all_of_it = passed(np.minimum(uneven * gain * falling, rated) @ spread)
    return CopBudget(
        seats=error(passed(uneven), acting),
        gain=error(even * gain, acting),
        hysteresis=error(even * falling, acting),
        threshold=error(passed(even), acting),
        range=error(np.minimum(even, rated), acting),
        crosstalk=error(even @ spread, acting),
        blind_rim=error(even, places),
        together=error(all_of_it, places),
        limit=round(_limit(plan.contact, p.use), 1),
        use=p.use,
    )


def _limit(face: Any, use: str) -> float:
    low_x, low_y, high_x, high_y = face.bounds
    width = float(high_y - low_y)
    return {"contact": ERROR * width, "gait": _OF_LENGTH * float(high_x - low_x), "balance": _OF_WIDTH * width}[use]


def _within_hull(points: Array, places: Array) -> Array:
    """Nearest place (n, 2) of the hull of points to each of some places."""
    hull = shapely.MultiPoint(points).convex_hull
    lines = shapely.shortest_line(hull, shapely.points(places))
    return np.array([line.coords[0] for line in lines])


def _forces(points: Array, places: Array, stiffness: Array, force: float, gaps: Array) -> Array:
    """Forces (places, shoes, n) in N on taxels below a plate that is pressed at a place; gaps (shoes, n)."""
    return np.stack([spring_forces(points - place, stiffness, gaps, force)[0] for place in places])


def _spread(points: Array, share: float) -> Array:
    """What each taxel's reading (rows) gives to all (columns): a share to its neighbours, the rest to itself."""
    gaps = np.hypot(*np.moveaxis(points[:, None] - points[None], -1, 0))
    np.fill_diagonal(gaps, np.inf)
    near = gaps <= _NEAR * gaps.min(axis=1, initial=np.inf, keepdims=True)
    given = share * near / np.maximum(near.sum(axis=1, keepdims=True), 1)
    return np.asarray(given + np.diag(1.0 - given.sum(axis=1)))
