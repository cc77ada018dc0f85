"""Soles and readings that try to break the perception: lattices, clipped and mixed cells, faults, odd forces."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.layouts.cell_layout import joined_layout, layout_of_cells
from plantar.layouts.curved_sole import laid_over
from plantar.layouts.hex_lattice import HexLattice
from plantar.layouts.layout import SoleLayout, mirrored
from plantar.layouts.tiling import grid_layout, hex_layout
from plantar.percepts.percept import Percept
from plantar.percepts.sole_pose import SolePose
from plantar.sensing.reading import Reading

from ..sample_soles import foot_outline, sole_of

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_STRONG = {"force": (0.0, 1e12), "proximity": (0.0, 0.05), "temperature": (0.0, 60.0)}
"""Ranges of a sole that 1e9 N do not saturate."""


@dataclass(frozen=True, eq=False)
class Block:
    """Readings of one sole; n taxels.

    Attributes:
        layout: The sole.
        force: Forces (readings, n) in N.
        proximity: Distances (readings, n) in m.
        temperature: Temperatures (readings, n) in degC.
        acceleration: Accelerations (readings, n, 3) in m/s^2.
        pose: Where the sole is.
        rng: For what a check draws at random.
        number: Which block it is.
    """

    layout: SoleLayout
    force: Array
    proximity: Array
    temperature: Array
    acceleration: Array
    pose: SolePose
    rng: np.random.Generator
    number: int

    def __len__(self) -> int:
        return len(self.force)

    @cached_property
    def active(self) -> Mask:
        """What should be active (readings, n), said in another way than `active_taxels` does."""
        finite = np.isfinite(self.force)
        known = np.where(finite, self.force, -1.0)
        return finite & ~(known <= self.layout.force_threshold) & ~(known >= self.layout.force_limit)

    @cached_property
    def wrenches(self) -> tuple[Array, Array]:
        """Wrenches (readings, 6) in extended precision, and the sums of the terms' absolute values."""
        kept = np.where(self.active, self.force, 0.0).astype(np.longdouble)
        columns = unit_wrenches(self.layout).astype(np.longdouble)
        return np.asarray(kept @ columns, dtype=float), np.asarray(np.abs(kept) @ np.abs(columns), dtype=float)

    @cached_property
    def readings(self) -> list[Reading]:
        """The readings, some without proximity, temperature or acceleration."""
        return [
            Reading(
                0.001 * i,
                self.force[i],
                self.proximity[i] if i % 16 else None,
                self.temperature[i] if i % 16 else None,
                self.acceleration[i] if i % 16 else None,
            )
            for i in range(len(self))
        ]

    @cached_property
    def percepts(self) -> list[Percept]:
        """A percept a reading."""
        return [Percept(self.layout, reading) for reading in self.readings]


def check(name: str, block: Block, errors: ArrayLike, bound: float = 0.0) -> None:
    """Assert that errors of one function on one block are within a bound; NaN is beyond every bound."""
    values = np.asarray(errors, dtype=float).reshape(-1)
    bad = np.flatnonzero(~(values <= bound))
    found = f"value {bad[:1]} of {len(values)}: error {values[bad[:1]]}"
    assert not bad.size, f"{name}: sole '{block.layout.name}', {found}, allowed {bound:.3g}"


def numbers(value: Any) -> Array:
    """The floating point numbers in an array, a float, what has `points`, or a list of such, flat."""
    if isinstance(value, tuple | list):
        return np.concatenate([np.empty(0), *map(numbers, value)])
    values = np.asarray(getattr(value, "points", value))
    return values.ravel() if values.dtype.kind == "f" else np.empty(0)


def not_finite(values: Sequence[Any]) -> list[bool]:
    """Of which results a number is not finite."""
    return [not np.isfinite(numbers(value)).all() for value in values]


def differing(one: Sequence[Any], other: Sequence[Any], equal_nan: bool = False) -> list[bool]:
    """Which of two lists' arrays differ to the last bit; None differs from an array."""
    pairs = [(a, b) for a, b in zip(one, other, strict=True)]
    return [
        (a is None) != (b is None) or (a is not None and not np.array_equal(a, b, equal_nan=equal_nan))
        for a, b in pairs
    ]


@cache
def unit_wrenches(layout: SoleLayout) -> Array:
    """Wrench of 1 N on each taxel of a sole, one cross product at a time."""
    out = np.empty((len(layout), 6))
    for i, (place, turn) in enumerate(zip(layout.positions, layout.rotations, strict=True)):
        normal = turn @ [0.0, 0.0, 1.0]
        out[i] = [*normal, *np.cross(place, normal)]
    return out


def stress_soles() -> list[SoleLayout]:
    """The soles: small ones first, since they meet every pattern of activity."""
    box = [[-0.06, -0.04], [0.06, -0.04], [0.06, 0.04], [-0.06, 0.04]]
    rows3 = np.array([(column - row // 2, row) for row in range(3) for column in range(3)])
    rows4 = np.array([(column - row // 2, row) for row in range(3) for column in range(4)])
    soles = [
        hex_layout(box, name="3 rows of 3", cells=rows3),
        hex_layout(box, name="3 rows of 3, turned", cells=rows3, angle=0.3, origin=(0.01, -0.003)),
        hex_layout(box, name="3 rows of 4, far", cells=rows4, angle=math.pi / 6, origin=(40.0, -40.0)),
        hex_layout(box, name="3 rows of 3, tiny", cell_area=1e-12, cells=rows3),
        grid_layout(box, name="squares", pitch=(0.03, 0.02)),
        grid_layout(box, name="squares, turned", pitch=(0.025, 0.025), angle=math.pi / 4),
        hex_layout(foot_outline(0.14, 0.09), name="clipped", minimum_fraction=0.05, angle=0.1),
        joined_layout(
            [
                hex_layout([[-0.08, -0.03], [0, -0.03], [0, 0.03], [-0.08, 0.03]], minimum_fraction=0.2),
                grid_layout([[0, -0.03], [0.05, -0.03], [0.05, 0.03], [0, 0.03]], pitch=(0.025, 0.02)),
            ],
            name="mixed",
        ),
        layout_of_cells([HexLattice(691e-6).corners(np.array([[0, 0]]))[0]], name="one cell"),
        sole_of(51),
    ]
    turned = soles[1]
    soles.append(mirrored(soles[6]))
    soles.append(laid_over(soles[0], lambda x, y: 1.5 * x * x - y * y))
    clockwise = tuple((c[0], *reversed(c[1:])) if i % 2 else c for i, c in enumerate(turned.corners))
    soles.append(replace(turned, name="clockwise cells", corners=clockwise, ranges=_STRONG))
    soles.append(replace(soles[0], name="3 rows of 3, strong", ranges=_STRONG, thresholds={"force": 0.0}))
    return soles


def block_of(layout: SoleLayout, count: int, seed: int, number: int) -> Block:
    """A block of readings."""
    rng, first = np.random.default_rng([seed, number]), number * count
    n = len(layout)
    if n <= 12:  # every pattern in turn
        pattern = (np.arange(first, first + count)[:, None] >> np.arange(n)) & 1 == 1
    else:
        pattern = rng.random((count, n)) < rng.choice([0.02, 0.1, 0.3, 0.5, 0.8, 1.0], (count, 1))
    scale = rng.choice([1e-12, 2.0, 20.0, 200.0, 1e9], (count, 1), p=[0.05, 0.2, 0.4, 0.3, 0.05])
    force = np.where(pattern, scale * rng.uniform(0.9, 3.0, (count, n)), 0.0)
    kind = rng.integers(0, 16, count)
    force[kind == 0] = 0.0
    one = kind == 1
    force[one] = 0.0
    force[one, rng.integers(0, n, int(one.sum()))] = 60.0
    force[kind == 2] += rng.normal(0.0, 1.0, (int((kind == 2).sum()), n))  # drift of both signs
    faults = (kind == 3)[:, None] & (rng.random((count, n)) < 0.3)
    force[faults] = rng.choice([np.nan, np.inf, -np.inf, 785.0, -5.0], int(faults.sum()))
    force[kind == 4] = rng.choice([np.nan, np.inf, -np.inf, 1e300, -0.0], (int((kind == 4).sum()), 1))
    plane = (
        rng.uniform(-0.01, 0.05, (count, 1))
        + rng.uniform(-0.5, 0.5, (count, 2)) @ (layout.positions[:, :2] - layout.positions[:, :2].mean(axis=0)).T
    )
    proximity = plane + rng.choice([0.0, 1e-4, 0.02], (count, 1)) * rng.normal(size=(count, n))
    odd = rng.random((count, n)) < rng.choice([0.0, 0.1, 0.9], (count, 1))
    proximity[odd] = rng.choice([np.nan, np.inf, -np.inf, 0.0, 1e300, 1e-300], int(odd.sum()))
    temperature = rng.uniform(15.0, 70.0, (count, n))
    temperature[odd] = rng.choice([np.nan, np.inf, -np.inf, 31.0, 1e300], int(odd.sum()))
    acceleration = rng.normal(0.0, 10.0, (count, n, 3))
    acceleration[odd[:, :, None] & (rng.random((count, n, 3)) < 0.2)] = np.nan
    reach = 1e6 if number % 3 == 2 else 1.0
    x, y, z = (reach * rng.uniform(-1.0, 1.0, 3)).tolist()
    pose = SolePose.flat(x, y, z, yaw=float(rng.uniform(-3.2, 3.2)))
    return Block(layout, force, proximity, temperature, acceleration, pose, rng, number)
