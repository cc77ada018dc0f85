"""Measuring quality of a sole: touching taxels with scattered seats, CoP observability. In mm.

Print and ground are rigid, each taxel with its pad is a spring. Loads beyond the hull of taxel centres are reported at
it.
"""

from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.common.gravity import GRAVITY
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.ground_plate import has_ground_plate
from plantar.shoes.plan.load_share import spring_forces, taxel_stiffness
from plantar.shoes.plan.shoe_plan import ShoePlan
from plantar.shoes.plan.strength import LoadCase
from plantar.shoes.units import to_mm

# Least share of taxels that are active at half the weight; most that the footprint's area (share) and the center of
# pressure (mm) may be off
ACTIVE_LEAST = 0.95
AREA_OFF = 0.10
COP_OFF = 1.0

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
# mm of pad
_THICKER = 0.5
_THICKEST = 8.0
_STRAIN = 0.8  # of the foam at the load case

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Touching:
    """Taxels touching flat rigid ground at half the robot's weight, seats scattered.

    `scatter`: seat height's standard deviation in mm; `stiffness`: median taxel with pad in N/mm; `active`: mean taxel
    share above threshold, 0..1; `touching`: mean loaded share, 0..1; `area`: mean area share of active cells, 0..1;
    `cop_error`: active taxels' CoP error in mm, 95th percentile.
    """

    scatter: float
    stiffness: float
    active: float
    touching: float
    area: float
    cop_error: float

    def holds(self, reserve: float = 0.0) -> bool:
        """Whether enough are active, by a reserve."""
        good = self.active >= ACTIVE_LEAST + reserve and self.area >= 1.0 - AREA_OFF + reserve
        return good and self.cop_error <= COP_OFF * (1.0 - 10.0 * reserve)


def check_touching(plan: ShoePlan, load: LoadCase, parameters: ShoeParameters) -> Touching:
    """Gives what touches in drawn shoes with scattered seats, by plan, load and parameters; deterministic."""
    force = 0.5 * load.mass * GRAVITY
    area = np.array([c.area for c in plan.cells])
    points = np.array([c.centroid.coords[0] for c in plan.cells])
    bed = taxel_stiffness(plan, parameters, force / float(area.sum()))
    scatter = parameters.made_by.scatter
    heights = scatter * np.random.default_rng(1).standard_normal((_SHOES, len(area)))
    middle = (area @ points) / area.sum()
    forces, _ = spring_forces(points - middle, bed * area, -heights, force)
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


def softened(plan: ShoePlan, load: LoadCase, parameters: ShoeParameters) -> tuple[ShoeParameters, tuple[str, ...]]:
    """Gives parameters with the thinnest, then firmest pad foam with which enough of a plan's taxels touch under a
    load, and a note.
    """
    p = parameters
    if has_ground_plate(plan):
        return p, ()
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


# Least share of the face's length and width that the centres reach over; most error over the face's width
ALONG = 0.55
ACROSS = 0.45
ERROR = 0.40


@dataclass(frozen=True)
class Observability:
    """CoP observability by the taxels.

    `along`: longer side of the centres' smallest rectangle, over the face's length; `across`: shorter side, over the
    face's width; 0 for a line; `error`: largest in mm for a load anywhere on the face; `width`: face's in mm.
    """

    along: float
    across: float
    error: float
    width: float

    @property
    def holds(self) -> bool:
        return self.along >= ALONG and self.across >= ACROSS and self.error <= ERROR * self.width


def observability(plan: ShoePlan) -> Observability:
    """How well a sole's taxels observe the CoP."""
    low_x, low_y, high_x, high_y = plan.contact.bounds
    box = shapely.MultiPoint(to_mm(plan.layout.positions[:, :2])).minimum_rotated_rectangle
    corners = shapely.get_coordinates(box)
    sides = np.hypot(*np.diff(corners, axis=0)[:2].T) if box.geom_type == "Polygon" else np.array([box.length, 0.0])
    return Observability(
        round(float(sides.max() / (high_x - low_x)), 3),
        round(float(sides.min() / (high_y - low_y)), 3),
        round(plan.blind_rim, 2),
        high_y - low_y,
    )
