"""STL files, binary and text, and OBJ files: checked before they are read."""

from __future__ import annotations

import io
import re
from array import array
from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FootError

__all__ = ["triangles_of_obj", "triangles_of_stl"]

_HEAD, _TRIANGLE = 84, 50  # bytes
_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_VERTEX = re.compile(rb"\bvertex\s++(\S{1,64}+)\s++(\S{1,64}+)\s++(\S{1,64}+)", re.IGNORECASE)


def triangles_of_stl(data: bytes, most: int, where: str) -> NDArray[np.float64]:
    """Gives the triangles (n, 3, 3) of an STL file's data, most in number; where is its name.

    Raises:
        FootError: If it is cut short or foreign, or holds more.
        ValueError: If a number of a text STL is damaged.
    """
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


def triangles_of_obj(data: bytes, most: int, where: str) -> NDArray[np.float64]:
    """Gives the triangles (n, 3, 3) of an OBJ file's data, most in number, faces of more corners as fans; where is its
    name.

    Raises:
        FootError: If it holds more.
        ValueError: If a number is damaged, or a face names a missing corner.
    """
    corners, faces = array("d"), array("q")
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
    """Triangles of a face "f 1/1/1 2/2/2 -1": numbers from 1, or back from the last corner so far."""
    named = [int(item.partition(b"/")[0]) for item in line.partition(b"#")[0].split()[1:]]
    if 0 in named:
        raise ValueError("a face names vertex 0")
    ring = [i - 1 if i > 0 else known + i for i in named]
    for b, c in pairwise(ring[1:]):
        faces.extend((ring[0], b, c))
