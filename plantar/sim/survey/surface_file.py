"""Mesh files that MuJoCo does not read (Collada, text and large STL) as binary STL."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from plantar.errors import DependencyError, RobotError
from plantar.files.input_file import open_input, read_input
from plantar.files.mesh_library import triangles_of_trimesh
from plantar.files.xml_file import parse_xml

__all__ = ["mesh_for_mujoco", "simplified", "stl_bytes"]

_READ_BY_MUJOCO = (".obj", ".msh")
_MOST_BYTES = 400_000_000
_LARGEST = 200_000  # faces of an STL file that MuJoCo reads

Triangles = NDArray[np.float64]


def mesh_for_mujoco(path: Path, folder: Path) -> Path | None:
    """Returns file `path`, one converted into `folder`, or None if unreadable."""
    kind = path.suffix.lower()
    if not path.is_file():
        return None
    if kind in _READ_BY_MUJOCO:
        return path
    try:
        if kind == ".stl" and _is_read_by_mujoco(path):
            return path
        if kind == ".dae":  # refuses entities, and more elements than a mesh has
            parse_xml(read_input(path, RobotError, _MOST_BYTES), RobotError, str(path))
        elif kind != ".stl":
            return None
        triangles = triangles_of_trimesh(path)["triangles"]
    except DependencyError:
        raise
    except Exception:  # of every kind on a damaged file
        return None
    if len(triangles) > _LARGEST:
        triangles = simplified(triangles, 256)
    if not len(triangles):
        return None
    name = f"{path.stem}-{hashlib.sha1(str(path).encode(), usedforsecurity=False).hexdigest()[:8]}.stl"
    (folder / name).write_bytes(stl_bytes(triangles))
    return folder / name


def stl_bytes(triangles: Triangles) -> bytes:
    """Triangles (n, 3, 3) as a binary STL file."""
    record = np.zeros(len(triangles), dtype=[("numbers", "<f4", (4, 3)), ("attribute", "<u2")])
    record["numbers"][:, 1:] = triangles
    return bytes(80) + len(triangles).to_bytes(4, "little") + record.tobytes()


def simplified(triangles: Triangles, cells: int) -> Triangles:
    """Returns fewer `triangles` (n, 3, 3): corners merged on a lattice of `cells` along the longest side.

    Example:
        >>> fine = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 0, 0], [1e-3, 0, 0], [0, 1e-3, 0]]], dtype=float)
        >>> simplified(fine, 10).shape
        (1, 3, 3)
    """
    points = triangles.reshape(-1, 3)
    low = points.min(axis=0)
    cell = max(float((points.max(axis=0) - low).max()) / cells, 1e-12)
    places = np.floor((points - low) / cell + 0.5).astype(np.int64)
    _, first, corner = np.unique(places, axis=0, return_index=True, return_inverse=True)
    faces = corner.reshape(-1, 3)
    faces = faces[(faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])]
    _, kept = np.unique(np.sort(faces, axis=1), axis=0, return_index=True)
    return np.asarray(points[first][faces[np.sort(kept)]])


def _is_read_by_mujoco(path: Path) -> bool:
    """Whether an STL file is a binary one of a number of faces that MuJoCo takes."""
    with open_input(path, RobotError, _MOST_BYTES) as stream:
        count = int.from_bytes(stream.read(84)[80:], "little")
    return 0 < count <= _LARGEST and 84 + 50 * count <= path.stat().st_size
