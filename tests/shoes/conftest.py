"""Feet that the shoe tests generate, and one shoe built and exported for all of them."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from plantar.shoes import Foot, ShoeReport, build_shoe, export_shoe, foot_from_dimensions

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


def _loft(outlines: list[NDArray[np.float64]], heights: list[float]) -> Triangles:
    """Closed surface of star-shaped outlines (k, 2) of as many points at rising heights."""
    rings = [np.column_stack([o, np.full(len(o), z)]) for o, z in zip(outlines, heights, strict=True)]
    parts = []
    for low, high in pairwise(rings):
        low_next, high_next = np.roll(low, -1, axis=0), np.roll(high, -1, axis=0)
        parts += [np.stack([low, low_next, high_next], axis=1), np.stack([low, high_next, high], axis=1)]
    for ring, up in ((rings[0], False), (rings[-1], True)):
        centre = np.broadcast_to(ring.mean(axis=0), ring.shape)
        fan = np.stack([centre, ring, np.roll(ring, -1, axis=0)], axis=1)
        parts.append(fan if up else fan[:, ::-1])
    return np.concatenate(parts)


def _ellipse(length: float, width: float, x: float = 0.0, power: float = 2.0) -> NDArray[np.float64]:
    """A (super)ellipse (96, 2)."""
    angle = np.linspace(0.0, 2.0 * np.pi, 96, endpoint=False)
    c, s = np.cos(angle), np.sin(angle)
    share = 2.0 / power
    return np.column_stack(
        [x + 0.5 * length * np.sign(c) * abs(c) ** share, 0.5 * width * np.sign(s) * abs(s) ** share]
    )


def _rounded() -> Triangles:
    up = np.radians([0.0, 30.0, 60.0, 90.0])
    radius = 12.0
    inset, height = radius * (1.0 - np.sin(up)), radius * (1.0 - np.cos(up))
    outlines = [_ellipse(230.0 - 2 * d, 100.0 - 2 * d, 25.0, 3.0) for d in inset]
    return _loft([*outlines, outlines[-1]], [*height, 60.0])


def _waist() -> Triangles:
    outline = _ellipse(240.0, 105.0, 20.0, 2.6)
    squeeze = 1.0 - 0.42 * np.exp(-(((outline[:, 0] - 20.0) / 32.0) ** 2))
    return _prism(outline * np.column_stack([np.ones(96), squeeze]), 0.0, 45.0)


def _arched() -> Triangles:
    blocks = [_box((x, x + 10.0), (-45.0, 45.0), (_arch(x + 5.0), 60.0)) for x in range(-90, 150, 10)]
    return np.concatenate(blocks)


def _arch(x: float) -> float:
    return 9.0 * max(0.0, 1.0 - ((x - 25.0) / 65.0) ** 2)


def _generated() -> dict[str, Triangles]:
    toe_out = np.array([[-80, -38], [60, -52], [135, -8], [142, 30], [120, 58], [40, 62], [-75, 34]], dtype=float)
    return {
        "flat_box": _box((-70.0, 130.0), (-45.0, 45.0), (0.0, 55.0)),
        "rounded": _rounded(),
        "arched": _arched(),
        "two_patch": np.concatenate(
            [
                _box((-90.0, -20.0), (-40.0, 40.0), (0.0, 20.0)),
                _box((30.0, 140.0), (-48.0, 48.0), (0.0, 20.0)),
                _box((-90.0, 140.0), (-40.0, 40.0), (15.0, 40.0)),
            ]
        ),
        "far_patches": np.concatenate(
            [
                _box((-130.0, -50.0), (-45.0, 45.0), (0.0, 20.0)),
                _box((40.0, 140.0), (-50.0, 50.0), (0.0, 20.0)),
                _box((-130.0, 140.0), (-40.0, 40.0), (12.0, 50.0)),
            ]
        ),
        "toe_out": _prism(toe_out, 0.0, 70.0),
        "short": _box((-28.0, 52.0), (-26.0, 26.0), (0.0, 25.0)),
        "long": _loft([_ellipse(350.0, 150.0, 45.0, 4.0)] * 2, [0.0, 90.0]),
        "waist": _waist(),
        "flared": _loft([_ellipse(200.0, 85.0, 20.0, 5.0), _ellipse(212.0, 97.0, 20.0, 5.0)], [0.0, 30.0]),
        "plate": np.concatenate(
            [_box((-85.0, 135.0), (-60.0, 60.0), (0.0, 18.0)), _box((-40.0, 40.0), (-30.0, 30.0), (18.0, 120.0))]
        ),
    }


@pytest.fixture(scope="session")
def generated_feet() -> dict[str, Triangles]:
    """Surfaces (n, 3, 3) in mm of feet of many shapes, by name."""
    return _generated()


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
    from plantar.shoes.papers.mesh_files import write_stl

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
