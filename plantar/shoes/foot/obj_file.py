"""OBJ files: corners and faces alone."""

from __future__ import annotations

import io
from array import array
from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FootError

__all__ = ["triangles_of_obj"]


def triangles_of_obj(data: bytes, most: int, where: str) -> NDArray[np.float64]:
    """Triangles of all objects of an OBJ file; a face of more corners is a fan.

    Args:
        data: The file.
        most: Triangles that it may hold.
        where: Name of the file, for messages.

    Returns:
        Triangles (n, 3, 3) in the file's unit.

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
