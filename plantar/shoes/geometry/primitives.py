"""Surfaces of the simple shapes of robot models."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FootError
from plantar.optional_library import optional_library

__all__ = ["primitive"]

_SIZES = {"box": 3, "sphere": 1, "cylinder": 2, "capsule": 2, "ellipsoid": 3}


def primitive(kind: str, size: NDArray[np.float64], where: str) -> NDArray[np.float64]:
    """Triangles of a shape about the origin, its axis along z.

    Args:
        kind: "box", "sphere", "cylinder", "capsule" or "ellipsoid".
        size: Half sizes as in MJCF: box and ellipsoid (x, y, z), sphere (radius), cylinder and capsule (radius, half
            length of the straight part).
        where: What it belongs to, for messages.

    Returns:
        Triangles (n, 3, 3), outward counter-clockwise.

    Raises:
        FootError: If there is no such shape, or its size is not above 0.
    """
    if kind not in _SIZES:
        raise FootError(f"{where}: '{kind}' is no shape that is read; allowed: mesh, {', '.join(_SIZES)}")
    count = _SIZES[kind]
    if len(size) < count or not (size[:count] > 0.0).all():
        raise FootError(f"{where}: a {kind} needs {count} sizes above 0")
    with optional_library("trimesh", "shoes"):
        from trimesh import creation
    if kind == "box":
        mesh = creation.box(extents=2.0 * size[:3])
    elif kind == "cylinder":
        mesh = creation.cylinder(radius=size[0], height=2.0 * size[1], sections=48)
    elif kind == "capsule":
        mesh = creation.capsule(radius=size[0], height=2.0 * size[1], count=[24, 24])
        mesh.vertices[:, 2] -= 0.5 * (mesh.vertices[:, 2].max() + mesh.vertices[:, 2].min())
    else:
        mesh = creation.icosphere(subdivisions=3)
        mesh.vertices *= size[:3] if kind == "ellipsoid" else size[0]
    return np.asarray(np.asarray(mesh.vertices, dtype=float)[np.asarray(mesh.faces)])
