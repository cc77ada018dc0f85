"""What a shoe whose pad is not relieved carries past its taxels (docs/shoes.md)."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.errors import InputError
from plantar.geometry.cell_cutting import CellCutter
from plantar.geometry.polygon import area as polygon_area
from plantar.layouts.layout import SoleLayout
from plantar.sim.sensing.contact_patch import Patches, patch_polygon

__all__ = ["BlindRim"]

_GRID = 1e-4  # m: patches that agree within this are the same patch
_MOST_PATCHES = 256


class BlindRim:
    """The sole beside the taxels as springs beside theirs: of a patch's load they carry the share

        s = A_taxels / (A_taxels + k A_rim)

    with the areas of the patch over taxels and beside them, and the stiffness k of the rim per area over a taxel's. The
    load stays where it acts; only its size is read too small.

    Args:
        layout: The sole.
        stiffness: k, as the table `shoe` of a layout file has it (`rim_stiffness`).
        rubber: Half width in m of what a line or point contact presses on.

    Raises:
        InputError: If the stiffness is not a finite value of 0 or more.

    Example:
        >>> from plantar import hex_layout
        >>> layout = hex_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]])
        >>> patch = [(-0.1, -0.05), (0.1, -0.05), (0.1, 0.05), (-0.1, 0.05)]
        >>> taxels = layout.areas.sum() / 0.02
        >>> bool(abs(BlindRim(layout, 1.0, 0.003).share(patch) - taxels) < 1e-6)
        True
    """

    def __init__(self, layout: SoleLayout, stiffness: float, rubber: float) -> None:
        if not (math.isfinite(stiffness) and stiffness >= 0.0):
            raise InputError(f"stiffness of the rim is {stiffness}; allowed: a finite value of 0 or more")
        self.stiffness = stiffness
        self._rubber = rubber
        self._cutter = CellCutter(layout)
        self._patches = Patches(self._make_share, _GRID, _MOST_PATCHES)

    def share(self, patch: Sequence[tuple[float, float]]) -> float:
        """Share of a load on a patch that the taxels carry.

        Args:
            patch: Contact points (x, y) in the sole frame in m; the patch is their convex hull.

        Returns:
            The share, 0..1.
        """
        return self._patches.of(patch)

    def _make_share(self, points: NDArray[np.float64]) -> float:
        if self.stiffness == 0.0:
            return 1.0
        polygon, lines = patch_polygon(points, self._rubber)
        taxels = float(self._cutter.cut(lines)[0][:, 0].sum())
        beside = self.stiffness * max(0.0, polygon_area(polygon) - taxels)
        return taxels / (taxels + beside) if taxels > 0.0 else 0.0
