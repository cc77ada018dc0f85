"""Clusters of values on a line or grid that exceed a threshold with one sign."""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import generate_binary_structure, label


class Clusters:
    """Finds clusters among values at places of a line or grid; places: mask (k,) or (h, w) of the n values, or None."""

    def __init__(self, places: NDArray[np.bool_] | None) -> None:
        self.places = places

    def of(self, t: NDArray[np.float64], threshold: float) -> tuple[NDArray[np.int64], list[float]]:
        """Cluster (n,) of each value, from 1, 0 for none, and each cluster's sum of |t|.

        Example:
            >>> Clusters(np.ones(5, dtype=bool)).of(np.array([3.0, 4.0, 0.0, -3.0, 3.0]), 2.0)
            (array([1, 1, 0, 3, 2]), [7.0, 3.0, 3.0])
        """
        if self.places is None:
            return np.zeros(len(t), dtype=np.int64), []
        labels, count = self._labels(t > threshold)
        below, more = self._labels(t < -threshold)
        labels = np.where(below > 0, below + count, labels)
        masses = np.bincount(labels, np.abs(t), minlength=count + more + 1)[1:]
        return labels, masses.tolist()

    def heaviest(self, t: NDArray[np.float64], threshold: float) -> NDArray[np.float64]:
        """Largest sum (b,) of |t| of a cluster in each of b rows of t (b, n); 0 without any.

        Example:
            >>> rows = np.array([[3.0, 4.0, 0.0, -9.0, 3.0], [0.0, 0.0, 0.0, 0.0, 1.0]])
            >>> Clusters(np.ones(5, dtype=bool)).heaviest(rows, 2.0)
            array([9., 0.])
        """
        places = self.places
        most = np.zeros(len(t))
        if places is None:
            return most
        size = np.abs(t)
        # Rows lie side by side, and no cluster reaches into another row.
        touching = np.zeros((3,) * (1 + places.ndim))
        touching[1] = generate_binary_structure(places.ndim, 1)
        grid = np.zeros((len(t), *places.shape), dtype=bool)
        for part in (t > threshold, t < -threshold):
            grid[:, places] = part
            labels, count = label(grid, touching)
            row, place = np.nonzero(part)
            own = labels[:, places][row, place]
            masses = np.bincount(own, size[row, place], minlength=count + 1)
            row_of = np.zeros(count + 1, dtype=np.int64)
            row_of[own] = row
            np.maximum.at(most, row_of[1:], masses[1:])
        return most

    def _labels(self, beyond: NDArray[np.bool_]) -> tuple[NDArray[np.int64], int]:
        places = self.places
        assert places is not None
        if not beyond.any():
            return np.zeros(len(beyond), dtype=np.int64), 0
        if places.ndim == 1 and places.all():
            starts = beyond & ~np.concatenate([[False], beyond[:-1]])
            return np.where(beyond, np.cumsum(starts), 0), int(starts.sum())
        grid = np.zeros(places.shape, dtype=bool)
        grid[places] = beyond
        labels, count = label(grid)
        return labels[places].astype(np.int64), int(count)
