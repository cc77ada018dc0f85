"""A convex polygon made ready for the kernels of the inscribed and enclosing shapes."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.kernels import inscribed as _kernel
from plantar.kernels import is_compiled

__all__ = ["CleanRing", "room"]

_COMPILED = is_compiled("inscribed") and is_compiled("enclosing") and is_compiled("rectangle")


def room(size: int) -> NDArray[np.float64]:
    """Numbers for a kernel to write to: an array, or a list for the interpreted form, which reads lists faster."""
    return np.empty(size) if _COMPILED else [0.0] * size  # type: ignore[return-value]


class CleanRing:
    """Vertices about the first one, counter-clockwise, without repeated or non-finite ones.

    Args:
        polygon: Convex polygon (k, 2) in m, in either direction.

    Attributes:
        xy: Vertices, flat, relative to `base`.
        n: Number of vertices: 0, 1, 2 (the ends of a polygon without area), or more.
        out: Room for what a kernel returns.

    Example:
        >>> ring = CleanRing([[5.0, 5.0], [5.0, 6.0], [6.0, 6.0], [6.0, 5.0], [6.0, 5.0]])
        >>> ring.n, [float(v) for v in ring.xy[:8]]
        (4, [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0])
    """

    __slots__ = ("n", "out", "size", "xy")

    def __init__(self, polygon: ArrayLike) -> None:
        points = np.ascontiguousarray(polygon, dtype=np.float64).reshape(-1)
        self.size = len(points) // 2
        self.xy = room(len(points) + 6)
        self.out = room(8)
        self.n: int = _kernel.clean_ring(points if _COMPILED else points.tolist(), self.size, self.xy)

    def work(self, size: int) -> NDArray[np.float64]:
        """Room for the work of a kernel."""
        return room(size)

    @property
    def base(self) -> NDArray[np.float64]:
        """Position (2,) in m that the vertices are relative to."""
        return np.array(self.xy[2 * self.size : 2 * self.size + 2])

    def corners(self, count: int) -> NDArray[np.float64]:
        """The first `count` corners that a kernel wrote (count, 2), where the polygon stands, in m."""
        out = np.array(self.out[: 2 * count]).reshape(count, 2)
        out += self.base
        return out

    def flat_shape(self, count: int = 4) -> NDArray[np.float64]:
        """Shape without area (count, 2) for a polygon without area: from one end to the other and back."""
        if self.n == 0:
            return np.empty((0, 2))
        ends = np.array(self.xy[: 2 * self.n]).reshape(self.n, 2) + self.base
        return ends[[0, *[self.n - 1] * (count // 2), *[0] * (count - 1 - count // 2)]]
