"""An elastic layer over a skin's cells: neighbours share what presses near them."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.arguments import number, positive
from plantar.errors import InputError
from plantar.layouts.layout import SoleLayout
from plantar.sensing.link_skin import SkinPatch

_EXACT = 1e-9  # of the load times the extent: how exactly the cells have the moment
_SQUARE = 4  # neighbours of a cell in a square lattice, at most; hexagons and cells of a surface have six on average


@dataclass(frozen=True)
class ElasticLayer:
    """A homogeneous layer that is bonded to the cells, and is pressed from outside.

    Its face yields by u and what is below it linearly less (Vlasov's layer), so that the pressure on the cells is k u,
    and what presses the face is k u - t div grad u, with k = M / d, t = G d / 3, the constrained modulus M =
    E (1 - nu) / ((1 + nu) (1 - 2 nu)) and the shear modulus G = E / (2 + 2 nu). A load spreads by about sqrt(t / k), a
    quarter of the thickness at nu = 0.4, and shares sum to 1: no force is lost, at no edge.

    Attributes:
        modulus: Young's modulus E in Pa: rubber of 30 Shore A has 1e6. Decides how far the layer yields, not on how
            many cells a load spreads.
        thickness: d in m.
        poisson: Poisson's ratio nu, 0 to below 0.5.

    Raises:
        InputError: If a value is not allowed.

    Sources: Vlasov and Leontiev, Beams, plates and shells on elastic foundations (1966); Kerr, Elastic and viscoelastic
        foundation models (1964).

    Example:
        >>> from plantar import hex_layout
        >>> sole = hex_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]], cell_area=2e-5)
        >>> shares = ElasticLayer(modulus=1e6, thickness=0.01).shares(sole)
        >>> bool(abs(shares.sum(axis=0) - 1.0).max() < 1e-12), bool(shares.min() >= 0.0)
        (True, True)
    """

    modulus: float
    thickness: float
    poisson: float = 0.4

    def __post_init__(self) -> None:
        positive(self.modulus, "modulus", "Pa")
        positive(self.thickness, "thickness", "m")
        if not 0.0 <= number(self.poisson, "poisson", finite=True) < 0.5:
            raise InputError(f"poisson is {self.poisson}; allowed: 0 to below 0.5")

    @property
    def stiffness(self) -> float:
        """Pressure k per yield in Pa/m."""
        nu = self.poisson
        return self.modulus * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)) / self.thickness

    @property
    def spread(self) -> float:
        """Length in m by which a load spreads."""
        shear = self.modulus / (2.0 + 2.0 * self.poisson) * self.thickness / 3.0
        return math.sqrt(shear / self.stiffness)

    def shares(self, layout: SoleLayout | SkinPatch) -> NDArray[np.float64]:
        """Share (n, n) of what presses above each cell (column) that each cell (row) reads; columns sum to 1."""
        count = len(layout)
        sides = max((len(near) for near in layout.neighbours), default=0)
        flow = 4.0 / (_SQUARE if sides <= _SQUARE else 6.0)
        system = np.diag(layout.areas).astype(np.float64)
        for i, near in enumerate(layout.neighbours):
            for j in near:
                apart = float(np.square(layout.positions[i] - layout.positions[j]).sum())
                pull = flow * self.spread**2 * math.sqrt(layout.areas[i] * layout.areas[j]) / apart
                # Each pair is listed from both of its cells.
                system[i, i] += 0.5 * pull
                system[j, j] += 0.5 * pull
                system[i, j] -= 0.5 * pull
                system[j, i] -= 0.5 * pull
        found = np.asarray(layout.areas[:, None] * np.linalg.inv(system))
        return found.reshape(count, count)


class SharedLoad:
    """How the cells of a `layout` share a load by a `layer` over them.

    `shares` (n, n): as `ElasticLayer.shares`.
    """

    def __init__(self, layer: ElasticLayer, layout: SoleLayout | SkinPatch) -> None:
        places = layout.positions
        self.shares = layer.shares(layout)
        self._axes = np.ascontiguousarray(layout.rotations[:, :, 2])
        self._yields = 1.0 / (layer.stiffness * layout.areas)
        self._arms = np.ascontiguousarray(np.cross(places[:, None], np.eye(3)).reshape(-1, 3).T)
        self._extent = float(np.abs(places).max())

    def take(self, load: Any) -> bool:
        """Share a `TaxelLoad` or `PatchLoad` in place, and set its depths to how far the layer yields.

        Returns whether the cells still have the moment of its wrench.
        """
        shared = np.dot(self.shares, load.vectors)
        load.vectors[:] = shared
        load.forces[:] = np.einsum("ij,ij->i", shared, self._axes)
        np.multiply(load.forces, self._yields, out=load.depths)
        np.maximum(load.depths, 0.0, out=load.depths)
        off = np.dot(self._arms, shared.ravel()) - load.wrench[3:]
        size = float(np.abs(shared).sum()) * self._extent
        return bool(max(abs(x) for x in off.tolist()) <= _EXACT * size)
