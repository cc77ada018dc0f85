"""Mesh files that MuJoCo does not read (Collada, text and large STL) as binary STL."""

import hashlib
import json
from collections.abc import Iterable
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from plantar.common.files.gate import read_apart
from plantar.common.files.input_file import check_input, open_input
from plantar.errors import DependencyError, RobotError

_READ_BY_MUJOCO = (".obj", ".msh")
_CONVERTED = (".dae", ".stl")
_MOST_BYTES = 400_000_000
_LARGEST = 200_000  # faces of an STL file that MuJoCo reads

Triangles = NDArray[np.float64]


def meshes_for_mujoco(paths: Iterable[Path], folder: Path, model: Path) -> dict[Path, Path | None]:
    """Returns for each of `paths` itself, a file converted into `folder`, or None if unreadable."""
    found = {path: path if _is_read_by_mujoco(path) else None for path in paths}
    sizes = {path: _size(path) for path, own in found.items() if own is None}
    foreign = [path for path, size in sizes.items() if size]
    if not foreign:
        return found
    if find_spec("trimesh") is None:
        raise DependencyError("trimesh", "sim")
    listed = folder / "meshes.json"
    listed.write_text(json.dumps([str(path.absolute()) for path in foreign]), encoding="utf-8")
    try:
        held = read_apart("meshes", listed, RobotError, sum(sizes.values()))
    except RobotError as error:
        raise RobotError(str(error).replace(str(listed), str(model))) from None
    for i, path in enumerate(foreign):
        triangles = held[str(i)]
        if len(triangles):
            name = f"{path.stem}-{hashlib.sha1(str(path).encode(), usedforsecurity=False).hexdigest()[:8]}.stl"
            found[path] = folder / name
            (folder / name).write_bytes(
                stl_bytes(simplified(triangles, 256) if len(triangles) > _LARGEST else triangles)
            )
    return found


def stl_bytes(triangles: Triangles) -> bytes:
    """Triangles (n, 3, 3) as a binary STL file."""
    record = np.zeros(len(triangles), dtype=[("numbers", "<f4", (4, 3)), ("attribute", "<u2")])
    record["numbers"][:, 1:] = triangles
    return bytes(80) + len(triangles).to_bytes(4, "little") + record.tobytes()


def simplified(triangles: Triangles, cells: int) -> Triangles:
    """Returns fewer `triangles` (n, 3, 3): corners merged on a lattice of `cells` along the longest side."""
    points = triangles.reshape(-1, 3)
    low = points.min(axis=0)
    cell = max(float((points.max(axis=0) - low).max()) / cells, 1e-12)
    places = np.floor((points - low) / cell + 0.5).astype(np.int64)
    first, corner = _distinct(places)
    faces = corner.reshape(-1, 3)
    faces = faces[(faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])]
    kept, _ = _distinct(np.sort(faces, axis=1))
    return np.asarray(points[first][faces[np.sort(kept)]])


def _distinct(rows: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Index of the first of each distinct row of `rows` (n, 3), in the rows' order, and each row's place among these.

    As `np.unique` along an axis, which compares rows byte by byte: several times as slow.
    """
    order = np.lexsort(rows.T[::-1])
    ordered = rows[order]
    begins = np.ones(len(rows), dtype=bool)
    begins[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    place = np.empty(len(rows), dtype=np.int64)
    place[order] = np.cumsum(begins) - 1
    return order[begins], place


def _size(path: Path) -> int:
    """In bytes, 0 of a file that is not converted."""
    try:
        return check_input(path, RobotError, _MOST_BYTES) if path.suffix.lower() in _CONVERTED else 0
    except RobotError:
        return 0


def _is_read_by_mujoco(path: Path) -> bool:
    """Whether MuJoCo reads a file: of STL a binary one of not too many faces."""
    kind = path.suffix.lower()
    if kind != ".stl" or not path.is_file():
        return kind in _READ_BY_MUJOCO and path.is_file()
    try:
        with open_input(path, RobotError, _MOST_BYTES) as stream:
            count = int.from_bytes(stream.read(84)[80:], "little")
    except RobotError:
        return False
    return 0 < count <= _LARGEST and 84 + 50 * count <= path.stat().st_size
