"""Contacts of many small cells, each active by chance: what is hardest for rectangles in the outline."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from plantar.geometry.outline import Outline, concave_outline
from plantar.layouts.layout import SoleLayout
from plantar.layouts.tiling import hex_layout

__all__ = ["random_outline"]

_CELL = 1e-5
"""Area in m^2 of a cell."""


@lru_cache(maxsize=4)
def _layout(cells: int) -> SoleLayout:
    """A lattice of about so many hexagons, twice as long as wide."""
    half = 0.5 * math.sqrt(0.5 * cells * _CELL)
    return hex_layout([[-2 * half, -half], [2 * half, -half], [2 * half, half], [-2 * half, half]], cell_area=_CELL)


def random_outline(active: int, share: float, seed: int) -> Outline:
    """Outline of about so many active cells at random.

    Args:
        active: How many.
        share: Share of the lattice's cells that are active.
        seed: Of what is left to chance.

    Returns:
        The outline.

    Example:
        >>> outline = random_outline(50, 0.6, 0)
        >>> 3e-4 < outline.area < 7e-4
        True
    """
    layout = _layout(round(active / share))
    return concave_outline(layout, np.random.default_rng(seed).random(len(layout)) < share)
