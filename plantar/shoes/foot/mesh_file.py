"""Triangle meshes from files: STL, OBJ and 3MF here, others by libraries apart (`plantar.common.files.gate`)."""

from __future__ import annotations

import io
import os
import re
from array import array
from collections.abc import Iterator
from importlib.util import find_spec
from itertools import pairwise
from pathlib import Path
from typing import Literal, cast

import numpy as np
from numpy.typing import NDArray

from plantar.common.files.gate import read_apart
from plantar.common.files.input_file import check_input, read_input
from plantar.errors import DependencyError, FootError
from plantar.shoes.foot.package_3mf import triangles_of_3mf

Unit = Literal["m", "cm", "mm", "in"]  # unit of length of a mesh file

# File endings that are read
MESH_FORMATS: tuple[str, ...] = (".stl", ".obj", ".ply", ".off", ".dae", ".3mf", ".step", ".stp", ".iges", ".igs")

# Triangles that a mesh may have, as a scan has them; the feet of robots have some ten thousand
MOST_TRIANGLES = 1_200_000

_APART: dict[str, tuple[str, str, Unit | None]] = {  # helper, library, and the unit of its triangles
    ".ply": ("ply", "trimesh", None),
    ".off": ("off", "trimesh", None),
    ".dae": ("dae", "collada", "m"),
    **dict.fromkeys((".step", ".stp"), ("step", "OCP", "mm")),
    **dict.fromkeys((".iges", ".igs"), ("iges", "OCP", "mm")),
}
_LARGEST = 100e6  # bytes: so many triangles in binary, a third of them as text


def read_mesh(path: str | os.PathLike[str]) -> tuple[NDArray[np.float64], Unit | None]:
    """Read a mesh file's triangles; scene parts are joined.

    Returns triangles (n, 3, 3) in the file's unit, and that unit if stated.
    """
    file = Path(path)
    kind = file.suffix.lower()
    if kind not in MESH_FORMATS:
        raise FootError(f"{file}: '{kind}' is no mesh format that is read; allowed: {', '.join(MESH_FORMATS)}")
    if not check_input(file, FootError, _LARGEST):
        raise FootError(f"{file}: the file is empty; give a mesh file ({', '.join(MESH_FORMATS)})")
    try:
        triangles, unit = _read(file, kind)
    except (FootError, DependencyError):
        raise
    except Exception as error:  # of every kind on a damaged file
        reason = " ".join(str(error).split())[:80] or type(error).__name__
        raise FootError(f"{file}: not a readable {kind[1:].upper()} mesh, cut short or foreign ({reason})") from None
    if not len(triangles):
        raise FootError(f"{file}: holds no triangles; export the foot as a triangle mesh")
    if len(triangles) > MOST_TRIANGLES:
        raise FootError(f"{file}: has {len(triangles)} triangles; allowed: up to {MOST_TRIANGLES}; reduce the mesh")
    bad = int((~np.isfinite(triangles)).any(axis=(1, 2)).sum())
    if bad:
        raise FootError(
            f"{file}: {bad} of {len(triangles)} triangles hold a coordinate that is not finite; repair the mesh"
        )
    if len(triangles) < 4:
        raise FootError(f"{file}: has {len(triangles)} triangles; a foot's body needs 4 or more")
    extent = np.ptp(triangles.reshape(-1, 3), axis=0)
    if extent.min() <= 1e-6 * extent.max():
        raise FootError(f"{file}: the mesh is flat; allowed: a foot's body, or an outline (.dxf, .svg, .geojson)")
    return triangles, unit


def _read(file: Path, kind: str) -> tuple[NDArray[np.float64], Unit | None]:
    if kind == ".3mf":
        triangles, unit = triangles_of_3mf(file, MOST_TRIANGLES)
        return triangles, cast(Unit, unit)
    if kind == ".off":
        _check_off(file)
    if kind in (".step", ".stp") and b"ISO-10303-21" not in read_input(file, FootError, _LARGEST)[:200]:
        raise FootError(f"{file}: not a readable STEP file: it does not start with ISO-10303-21")
    if kind in _APART:
        helper, library, stated = _APART[kind]
        if find_spec(library) is None:
            raise DependencyError(library, "shoes")
        return np.asarray(read_apart(helper, file, FootError)["triangles"], dtype=np.float64), stated
    read = _triangles_of_stl if kind == ".stl" else _triangles_of_obj
    return read(read_input(file, FootError, _LARGEST), MOST_TRIANGLES, str(file)), None


def _check_off(file: Path) -> None:
    """Refuse OFF files stating too many faces, before a library allocates them."""
    with file.open("rb") as opened:
        head = opened.read(4096)
    words = [w for line in head.splitlines() for w in line.partition(b"#")[0].split()]
    if len(words) > 2 and words[0].endswith(b"OFF") and words[2].isdigit() and int(words[2]) > MOST_TRIANGLES:
        raise FootError(f"{file}: has {words[2].decode():.20} faces; allowed: up to {MOST_TRIANGLES}; reduce the mesh")


# bytes
_HEAD = 84
_TRIANGLE = 50
_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_VERTEX = re.compile(rb"\bvertex\s++(\S{1,64}+)\s++(\S{1,64}+)\s++(\S{1,64}+)", re.IGNORECASE)


def _triangles_of_stl(data: bytes, most: int, where: str) -> NDArray[np.float64]:
    if data.lstrip()[:5].lower() == b"solid" and b"facet" in data[:4000].lower():
        return _of_text(data, most, where)
    stated = int.from_bytes(data[80:84], "little")
    held = max(0, len(data) - _HEAD) // _TRIANGLE
    if len(data) != _HEAD + _TRIANGLE * stated:
        raise FootError(f"{where}: cut short or no STL: its header states {stated} triangles, the file holds {held}")
    _refuse_more(stated, most, where)
    return np.frombuffer(data, _RECORD, stated, _HEAD)["corners"].astype(np.float64)


def _of_text(data: bytes, most: int, where: str) -> NDArray[np.float64]:
    if b"endsolid" not in data[-4000:].lower():
        raise FootError(f"{where}: the text STL ends before 'endsolid': the file is cut short")
    values = array("d")
    for corner in _VERTEX.finditer(data):
        values.extend(map(float, corner.groups()))
        if len(values) > 9 * most:
            _refuse_more(most + 1, most, where)
    facets = len(re.findall(rb"\bendfacet\b", data, re.IGNORECASE))
    if len(values) != 9 * facets:
        raise FootError(
            f"{where}: not a readable STL: {facets} facets have {len(values) // 3} corners; allowed: three each"
        )
    return np.array(values).reshape(-1, 3, 3)


def _refuse_more(count: int, most: int, where: str) -> None:
    if count > most:
        raise FootError(f"{where}: has more than {most} triangles; reduce the mesh")


def _triangles_of_obj(data: bytes, most: int, where: str) -> NDArray[np.float64]:
    corners = array("d")
    faces = array("q")
    for line in _lines(data):
        if line[:2] in (b"v ", b"v\t"):
            x, y, z = line.split(None, 4)[1:4]
            corners.extend((float(x), float(y), float(z)))
        elif line[:2] in (b"f ", b"f\t"):
            _add_fan(faces, line, len(corners) // 3)
        if len(faces) > 3 * most:
            raise FootError(f"{where}: has more than {most} triangles; reduce the mesh")
        if len(corners) > 9 * most:
            raise FootError(f"{where}: has more than {3 * most} vertices; reduce the mesh")
    indices = np.array(faces).reshape(-1, 3)
    if len(indices) and not 0 <= int(indices.min()) <= int(indices.max()) < len(corners) // 3:
        raise ValueError("a face names a vertex that is not there")
    return np.asarray(np.array(corners).reshape(-1, 3)[indices])


def _lines(data: bytes) -> Iterator[bytes]:
    begun: list[bytes] = []
    for line in io.BytesIO(data):
        if line.endswith((b"\\\n", b"\\\r\n")):
            begun.append(line.rstrip(b"\\\r\n") + b" ")
        elif begun:
            yield b"".join([*begun, line])
            begun.clear()
        else:
            yield line
    if begun:
        yield b"".join(begun)


def _add_fan(faces: array[int], line: bytes, known: int) -> None:
    """Triangles of a face "f 1/1/1 2/2/2 -1": numbers from 1, or back from the last corner."""
    named = [int(item.partition(b"/")[0]) for item in line.partition(b"#")[0].split()[1:]]
    if 0 in named:
        raise ValueError("a face names vertex 0")
    ring = [i - 1 if i > 0 else known + i for i in named]
    for b, c in pairwise(ring[1:]):
        faces.extend((ring[0], b, c))
