"""One footstep on a walkway: its cells, frames and place."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.layouts.cell_grid import CellGrid
from plantar.layouts.layout import Side


@dataclass(frozen=True, eq=False)
class WalkwayStep:
    """Footstep of k cells in m frames.

    Attributes:
        side: Foot.
        cells: Cells that are ever loaded.
        force: Force (m, k) in N.
        time: Times (m,) in s.
        strike: Heel strike in s.
        lift: Toe off in s.
        walk: Number of the pass over the walkway.
        forward: Direction of walking (2,) in the frame of its cells.
        pose: Place of that frame on the walkway, x and y in m and turn in rad; None where the two are one.
        unused: Why it is not in the means, or empty.
    """

    side: Side
    cells: CellGrid
    force: NDArray[np.float64]
    time: NDArray[np.float64]
    strike: float
    lift: float
    walk: int
    forward: NDArray[np.float64]
    pose: tuple[float, float, float] | None = None
    unused: str = ""
