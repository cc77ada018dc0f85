"""Feet that the shoe tests generate, and one shoe built and exported for all of them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from shoes import Foot, ShoeReport, build_shoe, export_shoe, foot_from_dimensions

Triangles = NDArray[np.float64]


def _prism(outline: NDArray[np.float64], low: float, high: float) -> Triangles:
    """Closed surface (n, 3, 3) of a star-shaped outline (k, 2) between two heights."""
    ring = np.asarray(outline, dtype=float)
    after = np.roll(ring, -1, axis=0)
    centre = ring.mean(axis=0)

    def at(points: NDArray[np.float64], z: float) -> NDArray[np.float64]:
        return np.column_stack([points, np.full(len(points), z)])

    middle = np.broadcast_to(centre, ring.shape)
    return np.concatenate(
        [
            np.stack([at(middle, high), at(ring, high), at(after, high)], axis=1),
            np.stack([at(middle, low), at(after, low), at(ring, low)], axis=1),
            np.stack([at(ring, low), at(after, low), at(after, high)], axis=1),
            np.stack([at(ring, low), at(after, high), at(ring, high)], axis=1),
        ]
    )


def _box(x: tuple[float, float], y: tuple[float, float], z: tuple[float, float]) -> Triangles:
    """Closed surface (12 or more, 3, 3) of a box."""
    return _prism(np.array([[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]]), *z)


@pytest.fixture(scope="session")
def prism() -> Callable[..., Triangles]:
    """Makes the closed surface of a prism from its outline (k, 2) and two heights."""
    return _prism


@pytest.fixture(scope="session")
def box() -> Callable[..., Triangles]:
    """Makes the closed surface of a box from its extents along x, y and z."""
    return _box


@pytest.fixture
def stl(tmp_path: Path) -> Callable[..., Path]:
    """Writes triangles to an STL file and gives its path."""
    from shoes.stl import write_stl

    def write(triangles: Triangles, name: str = "foot.stl") -> Path:
        with np.errstate(invalid="ignore"):  # a test may write what is not finite
            return write_stl(triangles, tmp_path / name)

    return write


@pytest.fixture(scope="session")
def small_foot() -> Foot:
    """A foot of 120 x 70 mm, its middle 15 mm before and 5 mm left of the ankle."""
    return foot_from_dimensions("small", length=0.12, width=0.07, sole_center=(0.015, 0.005), corner_radius=0.01)


@pytest.fixture(scope="session")
def exported(small_foot: Foot, tmp_path_factory: pytest.TempPathFactory) -> tuple[ShoeReport, Path]:
    """Both shoes of the small foot, built and exported once; and the folder they are in."""
    folder = tmp_path_factory.mktemp("shoe")
    return export_shoe(build_shoe(small_foot), folder), folder
