"""Triangle meshes from files: STL, OBJ, PLY and OFF through trimesh, STEP through cadquery, 3MF read here."""

from __future__ import annotations

import os
import zipfile
from pathlib import Path
from typing import Literal
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from plantar.errors import DependencyError, FootError
from plantar.optional_library import optional_library
from shoes.cad_kernel import load_cadquery

__all__ = ["MESH_FORMATS", "Unit", "read_mesh"]

Unit = Literal["m", "cm", "mm", "in"]
"""Unit of length of a mesh file."""

MESH_FORMATS: tuple[str, ...] = (".stl", ".obj", ".ply", ".off", ".3mf", ".step", ".stp")
"""File endings that are read."""

_UNITS_3MF: dict[str, tuple[Unit, float]] = {
    "micron": ("mm", 1e-3),
    "millimeter": ("mm", 1.0),
    "centimeter": ("cm", 1.0),
    "inch": ("in", 1.0),
    "foot": ("in", 12.0),
    "meter": ("m", 1.0),
}
_SIZE_MAX = 200_000_000  # bytes
_CORE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"


def read_mesh(path: str | os.PathLike[str]) -> tuple[NDArray[np.float64], Unit | None]:
    """Read the triangles of a mesh file; parts of a scene are put together.

    Args:
        path: A file whose name ends in one of MESH_FORMATS.

    Returns:
        Triangles (n, 3, 3) in the file's unit, and that unit where the file states it.

    Raises:
        FootError: If the file cannot be read, is cut short or foreign, or holds no finite triangles.
    """
    file = Path(path)
    kind = file.suffix.lower()
    if kind not in MESH_FORMATS:
        raise FootError(f"{file}: '{kind}' is no mesh format that is read; allowed: {', '.join(MESH_FORMATS)}")
    try:
        data = file.read_bytes() if file.stat().st_size <= _SIZE_MAX else None
    except OSError as error:
        raise FootError(
            f"{file}: cannot be read ({error.strerror}); give a mesh file ({', '.join(MESH_FORMATS)})"
        ) from None
    if data is None:
        raise FootError(f"{file}: larger than {_SIZE_MAX // 1_000_000} MB; reduce the mesh")
    if not data:
        raise FootError(f"{file}: the file is empty; give a mesh file ({', '.join(MESH_FORMATS)})")
    unit: Unit | None = None
    try:
        if kind == ".3mf":
            triangles, unit = _read_3mf(file)
        elif kind in (".step", ".stp"):
            triangles, unit = _read_step(file), "mm"
        else:
            triangles = _read_with_trimesh(file, kind, data)
    except (FootError, DependencyError):
        raise
    except Exception as error:  # the readers raise of every kind on a damaged file
        reason = " ".join(str(error).split())[:80] or type(error).__name__
        raise FootError(f"{file}: not a readable {kind[1:].upper()} mesh, cut short or foreign ({reason})") from None
    if not len(triangles):
        raise FootError(f"{file}: holds no triangles; export the foot as a triangle mesh")
    bad = int((~np.isfinite(triangles)).any(axis=(1, 2)).sum())
    if bad:
        raise FootError(
            f"{file}: {bad} of {len(triangles)} triangles hold a coordinate that is not finite; repair the mesh"
        )
    if len(triangles) < 4:
        raise FootError(f"{file}: has {len(triangles)} triangles; a foot's body needs 4 or more")
    return triangles, unit


def _read_with_trimesh(file: Path, kind: str, data: bytes) -> NDArray[np.float64]:
    with optional_library("trimesh", "shoes"):
        import trimesh
    if kind == ".stl":
        _check_stl(file, data)
    with np.errstate(all="ignore"):  # coordinates that are not finite are reported below
        mesh = trimesh.load(file, process=False, force="mesh", skip_materials=True)
    if not isinstance(mesh, trimesh.Trimesh):
        return np.empty((0, 3, 3))
    return np.asarray(mesh.vertices, dtype=float)[np.asarray(mesh.faces, dtype=np.int64)]


def _read_step(file: Path) -> NDArray[np.float64]:
    """Triangles in mm of all shapes of a STEP file; its own unit is converted while it is read."""
    if b"ISO-10303-21" not in file.read_bytes()[:200]:
        raise FootError(f"{file}: not a readable STEP file: it does not start with ISO-10303-21")
    cq = load_cadquery()
    parts = []
    for shape in cq.importers.importStep(str(file)).vals():
        vertices, faces = shape.tessellate(0.05, 0.2)
        if faces:
            parts.append(np.array([v.toTuple() for v in vertices])[np.array(faces, dtype=np.int64)])
    return np.concatenate(parts) if parts else np.empty((0, 3, 3))


def _check_stl(file: Path, data: bytes) -> None:
    """Refuse an STL that is cut short or foreign; the readers would take what they find of it."""
    if data.lstrip()[:5].lower() == b"solid" and b"facet" in data[:4000]:
        if b"endsolid" not in data[-4000:].lower():
            raise FootError(f"{file}: the text STL ends before 'endsolid': the file is cut short")
        return
    stated = int.from_bytes(data[80:84], "little")
    held = max(0, len(data) - 84) // 50
    if len(data) != 84 + 50 * stated:
        raise FootError(f"{file}: cut short or no STL: its header states {stated} triangles, the file holds {held}")


def _read_3mf(file: Path) -> tuple[NDArray[np.float64], Unit]:
    """Triangles of all build items of a 3MF package, with their transforms."""
    with zipfile.ZipFile(file) as package:
        names = [i for i in package.infolist() if i.filename.lower().endswith(".model")]
        if not names:
            raise FootError(f"{file}: the 3MF package holds no model part")
        part = min(names, key=lambda i: (i.filename.lower() != "3d/3dmodel.model", i.filename))
        if part.file_size > _SIZE_MAX:
            raise FootError(f"{file}: the model part is larger than {_SIZE_MAX // 1_000_000} MB; reduce the mesh")
        root = ElementTree.fromstring(package.read(part))
    unit, factor = _UNITS_3MF[root.get("unit", "millimeter")]
    objects = {o.get("id"): o for o in root.iter(f"{_CORE}object")}

    def triangles_of(identity: str | None, depth: int) -> list[NDArray[np.float64]]:
        if depth > 8 or identity not in objects:
            raise FootError(f"{file}: the 3MF package names an object that is not in its main model part")
        out: list[NDArray[np.float64]] = []
        for mesh in objects[identity].iter(f"{_CORE}mesh"):
            vertices = np.array([[float(v.attrib[a]) for a in "xyz"] for v in mesh.iter(f"{_CORE}vertex")])
            faces = [[int(t.attrib[a]) for a in ("v1", "v2", "v3")] for t in mesh.iter(f"{_CORE}triangle")]
            if faces:
                out.append(vertices[np.array(faces)])
        for component in objects[identity].iter(f"{_CORE}component"):
            move = component.get("transform")
            out += [_moved(t, move) for t in triangles_of(component.get("objectid"), depth + 1)]
        return out

    items = list(root.iter(f"{_CORE}item"))
    parts = [_moved(t, item.get("transform")) for item in items for t in triangles_of(item.get("objectid"), 0)]
    return (np.concatenate(parts) if parts else np.empty((0, 3, 3))) * factor, unit


def _moved(triangles: NDArray[np.float64], transform: str | None) -> NDArray[np.float64]:
    """Triangles under a 3MF transform: twelve numbers, rows of a 4 x 3 matrix that multiplies row vectors."""
    if transform is None:
        return triangles
    matrix = np.array([float(v) for v in transform.split()]).reshape(4, 3)
    return np.asarray(triangles @ matrix[:3] + matrix[3])
