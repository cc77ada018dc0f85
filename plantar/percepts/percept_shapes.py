"""Members of a percept: the contact's shape."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from plantar.common.lazy import lazy
from plantar.geometry import enclosing as _enclosing
from plantar.geometry import inscribed as _inscribed
from plantar.geometry.inscribed import Circle, safe_rectangle
from plantar.geometry.outline import Outline, concave_outline
from plantar.layouts.layout import SoleLayout


class ShapeMembers:
    """Shapes of the contact in sole frame in m: counter-clockwise corners, none (0, 2) without."""

    layout: SoleLayout

    if TYPE_CHECKING:  # what `Percept` brings

        @property
        def active(self) -> NDArray[np.bool_]: ...

        @property
        def support_polygon_in_sole(self) -> NDArray[np.float64]: ...

    @lazy
    def concave_outline_in_sole(self) -> Outline:
        """Exact contact outline with islands and holes (T 4.2.5)."""
        return concave_outline(self.layout, self.active)

    @lazy
    def bounding_box_in_sole(self) -> NDArray[np.float64]:
        """Axis-aligned box (4, 2) of support polygon (T 4.4.4)."""
        return _enclosing.bounding_box(self.support_polygon_in_sole)

    @lazy
    def oriented_box_in_sole(self) -> NDArray[np.float64]:
        """Rectangle (4, 2) of least area around the support polygon."""
        return _enclosing.oriented_box(self.support_polygon_in_sole)

    @lazy
    def enclosing_parallelogram_in_sole(self) -> NDArray[np.float64]:
        """Parallelogram (4, 2) of least area around the support polygon (T 4.2.5)."""
        return _enclosing.enclosing_parallelogram(self.support_polygon_in_sole)

    @lazy
    def inscribed_triangle_in_sole(self) -> NDArray[np.float64]:
        """Largest triangle (3, 2) in support polygon (T 4.2.5)."""
        return _inscribed.inscribed_triangle(self.support_polygon_in_sole)

    @lazy
    def inscribed_parallelogram_in_sole(self) -> NDArray[np.float64]:
        """Largest parallelogram (4, 2) in support polygon (T 4.2.5)."""
        return _inscribed.inscribed_parallelogram(self.support_polygon_in_sole)

    @lazy
    def inscribed_circle_in_sole(self) -> Circle | None:
        """Largest circle in support polygon, or None without contact."""
        return _inscribed.inscribed_circle(self.support_polygon_in_sole)

    @lazy
    def inscribed_rectangle_in_sole(self) -> NDArray[np.float64]:
        """Largest axis-aligned rectangle (4, 2) in support polygon (T 4.4.4)."""
        return _inscribed.inscribed_rectangle(self.support_polygon_in_sole)

    @lazy
    def inscribed_rectangle_any_angle_in_sole(self) -> NDArray[np.float64]:
        """Largest rectangle (4, 2) in support polygon, at any angle."""
        return _inscribed.inscribed_rectangle_any_angle(self.support_polygon_in_sole)

    @lazy
    def outline_rectangle_in_sole(self) -> NDArray[np.float64]:
        """Largest axis-aligned rectangle (4, 2) in the concave outline: all of it is contact."""
        return _inscribed.rectangle_in_outline(self.concave_outline_in_sole)

    def safe_rectangle_in_sole(self, offset: float) -> NDArray[np.float64]:
        """Largest axis-aligned rectangle (4, 2) in support polygon, sides moved inwards (T 4.4.4).

        Args:
            offset: How far in m, 0 or more.

        Raises:
            InputError: Offset negative.
        """
        return safe_rectangle(self.support_polygon_in_sole, offset)
