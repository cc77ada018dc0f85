"""Sole layout: where the taxels of one sole are.

Frames: the sole frame lies on the outer contact face of the sole, x forward, y left, z up. A taxel's own frame has
its z axis pointing INTO the body, so the force the world exerts on it is [0, 0, f] with f >= 0.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from plantar.errors import LayoutError
from plantar.kernels.sole import SoleKernel

__all__ = [
    "CELL_SHAPES",
    "DEFAULT_RANGES",
    "DEFAULT_THRESHOLDS",
    "LARGEST_COORDINATE",
    "MODALITIES",
    "Side",
    "SoleLayout",
    "mirrored",
]

Side = Literal["left", "right"]
"""Which foot a sole belongs to."""

MODALITIES: tuple[str, ...] = ("force", "proximity", "temperature", "acceleration")
"""What a taxel can sense (T 4.2.1)."""

DEFAULT_RANGES: Mapping[str, tuple[float, float]] = {
    "force": (0.0, 785.0),
    "proximity": (0.0, 0.05),
    "temperature": (0.0, 60.0),
    "acceleration": (-19.62, 19.62),
}
"""Sensing range of each modality in N, m, degC and m/s^2: 80 kg a taxel (T 4.2.1), 50 mm of proximity."""

CELL_SHAPES: tuple[str, ...] = ("hexagon", "rectangle", "polygon", "mixed")
"""What a layout's cells are; clipped cells keep the name of the whole cell."""

LARGEST_COORDINATE = 50.0
"""Largest coordinate of a layout in m: a sole in millimetres is found out, a long walkway is not."""

DEFAULT_THRESHOLDS: Mapping[str, float] = {"force": 0.15 * 9.81, "proximity": 0.05, "temperature": 31.0}
"""Activation thresholds: 0.15 kg of force (T Table 2) in N, the proximity range in m, and 31 degC (T 3.3.2.1)."""


@dataclass(frozen=True, eq=False)
class SoleLayout:
    """The taxels of one sole. Arrays are read-only; n taxels, v vertices.

    Attributes:
        name: Name of the sole, for example of the robot that wears it.
        side: "left" or "right".
        positions: Taxel centres (n, 3) in the sole frame in m.
        rotations: Rotations (n, 3, 3) from each taxel's frame to the sole frame.
        vertices: Corner points (v, 3) in the sole frame in m, shared between cells that meet.
        corners: For each taxel the indices of its corners in `vertices`, counter-clockwise seen from above.
        neighbours: For each taxel the indices of the taxels that share an edge with it.
        areas: Cell areas (n,) in m^2.
        outline: Outline (k, 2) of the sole in m, counter-clockwise.
        ids: Taxel ids (n,), unique.
        cell_shape: One of CELL_SHAPES.
        cell_area: Area of one whole cell in m^2 (the median where sizes are mixed).
        modalities: What each taxel senses, out of MODALITIES.
        ranges: Sensing range (low, high) of each modality in SI.
        thresholds: Activation threshold of each modality in SI.

    Raises:
        LayoutError: If a field is not valid; the message names it.

    Example:
        >>> from plantar import grid_layout
        >>> layout = grid_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]], pitch=(0.1, 0.1))
        >>> layout.positions.round(9).tolist(), layout.neighbours, round(layout.sole_area, 9)
        ([[0.05, 0.05, 0.0], [0.15, 0.05, 0.0]], ((1,), (0,)), 0.02)
    """

    name: str
    side: Side
    positions: NDArray[np.float64]
    rotations: NDArray[np.float64]
    vertices: NDArray[np.float64]
    corners: tuple[tuple[int, ...], ...]
    neighbours: tuple[tuple[int, ...], ...]
    areas: NDArray[np.float64]
    outline: NDArray[np.float64]
    ids: NDArray[np.int64]
    cell_shape: str = "hexagon"
    cell_area: float = 691e-6
    modalities: tuple[str, ...] = ("force", "proximity")
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=lambda: dict(DEFAULT_RANGES))
    thresholds: Mapping[str, float] = field(default_factory=lambda: dict(DEFAULT_THRESHOLDS))

    def __post_init__(self) -> None:
        n = len(self.corners)
        shapes: dict[str, tuple[int | None, ...]] = {
            "positions": (n, 3),
            "rotations": (n, 3, 3),
            "vertices": (None, 3),
            "areas": (n,),
            "outline": (None, 2),
            "ids": (n,),
        }
        for name, shape in shapes.items():
            wanted = np.int64 if name == "ids" else np.float64
            try:
                array = np.array(getattr(self, name), dtype=wanted)
            except (TypeError, ValueError, OverflowError):
                raise LayoutError(f"layout field '{name}' is not numeric") from None
            if array.size == 0 and n == 0:
                array = array.reshape([0 if s is None else s for s in shape])
            if array.ndim != len(shape) or any(
                s is not None and s != a for s, a in zip(shape, array.shape, strict=True)
            ):
                text = "(" + ", ".join("any" if s is None else str(s) for s in shape) + ")"
                raise LayoutError(f"layout field '{name}' has shape {array.shape}; expected {text}")
            if wanted is np.float64 and not np.isfinite(array).all():
                raise LayoutError(f"layout field '{name}' holds a value that is not finite")
            if name in ("positions", "vertices", "outline") and np.abs(array).max(initial=0.0) > LARGEST_COORDINATE:
                raise LayoutError(
                    f"layout field '{name}' reaches {np.abs(array).max():.3g} m; "
                    f"allowed: within {LARGEST_COORDINATE:.0f} m of the origin"
                )
            array.flags.writeable = False
            object.__setattr__(self, name, array)
        self._check(n)

    def _check(self, n: int) -> None:
        if self.side not in ("left", "right"):
            raise LayoutError(f"layout field 'side' is {self.side!r}; allowed: left, right")
        if len(np.unique(self.ids)) != n:
            raise LayoutError("layout field 'ids' holds an id twice; every taxel needs its own")
        if len(self.neighbours) != n:
            raise LayoutError(f"layout field 'neighbours' has {len(self.neighbours)} rows; expected {n}")
        if not ((self.areas > 0.0) & (self.areas <= 1.0)).all():
            raise LayoutError("layout field 'areas' holds an area that is not above 0 and up to 1 m^2")
        if not 0.0 < self.cell_area <= 1.0:
            raise LayoutError(f"layout field 'cell_area' is {self.cell_area} m^2; allowed: above 0 and up to 1 m^2")
        if len(self.outline) < 3:
            raise LayoutError(f"layout field 'outline' has {len(self.outline)} points; expected 3 or more")
        if not self.sole_area > 0.0:
            raise LayoutError("layout field 'outline' encloses no area")
        if self.cell_shape not in CELL_SHAPES:
            raise LayoutError(f"layout field 'cell_shape' is {self.cell_shape!r}; allowed: {', '.join(CELL_SHAPES)}")
        for i, (corner, near) in enumerate(zip(self.corners, self.neighbours, strict=True)):
            if len(corner) < 3:
                raise LayoutError(f"layout field 'corners' of taxel {i} has {len(corner)} points; expected 3 or more")
            if min(corner) < 0 or max(corner) >= len(self.vertices):
                raise LayoutError(f"layout field 'corners' of taxel {i} names a vertex that does not exist")
            if len(set(corner)) != len(corner):
                raise LayoutError(f"layout field 'corners' of taxel {i} names a vertex twice")
            if any(not 0 <= j < n or j == i for j in near):
                raise LayoutError(f"layout field 'neighbours' of taxel {i} names itself or a taxel that does not exist")
            if any(i not in self.neighbours[j] for j in near):
                raise LayoutError(f"layout field 'neighbours' of taxel {i} names a taxel that does not name it back")
        rotations = np.clip(self.rotations, -2.0, 2.0)  # no rotation holds more than 1; the square stays finite
        gram = np.einsum("nij,nkj->nik", rotations, rotations) - np.eye(3)
        if n and (np.abs(gram).max() > 1e-6 or (np.linalg.det(rotations) < 0).any()):
            raise LayoutError("layout field 'rotations' holds a matrix that is not a rotation")
        for name in self.modalities:
            if name not in MODALITIES:
                raise LayoutError(f"layout field 'modalities' holds {name!r}; allowed: {', '.join(MODALITIES)}")
        for name, (low, high) in self.ranges.items():
            if not (math.isfinite(low) and math.isfinite(high) and low < high):
                raise LayoutError(f"layout field 'ranges.{name}' is [{low}, {high}]; allowed: finite, low below high")
        for name, value in self.thresholds.items():
            if not (math.isfinite(value) and value >= 0.0):
                raise LayoutError(f"layout field 'thresholds.{name}' is {value}; allowed: finite, 0 or more")

    def __reduce__(self) -> tuple[Any, ...]:
        # Copies and pickles carry the fields; what was computed from them, compiled kernels too, is made anew.
        values = (getattr(self, item.name) for item in fields(self))
        return type(self), tuple(dict(v) if isinstance(v, Mapping) else v for v in values)

    def __len__(self) -> int:
        return len(self.corners)

    @property
    def force_threshold(self) -> float:
        """Force in N at which a taxel counts as active (epsilon_f of T 4.22)."""
        return float(self.thresholds.get("force", DEFAULT_THRESHOLDS["force"]))

    @property
    def force_limit(self) -> float:
        """Force in N from which a taxel is saturated: the upper end of its range; inf where the range is not stated."""
        return float(self.ranges["force"][1]) if "force" in self.ranges else math.inf

    @property
    def proximity_threshold(self) -> float:
        """Distance in m below which a taxel counts as near (epsilon_p of T 4.2.7)."""
        return float(self.thresholds.get("proximity", DEFAULT_THRESHOLDS["proximity"]))

    @property
    def proximity_range(self) -> float:
        """Distance in m up to which proximity senses (d_range of T 3.30)."""
        return float(self.ranges.get("proximity", DEFAULT_RANGES["proximity"])[1])

    @property
    def temperature_threshold(self) -> float:
        """Temperature in degC from which a taxel is warm (kappa_0 of T 3.34)."""
        return float(self.thresholds.get("temperature", DEFAULT_THRESHOLDS["temperature"]))

    @cached_property
    def sole_area(self) -> float:
        """Area A_s of the sole's outline in m^2."""
        x, y = (self.outline - self.outline[0]).T
        return 0.5 * abs(float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))))

    @cached_property
    def is_flat(self) -> bool:
        """Whether every taxel's axes are those of the sole frame."""
        return bool((self.rotations == np.eye(3)).all())

    @cached_property
    def corner_start(self) -> NDArray[np.int64]:
        """Offsets (n + 1,) of each taxel's corners in `corner_vertex`."""
        return np.concatenate([[0], np.cumsum([len(c) for c in self.corners])]).astype(np.int64)

    @cached_property
    def corner_vertex(self) -> NDArray[np.int64]:
        """Vertex indices of all corners, taxel by taxel."""
        return np.array([i for c in self.corners for i in c], dtype=np.int64)

    @cached_property
    def wrench_map(self) -> NDArray[np.float64]:
        """Matrix (6, n) that takes taxel normal forces to the wrench at the sole frame's origin (T 4.23)."""
        normal = self.rotations[:, :, 2]
        out = np.vstack([normal.T, np.cross(self.positions, normal).T])
        out.flags.writeable = False
        return out

    @cached_property
    def kernel(self) -> SoleKernel:
        """What the kernels of loads and support polygons keep of this sole."""
        return SoleKernel(
            self.positions,
            self.rotations[:, :, 2],
            self.areas,
            self.vertices[:, :2],
            self.corner_start,
            self.corner_vertex,
        )

    def cell_polygon(self, taxel: int) -> NDArray[np.float64]:
        """Corners (k, 2) of one cell in the sole plane in m, counter-clockwise."""
        return self.vertices[list(self.corners[taxel]), :2]


def mirrored(layout: SoleLayout) -> SoleLayout:
    """The same sole for the other foot: y changes sign, ids stay.

    Args:
        layout: Layout of one side.

    Returns:
        Layout of the other side; taxel i of one is the mirror image of taxel i of the other.

    Example:
        >>> from plantar import hex_layout
        >>> left = hex_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]])
        >>> right = mirrored(left)
        >>> right.side, bool((right.positions[:, 1] == -left.positions[:, 1]).all())
        ('right', True)
    """
    flip = np.array([1.0, -1.0, 1.0])
    return SoleLayout(
        name=layout.name,
        side="right" if layout.side == "left" else "left",
        positions=layout.positions * flip,
        rotations=layout.rotations * np.outer(flip, flip),
        vertices=layout.vertices * flip,
        corners=tuple((c[0], *reversed(c[1:])) for c in layout.corners),
        neighbours=layout.neighbours,
        areas=layout.areas,
        outline=(layout.outline * flip[:2])[::-1],
        ids=layout.ids,
        cell_shape=layout.cell_shape,
        cell_area=layout.cell_area,
        modalities=layout.modalities,
        ranges=layout.ranges,
        thresholds=layout.thresholds,
    )
