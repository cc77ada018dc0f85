"""A figure's ground plane, with the walk's longer direction to the right."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["AXES", "WalkPlane"]

AXES = ("x forward [m]", "y left [m]")
"""Labels of the world's axes."""


@dataclass(frozen=True, eq=False)
class WalkPlane:
    """The plane from `low` to `high` (2,) in m; a walk along y has y to the right, x down."""

    low: NDArray[np.float64]
    high: NDArray[np.float64]

    @classmethod
    def around(cls, points: NDArray[np.float64], pad: float) -> "WalkPlane":
        """Returns the plane around `points` (n, 2) in m, without NaN, with margin `pad` in m."""
        return cls(np.nanmin(points, axis=0) - pad, np.nanmax(points, axis=0) + pad)

    @property
    def turn(self) -> list[int]:
        span = self.high - self.low
        return [1, 0] if span[1] > span[0] else [0, 1]

    @property
    def slenderness(self) -> float:
        """Height over width as drawn."""
        span = (self.high - self.low)[self.turn]
        return float(span[1] / span[0])

    def frame(self, axis: Any) -> None:
        """Set limits, labels and the legend of a plot."""
        (x, y), low, high = self.turn, self.low, self.high
        axis.set_xlim(low[x], high[x])
        axis.set_ylim(*((high[y], low[y]) if x else (low[y], high[y])))
        axis.set(aspect="equal", xlabel=AXES[x], ylabel=AXES[y])
        axis.legend(ncol=7, fontsize=7, loc="lower center", bbox_to_anchor=(0.5, 1.01), frameon=False)
