"""Cells of a sole that share a load as an elastic foundation that cannot pull (Winkler)."""

import numpy as np
from numpy.typing import NDArray

from plantar.geometry.polygon import convex_hull, inner_offset
from plantar.kernels.contacts.pressed_patch import PressedPatch

_INSIDE = 2e-3  # of a patch's half extent: how far inside its outermost cells a load acts, so that several carry it
_SINGULAR = 1e-9  # of the largest eigenvalue, below which cells have no stiffness in a direction


def pressed_patch(cells: NDArray[np.intp], area: NDArray[np.float64], points: NDArray[np.float64]) -> PressedPatch:
    """Returns the patch of cells.

    `cells`: index (m,) of each in its sole; `area`: covered area (m,) of each, in any unit; `points`: its place (m, 2)
    in m.
    """
    area = np.asarray(area / area.sum(), dtype=np.float64)
    centre = area @ points
    off = points - centre
    scale = max(float(np.abs(off).max()), 1e-3)
    u = np.empty((len(points), 3))
    u[:, 0] = 1.0
    u[:, 1:] = off / scale
    return PressedPatch(
        cells,
        (float(centre[0]), float(centre[1])),
        scale,
        area,
        u,
        # One cell, or cells in a row, have no stiffness in some direction: what the load asks there is dropped.
        _pseudo_inverse((area * u.T) @ u, _SINGULAR),
        np.ascontiguousarray(reach_of(convex_hull(u[:, 1:]))),
    )


def reach_of(hull: NDArray[np.float64], inside: float = _INSIDE) -> NDArray[np.float64]:
    """Where a load of several cells can act: their hull moved inward, shrunk where thinner.

    `hull` (k, 2) of the cells' places; `inside`: distance in the hull's unit. Returns polygon (m, 2) in the same unit.
    """
    smaller = inner_offset(hull, inside)
    if len(smaller) >= 3:
        return smaller
    middle = hull.mean(axis=0)
    return np.asarray(middle + (1.0 - _INSIDE) * (hull - middle))


def _pseudo_inverse(matrix: NDArray[np.float64], least: float) -> NDArray[np.float64]:
    """Pseudo-inverse of a symmetric semidefinite matrix (n, n), faster than `np.linalg.pinv`."""
    values, vectors = np.linalg.eigh(matrix)
    values = values[::-1]
    vectors = np.ascontiguousarray(vectors[:, ::-1])
    limit = least * values[0]
    inverse = np.array([1.0 / value if value > limit else 0.0 for value in values.tolist()])
    return np.asarray(vectors @ (inverse[:, None] * vectors.T))
