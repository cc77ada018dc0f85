"""Foot as the shoe sees it: outline at the sole and up to the rim."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.optional_library import missing_libraries
from plantar.common.sides import Side
from plantar.errors import FootError
from plantar.layouts.source_pose import SourcePose
from plantar.shoes.geometry.outline import rounded_rectangle, tidy
from plantar.shoes.units import MM_PER_M, to_mm

FOOT_LENGTHS = (60.0, 450.0)  # lengths in mm that a robot's foot may have


@dataclass(frozen=True, repr=False)
class Foot:
    """Left foot of a robot in mm: x forward, y left, z up, sole plane z = 0, origin below the ankle.

    Attributes:
        sole: Shapely outline.
        outline_up_to: Shapely outline of the part below a height above the sole plane.
        height: In mm; infinite for dimensions alone.
        triangles: Surface (n, 3, 3); None with just an outline.
        support: Part touching a flat floor; None for all.
        mass: Robot's in kg.
        links: Points (n, 3) of other robot links as the ankle moves; None if unknown.
        unread: Names of other robot links that may come near and whose shape is not known.
        poses: Of each side's sole frame, on the bare sole, in the file or link it came from, where known; in m.
    """

    name: str
    sole: Any
    outline_up_to: Callable[[float], Any]
    height: float
    notes: tuple[str, ...] = ()
    triangles: NDArray[np.float64] | None = None
    support: Any | None = None
    mass: float | None = None
    links: NDArray[np.float64] | None = None
    unread: tuple[str, ...] = ()
    poses: Mapping[Side, SourcePose] = field(default_factory=dict, hash=False)

    def __repr__(self) -> str:
        x, y, far_x, far_y = self.sole.bounds
        return f"Foot({self.name!r}: sole {far_x - x:.0f} x {far_y - y:.0f} mm)"

    def passing(self, height: float) -> Any:
        """Outline of what passes a height in mm while the shoe is pushed on."""
        return self._passing(round(height, 4))

    @cached_property
    def _passing(self) -> Callable[[float], Any]:
        # The plan asks for the same few heights again and again; each is a union of outlines.
        return cache(lambda height: tidy(self.outline_up_to(height).union(self.sole)))


@missing_libraries("shoes")
def foot_from_dimensions(
    name: str,
    *,
    length: float,
    width: float,
    sole_center: tuple[float, float] = (0.0, 0.0),
    corner_radius: float = 0.0,
    mass: float | None = None,
) -> Foot:
    """Foot with rectangular sole and straight sides.

    Args:
        name: Robot.
        length: Along x in m.
        width: Along y in m.
        sole_center: Middle (2,) of the left foot's box from the ankle in m.
        corner_radius: In m.
        mass: Robot's in kg.

    Returns:
        Left foot.

    Raises:
        FootError: If a dimension is out of range.

    Example:
        >>> foot = foot_from_dimensions("a", length=0.2, width=0.1, sole_center=(0.02, 0.0), corner_radius=0.01)
        >>> foot.sole.bounds
        (-80.0, -50.0, 120.0, 50.0)
    """
    values = (length, width, *sole_center, corner_radius)
    if len(sole_center) != 2 or not all(math.isfinite(v) for v in values):
        raise FootError(f"foot of {name}: length, width, sole_center (x, y) and corner_radius must be finite numbers")
    low, high = FOOT_LENGTHS
    if not (low <= to_mm(length) <= high and 0.25 * low <= to_mm(width) <= high):
        raise FootError(
            f"foot of {name} is {length:g} x {width:g} m; allowed: {low / MM_PER_M:g} to {high / MM_PER_M:g} m long, "
            f"{0.25 * low / MM_PER_M:g} to {high / MM_PER_M:g} m wide"
        )
    if not 0.0 <= corner_radius <= 0.5 * min(length, width):
        raise FootError(f"foot of {name}: corner_radius is {corner_radius:g} m; allowed: 0 to half the width")
    x, y = sole_center
    sole = rounded_rectangle(to_mm(length), to_mm(width), (to_mm(x), to_mm(y)), to_mm(corner_radius))
    note = (
        f"sole from dimensions: {to_mm(length):.1f} x {to_mm(width):.1f} mm, corner radius {to_mm(corner_radius):g} mm"
    )
    return Foot(name, sole, lambda height: sole, math.inf, (note,), mass=mass)


@missing_libraries("shoes")
def foot_from_outline(name: str, outline: Any, notes: tuple[str, ...] = ()) -> Foot:
    """Gives straight-sided foot with a name from a sole outline, shapely in mm about the ankle; notes are kept.

    Raises:
        FootError: If not foot-sized.
    """
    sole = tidy(outline)
    low_x, low_y, high_x, high_y = sole.bounds
    length = high_x - low_x
    width = high_y - low_y
    low, high = FOOT_LENGTHS
    if not (low <= length <= high and 0.25 * low <= width <= length * 1.05):
        raise FootError(
            f"{name}: the outline is {length:.4g} x {width:.4g} mm; allowed: {low:g} to {high:g} mm long, "
            f"{0.25 * low:g} mm wide or more, longer than wide"
        )
    note = f"sole {length:.1f} x {width:.1f} mm from an outline; the foot's sides are taken to be upright"
    return Foot(name, sole, lambda height: sole, math.inf, (*notes, note))
