"""Sole layout: where the taxels of one sole are.

The sole frame lies on the outer contact face, x forward, y left, z up. A taxel's z axis points into the body: the world
exerts [0, 0, f] on it, f >= 0.
"""

import math
import operator
from collections.abc import ItemsView, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.arguments import instance, integer, items, number
from plantar.common.arrays import array, integers, numbers, own, read_only
from plantar.common.sides import SIDES, Side, other_side
from plantar.errors import LayoutError
from plantar.kernels.skin.sole import SoleKernel
from plantar.layouts.calibration import SoleCalibration
from plantar.layouts.contact_levels import ContactLevels, contact_levels
from plantar.layouts.source_pose import SourcePose
from plantar.mechanics.lip import GRAVITY

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

MODALITIES: tuple[str, ...] = ("force", "proximity", "temperature", "acceleration")
"""What a taxel can sense (T 4.2.1)."""

DEFAULT_RANGES: Mapping[str, tuple[float, float]] = {
    "force": (0.0, 785.0),
    "proximity": (0.0, 0.05),
    "temperature": (0.0, 60.0),
    "acceleration": (-19.62, 19.62),
}
"""Sensing range of each modality in N, m, degC and m/s^2: 80 kg a taxel (T 4.2.1), 50 mm of proximity. Nature: T 4.2.1
(corrected: 785 N on 691 mm2 are 1.1 MPa)."""

CELL_SHAPES: tuple[str, ...] = ("hexagon", "rectangle", "polygon", "mixed")
"""What a layout's cells are; clipped cells keep the name of the whole cell."""

LARGEST_COORDINATE = 50.0
"""Derived: largest coordinate of a layout in m: a sole in millimetres is found out, a long walkway is not."""

DEFAULT_THRESHOLDS: Mapping[str, float] = {"force": 0.15 * GRAVITY, "proximity": 0.05, "temperature": 31.0}
"""Nature: activation thresholds: 0.15 kg of force (T Table 2) in N, the proximity range in m, and 31 degC (T
3.3.2.1)."""


@dataclass(frozen=True, eq=False, repr=False)
class SoleLayout:
    """The taxels of one sole, copied and read-only; n taxels, v vertices.

    Attributes:
        side: "left" or "right".
        positions: Taxel centers (n, 3) in sole frame in m.
        rotations: Rotations (n, 3, 3) from each taxel's frame to the sole's.
        vertices: Corner points (v, 3) in sole frame in m, shared between cells that meet.
        corners: Each taxel's corner indices in `vertices`, counter-clockwise from above.
        neighbours: Indices of taxels that share an edge with each.
        areas: Cell areas (n,) in m^2.
        outline: Sole outline (k, 2) in m, counter-clockwise.
        ids: Taxel ids (n,), unique.
        cell_shape: One of CELL_SHAPES.
        cell_area: Of one whole cell in m^2 (the median of mixed sizes).
        modalities: Sensed quantities, out of MODALITIES.
        ranges: Sensing range (low, high) of each in SI.
        thresholds: Activation threshold of each in SI.
        pose: Of the sole's frame in the file or link that it came from, if known.
        noise: Standard deviation of a taxel's readings of each in SI, where known. At the layout's own force threshold
            a sole that measures no more than its noise has no active taxel (`contact_levels`).
        calibrations: What turns the counts of each side's taxels into newtons, where they were calibrated; a mirrored
            layout keeps both sides'.

    Raises:
        LayoutError: Invalid field, named in the message.

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
    cell_area: float = 691e-6  # nature: T 4.2.1: 6.9 cm2
    modalities: tuple[str, ...] = ("force", "proximity")
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=lambda: dict(DEFAULT_RANGES))
    thresholds: Mapping[str, float] = field(default_factory=lambda: dict(DEFAULT_THRESHOLDS))
    pose: SourcePose | None = None
    noise: Mapping[str, float] = field(default_factory=dict)
    calibrations: Mapping[Side, SoleCalibration] = field(default_factory=dict)

    def __post_init__(self) -> None:
        kept = self.__dict__  # past what keeps others from assigning
        kept["corners"] = _index_rows("corners", self.corners)
        kept["neighbours"] = _index_rows("neighbours", self.neighbours)
        n = len(self.corners)
        shapes: dict[str, tuple[int | str, ...]] = {
            "positions": (n, 3),  # nature: points of space
            "rotations": (n, 3, 3),  # nature: rotations of space
            "vertices": ("any", 3),  # nature: points of space
            "areas": (n,),
            "outline": ("any", 2),
        }
        for name, shape in shapes.items():
            what = f"layout field '{name}'"
            given = numbers(getattr(self, name), what, LayoutError)
            if n == 0 and given.size == 0:
                given = np.empty([0 if isinstance(s, str) else s for s in shape])
            kept[name] = own(array(given, what, shape, LayoutError))
            if not np.isfinite(kept[name]).all():
                raise LayoutError(f"{what} holds a value that is not finite")
            far = float(np.abs(kept[name]).max(initial=0.0))
            if name in ("positions", "vertices", "outline") and far > LARGEST_COORDINATE:
                raise LayoutError(
                    f"{what} reaches {far:.3g} m; allowed: within {LARGEST_COORDINATE:.0f} m of the origin"
                )
        kept["ids"] = read_only(integers(self.ids, "layout field 'ids'", (n,), LayoutError).copy())
        kept["cell_area"] = number(self.cell_area, "layout field 'cell_area'", LayoutError, nan=True)
        kept["modalities"] = items(self.modalities, "layout field 'modalities'", LayoutError)
        kept["ranges"] = MappingProxyType(
            {
                name: tuple(array(span, f"layout field 'ranges.{name}'", (2,), LayoutError).tolist())
                for name, span in _named("ranges", self.ranges)
            }
        )
        for table in ("thresholds", "noise"):
            kept[table] = MappingProxyType(
                {
                    name: number(level, f"layout field '{table}.{name}'", LayoutError, nan=True)
                    for name, level in _named(table, getattr(self, table))
                }
            )
        self._check(n)

    def _check(self, n: int) -> None:
        instance(self.name, str, "layout field 'name'", LayoutError)
        if self.pose is not None:
            instance(self.pose, SourcePose, "layout field 'pose'", LayoutError)
        kept = self.__dict__
        kept["calibrations"] = MappingProxyType(dict(_named("calibrations", self.calibrations)))
        for side, known in self.calibrations.items():
            if side not in SIDES:
                raise LayoutError(f"layout field 'calibrations' names {side!r}; allowed: left, right")
            if len(instance(known, SoleCalibration, f"layout field 'calibrations.{side}'", LayoutError)) != n:
                raise LayoutError(f"layout field 'calibrations.{side}' is of {len(known)} taxels; expected {n}")
        if self.side not in SIDES:
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
        # nature: floating point of single precision, in which a file may hold a rotation
        if n and (np.abs(gram).max() > 1e-6 or (np.linalg.det(rotations) < 0).any()):
            raise LayoutError("layout field 'rotations' holds a matrix that is not a rotation")
        for name in self.modalities:
            if name not in MODALITIES:
                raise LayoutError(f"layout field 'modalities' holds {name!r}; allowed: {', '.join(MODALITIES)}")
        for name, (low, high) in self.ranges.items():
            if not (math.isfinite(low) and math.isfinite(high) and low < high):
                raise LayoutError(f"layout field 'ranges.{name}' is [{low}, {high}]; allowed: finite, low below high")
        for table in ("thresholds", "noise"):
            for name, value in getattr(self, table).items():
                if not (math.isfinite(value) and value >= 0.0):
                    raise LayoutError(f"layout field '{table}.{name}' is {value}; allowed: finite, 0 or more")

    def __reduce__(self) -> tuple[Any, ...]:
        # Copies and pickles carry the fields; what was computed from them, compiled kernels too, is made again.
        values = (getattr(self, item.name) for item in fields(self))
        return type(self), tuple(dict(v) if isinstance(v, Mapping) else v for v in values)

    def __len__(self) -> int:
        return len(self.corners)

    def __repr__(self) -> str:
        length, width = np.ptp(self.outline, axis=0)
        return f"<SoleLayout '{self.name}', {self.side}: {len(self)} taxels on {length:.3f} x {width:.3f} m>"

    @cached_property
    def force_threshold(self) -> float:
        """Force in N of an active taxel (epsilon_f of T 4.22)."""
        return float(self.thresholds.get("force", DEFAULT_THRESHOLDS["force"]))

    @property
    def calibration(self) -> SoleCalibration | None:
        """What turns this side's counts into newtons; None if it was not calibrated."""
        return self.calibrations.get(self.side)

    @cached_property
    def contact_levels(self) -> ContactLevels:
        """Forces in N that a sole without contact stays below, by its noise; 0 where that is not known."""
        return contact_levels(float(self.noise.get("force", 0.0)), len(self))

    @cached_property
    def force_limit(self) -> float:
        """Force in N of a saturated taxel; inf without a range."""
        return float(self.ranges["force"][1]) if "force" in self.ranges else math.inf

    @property
    def proximity_threshold(self) -> float:
        """Distance in m of a near taxel (epsilon_p of T 4.2.7)."""
        return float(self.thresholds.get("proximity", DEFAULT_THRESHOLDS["proximity"]))

    @property
    def proximity_range(self) -> float:
        """Sensing range in m of proximity (d_range of T 3.30)."""
        return float(self.ranges.get("proximity", DEFAULT_RANGES["proximity"])[1])

    @property
    def temperature_threshold(self) -> float:
        """Temperature in degC of a warm taxel (kappa_0 of T 3.34)."""
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
    def is_level(self) -> bool:
        """Whether taxels and corners all lie in the plane z = 0."""
        return not (self.positions[:, 2].any() or self.vertices[:, 2].any())

    @cached_property
    def corner_start(self) -> NDArray[np.int64]:
        """Offsets (n + 1,) of taxels' corners in `corner_vertex`."""
        return read_only(np.concatenate([[0], np.cumsum([len(c) for c in self.corners])]).astype(np.int64))

    @cached_property
    def corner_vertex(self) -> NDArray[np.int64]:
        """Vertex indices of all corners, taxel by taxel."""
        return read_only(np.array([i for c in self.corners for i in c], dtype=np.int64))

    @cached_property
    def wrench_map(self) -> NDArray[np.float64]:
        """Matrix (6, n) from taxel forces to the wrench at the sole origin (T 4.23)."""
        normal = self.rotations[:, :, 2]
        return read_only(np.vstack([normal.T, np.cross(self.positions, normal).T]))

    @cached_property
    def kernel(self) -> SoleKernel:
        """The kernels' data of this sole."""
        return SoleKernel(
            self.positions,
            self.rotations[:, :, 2],
            self.areas,
            self.vertices[:, :2],
            self.corner_start,
            self.corner_vertex,
            self.force_threshold,
            self.force_limit,
            *self.contact_levels,
        )

    def cell_polygon(self, taxel: int) -> NDArray[np.float64]:
        """Corners (k, 2) of one cell, sole plane in m, counter-clockwise."""
        return self.vertices[list(self.corners[integer(taxel, "taxel", 0, len(self.corners) - 1)]), :2]

    def cell_rings(self, cells: Sequence[int] | NDArray[np.int64]) -> NDArray[np.float64]:
        """Corners (n, c, 2) of some cells, sole plane in m; the last is repeated where a cell has fewer than c."""
        first = self.corner_start[cells]
        last = self.corner_start[np.asarray(cells) + 1] - 1
        at = np.minimum(first[:, None] + np.arange(int((last - first).max(initial=0)) + 1), last[:, None])
        return np.asarray(self.vertices[self.corner_vertex[at], :2])


def mirrored(layout: SoleLayout) -> SoleLayout:
    """Same sole for the other foot: y changes sign, order stays; it has no pose, since it came from no file.

    Args:
        layout: Layout of one side.

    Raises:
        InputError: Not a layout.

    Example:
        >>> from plantar import hex_layout
        >>> left = hex_layout([[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]])
        >>> right = mirrored(left)
        >>> right.side, bool((right.positions[:, 1] == -left.positions[:, 1]).all())
        ('right', True)
    """
    instance(layout, SoleLayout, "layout")
    flip = np.array([1.0, -1.0, 1.0])
    return replace(
        layout,
        side=other_side(layout.side),
        positions=layout.positions * flip,
        rotations=layout.rotations * np.outer(flip, flip),
        vertices=layout.vertices * flip,
        corners=tuple((c[0], *reversed(c[1:])) for c in layout.corners),
        outline=(layout.outline * flip[:2])[::-1],
        pose=None,
    )


def _index_rows(name: str, rows: object) -> tuple[tuple[int, ...], ...]:
    try:
        return tuple(tuple(map(operator.index, row)) for row in rows)  # type: ignore[attr-defined]
    except TypeError:
        raise LayoutError(f"layout field '{name}' is not numeric: expected for each taxel a list of indices") from None


def _named(name: str, values: object) -> ItemsView[str, Any]:
    if not isinstance(values, Mapping) or not all(isinstance(key, str) for key in values):
        raise LayoutError(f"layout field '{name}' is no mapping of names; expected values by modality")
    return values.items()
