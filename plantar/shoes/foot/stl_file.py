"""STL files, binary and text, checked against their stated size before they are read."""

from __future__ import annotations

import re
from array import array

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FootError

__all__ = ["triangles_of_stl"]

_HEAD, _TRIANGLE = 84, 50  # bytes
_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_VERTEX = re.compile(rb"\bvertex\s++(\S{1,64}+)\s++(\S{1,64}+)\s++(\S{1,64}+)", re.IGNORECASE)


def triangles_of_stl(data: bytes, most: int, where: str) -> NDArray[np.float64]:
    """Triangles of an STL file.

    Args:
        data: The file.
        most: Triangles that it may hold.
        where: Name of the file, for messages.

    Returns:
        Triangles (n, 3, 3) in the file's unit.

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
