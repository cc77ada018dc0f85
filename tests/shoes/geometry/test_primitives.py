"""Tests of simple shapes: their size and volume."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.errors import FootError
from plantar.shoes.geometry.primitives import primitive
from plantar.shoes.solid.pad import volume_of


@pytest.mark.parametrize(
    ("kind", "size", "half", "volume"),
    [
        ("box", [1.0, 2.0, 3.0], [1.0, 2.0, 3.0], 48.0),
        ("sphere", [2.0], [2.0, 2.0, 2.0], 4 / 3 * np.pi * 8),
        ("cylinder", [2.0, 3.0], [2.0, 2.0, 3.0], np.pi * 4 * 6),
        ("capsule", [2.0, 3.0], [2.0, 2.0, 5.0], np.pi * 4 * 6 + 4 / 3 * np.pi * 8),
        ("ellipsoid", [1.0, 2.0, 3.0], [1.0, 2.0, 3.0], 4 / 3 * np.pi * 6),
    ],
)
def test_shapes_have_their_size(kind: str, size: list[float], half: list[float], volume: float) -> None:
    triangles = primitive(kind, np.array(size), "g")
    points = triangles.reshape(-1, 3)
    np.testing.assert_allclose(points.max(axis=0), half, rtol=1e-2)
    np.testing.assert_allclose(points.min(axis=0), -np.array(half), rtol=1e-2)
    assert volume_of(triangles) == pytest.approx(volume, rel=0.03)


def test_what_is_no_shape_is_refused() -> None:
    for kind, size in (("torus", [1.0, 1.0]), ("box", [1.0, 1.0]), ("sphere", [0.0]), ("capsule", [1.0, np.nan])):
        with pytest.raises(FootError, match=r"^g: "):
            primitive(kind, np.array(size), "g")
