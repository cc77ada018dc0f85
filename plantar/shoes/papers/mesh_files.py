"""Triangles as STL and 3MF files, byte for byte reproducible."""

import os
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

_TYPES = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
    '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
    '<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>'
)
_RELATIONS = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
    '<Relationship Target="/3D/3dmodel.model" Id="rel0" '
    'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'
)
_DATE = (2000, 1, 1, 0, 0, 0)  # the same input gives the same bytes


@dataclass(frozen=True)
class NamedBody:
    """Assembly body: closed triangles (n, 3, 3) in mm, outward counter-clockwise, and colour "#RRGGBB"."""

    name: str
    material: str
    colour: str
    triangles: NDArray[np.float64]


def write_3mf(triangles: NDArray[np.float64], name: str, path: str | os.PathLike[str]) -> Path:
    """Write closed triangles (n, 3, 3) in mm with a name as 3MF; returns the path."""
    title = _plain(name)
    return _write(f'{_object(1, title, triangles)}</resources><build><item objectid="1"/></build></model>', title, path)


def write_assembly(bodies: Sequence[NamedBody], name: str, path: str | os.PathLike[str]) -> Path:
    """Write bodies with names and materials as one 3MF assembly; name is the assembly's; returns the path."""
    title = _plain(name)
    first = 2
    kinds = dict.fromkeys((b.material, b.colour) for b in bodies)
    bases = "".join(f'<base name="{_plain(m)}" displaycolor="{c}"/>' for m, c in kinds)
    place = {kind: i for i, kind in enumerate(kinds)}
    objects = "".join(
        _object(first + i, _plain(b.name), b.triangles, f' pid="1" pindex="{place[b.material, b.colour]}"')
        for i, b in enumerate(bodies)
    )
    whole = first + len(bodies)
    parts = "".join(f'<component objectid="{first + i}"/>' for i in range(len(bodies)))
    return _write(
        f'<basematerials id="1">{bases}</basematerials>{objects}'
        f'<object id="{whole}" name="{title}" type="model"><components>{parts}</components></object>'
        f'</resources><build><item objectid="{whole}"/></build></model>',
        title,
        path,
    )


def _plain(name: str) -> str:
    return "".join(c if c.isalnum() or c in " -_." else " " for c in name)


def _object(number: int, title: str, triangles: NDArray[np.float64], attributes: str = "") -> str:
    vertices, index = np.unique(np.round(triangles.reshape(-1, 3), 5) + 0.0, axis=0, return_inverse=True)
    faces = index.reshape(-1, 3)
    faces = faces[(faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])]
    corners = "".join(f'<vertex x="{x:.9g}" y="{y:.9g}" z="{z:.9g}"/>' for x, y, z in vertices.round(5))
    sides = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in faces)
    return (
        f'<object id="{number}" name="{title}" type="model"{attributes}><mesh><vertices>{corners}</vertices>'
        f"<triangles>{sides}</triangles></mesh></object>"
    )


def _write(resources: str, title: str, path: str | os.PathLike[str]) -> Path:
    model = (
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        '<model unit="millimeter" xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">'
        f'<metadata name="Title">{title}</metadata><resources>{resources}'
    )
    file = Path(path)
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as package:
        for inside, text in (("[Content_Types].xml", _TYPES), ("_rels/.rels", _RELATIONS), ("3D/3dmodel.model", model)):
            entry = zipfile.ZipInfo(inside, _DATE)
            entry.compress_type = zipfile.ZIP_DEFLATED
            package.writestr(entry, text)
    return file


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
