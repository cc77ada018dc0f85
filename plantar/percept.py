"""Lazy percept: what a sole feels, each member computed at first use and kept."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from plantar import force as _force
from plantar import polygon as _polygon
from plantar.activation import active_taxels
from plantar.errors import ReadingError
from plantar.layout import SoleLayout
from plantar.reading import Reading

__all__ = ["Percept"]


class Percept:
    """A reading seen through its layout.

    Nothing is computed before it is asked for, and nothing twice. An unloaded sole has defined answers: no CoP
    (None), area 0, an empty polygon, a zero wrench.

    Args:
        layout: The sole, n taxels.
        reading: What its taxels measured.
        force_threshold: Activation threshold epsilon_f in N; the layout's own where None.

    Raises:
        ReadingError: If the reading has another number of taxels than the layout.

    Example:
        >>> from plantar import Percept, Reading, hex_layout
        >>> layout = hex_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]])
        >>> empty = Percept(layout, Reading(time=0.0, force=np.zeros(len(layout))))
        >>> empty.position_cop_in_sole is None, empty.contact_area, empty.support_polygon_in_sole.shape
        (True, 0.0, (0, 2))
    """

    def __init__(self, layout: SoleLayout, reading: Reading, force_threshold: float | None = None) -> None:
        if reading.force.shape[0] != len(layout):
            raise ReadingError(f"reading has {reading.force.shape[0]} taxels; layout '{layout.name}' has {len(layout)}")
        self.layout = layout
        self.reading = reading
        self.force_threshold = layout.force_threshold if force_threshold is None else force_threshold

    @classmethod
    def members(cls) -> tuple[str, ...]:
        """Names of all lazy members; those in a percept's `__dict__` have been computed."""
        return tuple(name for name, value in vars(cls).items() if isinstance(value, cached_property))

    @cached_property
    def active(self) -> NDArray[np.bool_]:
        """Active taxels (n,) (T 4.22)."""
        return active_taxels(self.reading.force, self.force_threshold)

    @cached_property
    def active_force(self) -> NDArray[np.float64]:
        """Normal forces (n,) of the active taxels in N, 0 elsewhere."""
        return np.where(self.active, self.reading.force, 0.0)

    @cached_property
    def vertical_force(self) -> float:
        """Vertical force on the sole in N."""
        return float(self.active_force @ self.layout.rotations[:, 2, 2])

    @cached_property
    def contact_area(self) -> float:
        """Area in m^2 of the active cells (T 4.22, with each cell's own area)."""
        return float(self.layout.areas[self.active].sum())

    @cached_property
    def position_cop_in_sole(self) -> NDArray[np.float64] | None:
        """Centre of pressure (2,) in the sole frame in m, or None without load (T 4.21)."""
        return _force.center_of_pressure(self.layout, self.active_force)

    @cached_property
    def wrench_in_sole(self) -> NDArray[np.float64]:
        """Ground reaction wrench (6,) about the sole frame's origin in N and N m (T 4.23)."""
        return _force.ground_reaction_wrench(self.layout, self.active_force)

    @cached_property
    def support_polygon_in_sole(self) -> NDArray[np.float64]:
        """Convex support polygon (k, 2) in the sole frame in m, counter-clockwise (T 4.24)."""
        if not self.active.any():
            return np.empty((0, 2))
        layout = self.layout
        used = np.unique(layout.corner_vertex[np.repeat(self.active, np.diff(layout.corner_start))])
        return _polygon.convex_hull(layout.vertices[used, :2])

    @cached_property
    def support_area(self) -> float:
        """Area A_p of the support polygon in m^2."""
        return _polygon.area(self.support_polygon_in_sole)

    @cached_property
    def area_ratio(self) -> float:
        """A_p / A_s: area of the support polygon against the sole's outline (T 4.3.2 rule b)."""
        return self.support_area / self.layout.sole_area

    @cached_property
    def centroid_in_sole(self) -> NDArray[np.float64] | None:
        """Centroid (2,) of the support polygon in the sole frame in m, or None without contact (T 4.4.2)."""
        return _polygon.centroid(self.support_polygon_in_sole)
