"""Binary STL, written and read with the same bytes for the same triangles."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

__all__ = ["read_stl", "write_stl"]

_HEADER = b"plantar shoe, mm, z = 0 is the contact face".ljust(80)
_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def write_stl(triangles: NDArray[np.float64], path: str | os.PathLike[str]) -> Path:
    """Write triangles (n, 3, 3) in mm, outward counter-clockwise, to a path as binary STL; returns the path."""
    corners = np.asarray(triangles, dtype="<f4")
    normal = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    record = np.zeros(len(corners), dtype=_RECORD)
    record["normal"] = np.divide(normal, length, out=np.zeros_like(normal), where=length > 0.0) + 0.0
    record["corners"] = corners
    file = Path(path)
    file.write_bytes(_HEADER + np.array([len(corners)], dtype="<u4").tobytes() + record.tobytes())
    return file


def read_stl(path: str | os.PathLike[str]) -> NDArray[np.float64]:
    """Triangles (n, 3, 3) in mm of a binary STL that `write_stl` wrote."""
    record = np.frombuffer(Path(path).read_bytes(), dtype=_RECORD, offset=84)
    return np.asarray(record["corners"], dtype=float)
