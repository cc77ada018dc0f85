"""What an unrelieved pad carries past its taxels (docs/shoes.md)."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.geometry.cell_cutting import CellCutter
from plantar.geometry.polygon import area as polygon_area
from plantar.layouts.layout import SoleLayout
from plantar.sim.sensing.contact_patch import MOST_PATCHES, PATCH_GRID, Patches, patch_polygon


class BlindRim:
    """Springs next to the taxels. The taxels carry A_taxels / (A_taxels + k A_rim) of a patch's load, areas over and
    next to taxels, k the stiffness per area over a taxel's.

    `rubber`: half width in m of a line contact.

    Example:
        >>> from plantar import hex_layout
        >>> layout = hex_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]])
        >>> patch = [(-0.1, -0.05), (0.1, -0.05), (0.1, 0.05), (-0.1, 0.05)]
        >>> taxels = layout.areas.sum() / 0.02
        >>> bool(abs(BlindRim(layout, 1.0, 0.003).share(patch) - taxels) < 1e-6)
        True
    """

    def __init__(self, layout: SoleLayout, stiffness: float, rubber: float) -> None:
        self.stiffness = stiffness
        self._rubber = rubber
        self._cutter = CellCutter(layout)
        self._patches = Patches(self._make_share, PATCH_GRID, MOST_PATCHES)

    def share(self, patch: Sequence[tuple[float, float]]) -> float:
        """Share 0..1 of a load that the taxels carry under contact points (k, 2) in m."""
        return self._patches.of(patch)

    def _make_share(self, points: NDArray[np.float64]) -> float:
        polygon, lines = patch_polygon(points, self._rubber)
        taxels = float(self._cutter.cut(lines)[0][:, 0].sum())
        beside = self.stiffness * max(0.0, polygon_area(polygon) - taxels)
        return taxels / (taxels + beside) if taxels > 0.0 else 0.0
