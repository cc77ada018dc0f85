"""Tests of the STL file: the bytes, and what another reader makes of them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import trimesh
from numpy.typing import NDArray

from plantar.shoes.papers.stl import read_stl, write_stl


def test_triangles_come_back_and_bytes_repeat(tmp_path: Path, box: Callable[..., NDArray[np.float64]]) -> None:
    triangles = box((-10.5, 20), (0, 3), (1, 2))
    first, second = write_stl(triangles, tmp_path / "a.stl"), write_stl(triangles, tmp_path / "b.stl")
    assert first.read_bytes() == second.read_bytes()
    np.testing.assert_array_equal(read_stl(first), triangles.astype(np.float32))
    mesh = trimesh.load(first, force="mesh")
    assert mesh.is_watertight
    assert mesh.volume == 30.5 * 3
    normals = np.frombuffer(first.read_bytes(), np.uint8, offset=84).reshape(-1, 50)[:, :12].copy().view("<f4")
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0)
    assert len(first.read_bytes()) == 84 + 50 * len(triangles)


def test_a_triangle_without_area_has_no_normal(tmp_path: Path) -> None:
    path = write_stl(np.zeros((1, 3, 3)), tmp_path / "flat.stl")
    assert (read_stl(path) == 0).all()
