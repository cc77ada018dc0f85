"""Stress of the largest rectangle at any angle in outlines of thousands of cells at random."""

import math
import time

import numpy as np

from plantar.bench.soles import random_outline
from plantar.geometry.inscribed import rectangle_in_outline, rectangle_in_outline_any_angle
from plantar.geometry.outline import Outline
from plantar.geometry.polygon import area

from .soles import Block
from .tally import Tally

__all__ = ["RANDOM_CHECKS"]

_EVERY = 40
"""One block in so many gets a pattern of 1,000 cells, and one in five times as many one of 5,000."""

_SECONDS = {100: 5.0, 300: 60.0}
"""Processor time that each may take: ten times what a quiet machine needs."""

_SHARES = (0.3, 0.5, 0.6, 0.7, 0.9)


def _random_cells(block: Block, tally: Tally) -> None:
    """A pattern: inside, in time, no less than along the axes, and the gap true of a scan of angles."""
    if block.number % _EVERY:
        return
    turn = block.number // _EVERY
    cells = 100 if turn % 5 else 300
    outline = random_outline(cells, _SHARES[turn % len(_SHARES)], block.number)
    begin = time.process_time()
    corners, gap = rectangle_in_outline_any_angle(outline)
    seconds = time.process_time() - begin
    found = area(corners)
    name = "rectangle_in_outline_any_angle, random cells"
    tally.add(f"{name}: in time", block, seconds / _SECONDS[cells], 1.0)
    tally.add(f"{name}: not less", block, 1.0 - found / area(rectangle_in_outline(outline)), 1e-12)
    tally.add(f"{name}: inside", block, _outside(outline, corners), 1e-9)
    step = corners[1] - corners[0]
    own = math.atan2(step[1], step[0])
    angles = [*np.linspace(0.0, 0.5 * math.pi, 12).tolist(), *(own + s for s in (-1e-2, -1e-4, 1e-4, 1e-2))]
    best = max(area(rectangle_in_outline(outline, a)) for a in angles)
    tally.add(f"{name}: gap", block, best / (found * (1.0 + gap)) - 1.0, 1e-9, len(angles))


def _outside(outline: Outline, corners: np.ndarray) -> float:
    """Share of a rectangle outside an outline, by shapely."""
    import shapely

    parts = shapely.union_all([shapely.Polygon(i[0], i[1:]) for i in outline.islands])
    rectangle = shapely.Polygon(corners)
    return float(shapely.area(shapely.difference(rectangle, parts)) / shapely.area(rectangle))


RANDOM_CHECKS = (_random_cells,)
"""The checks of this module, each a function of a block and a tally."""
