"""3MF files: triangles with their unit, so that no printing program has to guess it."""

from __future__ import annotations

import os
import zipfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

__all__ = ["write_3mf"]

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


def write_3mf(triangles: NDArray[np.float64], name: str, path: str | os.PathLike[str]) -> Path:
    """Write a surface as a 3MF package with the unit millimetre.

    Args:
        triangles: Closed surface (n, 3, 3) in mm, outward counter-clockwise.
        name: Name of the object.
        path: File to write.

    Returns:
        The path.
    """
    vertices, index = np.unique(np.round(triangles.reshape(-1, 3), 5) + 0.0, axis=0, return_inverse=True)
    faces = index.reshape(-1, 3)
    faces = faces[(faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])]
    title = "".join(c if c.isalnum() or c in " -_." else " " for c in name)
    model = [
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        '<model unit="millimeter" xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">'
        f'<metadata name="Title">{title}</metadata><resources><object id="1" name="{title}" type="model">',
        "<mesh><vertices>",
        *(f'<vertex x="{x:.9g}" y="{y:.9g}" z="{z:.9g}"/>' for x, y, z in vertices.round(5)),
        "</vertices><triangles>",
        *(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in faces),
        '</triangles></mesh></object></resources><build><item objectid="1"/></build></model>',
    ]
    file = Path(path)
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as package:
        for inside, text in (
            ("[Content_Types].xml", _TYPES),
            ("_rels/.rels", _RELATIONS),
            ("3D/3dmodel.model", "".join(model)),
        ):
            entry = zipfile.ZipInfo(inside, _DATE)
            entry.compress_type = zipfile.ZIP_DEFLATED
            package.writestr(entry, text)
    return file
