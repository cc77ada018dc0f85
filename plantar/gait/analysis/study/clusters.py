"""Clusters of values on a line or grid that exceed a threshold with one sign."""

import numpy as np
from numpy.typing import NDArray


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
        label, count = self._labels(t > threshold)
        below, more = self._labels(t < -threshold)
        label = np.where(below > 0, below + count, label)
        masses = np.bincount(label, np.abs(t), minlength=count + more + 1)[1:]
        return label, masses.tolist()

    def heaviest(self, t: NDArray[np.float64], threshold: float) -> float:
        """Largest sum of |t| of a cluster; 0 without any."""
        most = 0.0
        for part in (t > threshold, t < -threshold):
            if part.any():
                label, count = self._labels(part)
                most = max(most, float(np.bincount(label, np.abs(t), minlength=count + 1)[1:].max()))
        return most

    def _labels(self, beyond: NDArray[np.bool_]) -> tuple[NDArray[np.int64], int]:
        places = self.places
        assert places is not None
        if not beyond.any():
            return np.zeros(len(beyond), dtype=np.int64), 0
        if places.ndim == 1 and places.all():
            starts = beyond & ~np.concatenate([[False], beyond[:-1]])
            return np.where(beyond, np.cumsum(starts), 0), int(starts.sum())
        from scipy.ndimage import label

        grid = np.zeros(places.shape, dtype=bool)
        grid[places] = beyond
        labels, count = label(grid)
        return labels[places].astype(np.int64), int(count)
