"""Cable exit and connection board: a place at the rear wall. In mm."""

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.shoes.geometry.outline import ring
from plantar.shoes.parameters import ShoeParameters

LIP = 1.5  # rail behind the board

POST = 2.5  # rail beside the board

HOLE_OFF = 0.2  # of the cable's hole from the wall

_TURNS = (0, 10, -10, 20, -20, 30, -30, 40, -40, 50, -50, 60, -60)  # degrees from straight back
_TURN_COST = 0.03  # mm of reach that a degree of turning is worth
_ENTRY = 0.3  # mm
_REAR = 4.0  # mm: how much of the rim counts as its rear edge


@dataclass(frozen=True)
class Heel:
    """Place outside the rear wall, and a frame there, turned by an angle in rad: x into the shoe, y left."""

    x: float
    y: float
    turn: float
    board: bool

    def placed(self, shape: Any) -> Any:
        """Shapely shape from this frame to the sole frame."""
        turned = shapely.affinity.rotate(shape, self.turn, origin=(0.0, 0.0), use_radians=True) if self.turn else shape
        return shapely.affinity.translate(turned, self.x, self.y)

    def point(self, x: float, y: float) -> NDArray[np.float64]:
        """Gives point x, y of this frame, (2,) in mm in the sole frame."""
        c = math.cos(self.turn)
        s = math.sin(self.turn)
        return np.array([self.x + c * x - s * y, self.y + s * x + c * y])

    def mirrored(self) -> "Heel":
        """Place on the other foot's shoe."""
        return replace(self, y=-self.y, turn=-self.turn)


def holder_depth(parameters: ShoeParameters) -> float:
    """Board holder's reach behind the wall, in mm."""
    p = parameters
    return p.board_gap + p.board_thickness + 2.0 * p.made_by.slide + LIP


def slot_entry(parameters: ShoeParameters) -> float:
    """Bevel in mm around the upper end of the board's slot; its rail stays a wall."""
    return min(_ENTRY, max(LIP - parameters.wall_min, 0.0))


def find_heel(rim: Any, foot: Any, parameters: ShoeParameters) -> tuple[Heel, str | None]:
    """Gives place where the board's holder reaches least beyond the foot, turned up to 60 degrees, by rim and foot
    (shapely) and parameters; and a note if left out.
    """
    half = 0.5 * parameters.board_length + POST + parameters.made_by.slide
    depth = holder_depth(parameters)
    points = ring(rim)
    best: tuple[float, float, Heel] | None = None
    for degrees in _TURNS:
        turn = math.radians(degrees)
        along = np.array([math.cos(turn), math.sin(turn)])
        across = np.array([-along[1], along[0]])
        start = float((points @ along).min())
        local = shapely.affinity.rotate(rim, -turn, origin=(0.0, 0.0), use_radians=True) if degrees else rim
        low_x, low_y, _, high_y = local.bounds
        rear = local.intersection(shapely.box(low_x - 1.0, low_y - 1.0, low_x + _REAR, high_y + 1.0))
        middle = 0.5 * (rear.bounds[1] + rear.bounds[3])
        x, y = (round(float(v), 3) for v in start * along + middle * across)
        heel = Heel(x, y, turn, True)
        reach = float(max(foot.distance(shapely.points([heel.point(-depth, side * half) for side in (-1.0, 1.0)]))))
        score = reach + _TURN_COST * abs(degrees)
        if best is None or score < best[0] - 1e-6:
            best = (score, reach, heel)
    assert best is not None
    _, reach, heel = best
    if parameters.board_length <= 0.0:
        return replace(heel, board=False), None
    across = shapely.affinity.rotate(rim, -heel.turn, origin=(heel.x, heel.y), use_radians=True).bounds
    wide = 2.0 * min(heel.y - across[1], across[3] - heel.y) - 2.0 * _REAR
    if wide < 2.0 * half:
        note = f"no holder for the connection board: it is {2.0 * half:.0f} mm wide, this heel has room for {wide:.0f}"
        return replace(heel, board=False), f"{note} (a shorter board_length may fit)"
    if reach > parameters.reach_max:
        note = (
            f"no holder for the connection board: behind this heel it would reach {reach:.1f} mm beyond the foot "
            "(reach_max; a shorter board_length may fit)"
        )
        return replace(heel, board=False), note
    return heel, None
