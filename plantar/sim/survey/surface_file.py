"""Mesh files that MuJoCo does not read (Collada, text STL) as binary STL."""

from __future__ import annotations

import hashlib
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray

from plantar.errors import RobotError
from plantar.files.input_file import read_input
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
        if kind == ".stl":
            data = read_input(path, RobotError, _MOST_BYTES)
            if _is_binary_stl(data) and 0 < int.from_bytes(data[80:84], "little") <= _LARGEST:
                return path
            triangles = _binary_stl(data) if _is_binary_stl(data) else _text_stl(data)
        elif kind == ".dae":
            triangles = _collada(path)
        else:
            return None
    except (RobotError, ValueError, LookupError):
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


def _is_binary_stl(data: bytes) -> bool:
    return len(data) >= 84 and 84 + 50 * int.from_bytes(data[80:84], "little") <= len(data)


def _binary_stl(data: bytes) -> Triangles:
    count = int.from_bytes(data[80:84], "little")
    record = np.dtype([("numbers", "<f4", (4, 3)), ("attribute", "<u2")])
    return np.frombuffer(data, record, count, 84)["numbers"][:, 1:].astype(float)


def _text_stl(data: bytes) -> Triangles:
    lines = (line.split() for line in data.decode("utf-8", "replace").splitlines())
    corners = [[float(v) for v in words[1:4]] for words in lines if len(words) == 4 and words[0].lower() == "vertex"]
    return np.array(corners, dtype=float).reshape(-1, 3, 3)


def _collada(path: Path) -> Triangles:
    """Triangles of a Collada file in m, its nodes in place.

    Its up axis is ignored, as in RViz and Gazebo (github.com/ros-visualization/rviz/issues/1045).
    """
    root = parse_xml(read_input(path, RobotError, _MOST_BYTES), RobotError, str(path))
    for element in root.iter():
        element.tag = element.tag.rpartition("}")[2]
    unit = root.find("asset/unit")
    scale = 1.0 if unit is None else float(unit.get("meter", "1"))
    shapes = {f"#{g.get('id', '')}": _collada_shape(g) for g in root.iter("geometry")}
    nodes = {f"#{n.get('id', '')}": n for n in root.iter("node")}
    found: list[Triangles] = []

    def walk(node: Element, above: NDArray[np.float64], depth: int) -> None:
        at = above @ _collada_matrix(node)
        for instance in node.findall("instance_geometry"):
            shape = shapes.get(instance.get("url", ""))
            if shape is not None and len(shape):
                found.append(shape @ at[:3, :3].T + at[:3, 3])
        inner = [nodes[i.get("url", "")] for i in node.findall("instance_node") if i.get("url", "") in nodes]
        for child in (*node.findall("node"), *inner) if depth < 32 else ():
            walk(child, at, depth + 1)

    for scene in root.iter("visual_scene"):
        for node in scene.findall("node"):
            walk(node, np.eye(4), 0)
    if not found:
        found = [shape for shape in shapes.values() if len(shape)]
    whole = np.concatenate(found) if found else np.zeros((0, 3, 3))
    return np.asarray(scale * whole)


def _collada_matrix(node: Element) -> NDArray[np.float64]:
    at = np.eye(4)
    for element in node:
        step = np.eye(4)
        if element.tag not in ("matrix", "translate", "rotate", "scale"):
            continue
        values = np.array([float(v) for v in (element.text or "").split()])
        if element.tag == "matrix":
            step = values.reshape(4, 4)
        elif element.tag == "translate":
            step[:3, 3] = values
        elif element.tag == "scale":
            step[:3, :3] = np.diag(values)
        else:
            x, y, z = values[:3] / max(float(np.linalg.norm(values[:3])), 1e-12)
            cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
            angle = np.radians(values[3])
            step[:3, :3] += np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross
        at = at @ step
    return at


def _collada_shape(geometry: Element) -> Triangles:
    mesh = geometry.find("mesh")
    if mesh is None:
        return np.zeros((0, 3, 3))
    arrays = {}
    for source in mesh.findall("source"):
        text = source.findtext("float_array")
        if text is not None:
            accessor = source.find("technique_common/accessor")
            stride = 3 if accessor is None else int(accessor.get("stride", "3"))
            values = np.array(text.split(), dtype=float)
            arrays[f"#{source.get('id', '')}"] = values[: len(values) // stride * stride].reshape(-1, stride)
    points = {}
    for vertices in mesh.findall("vertices"):
        for given in vertices.findall("input"):
            if given.get("semantic") == "POSITION":
                points[f"#{vertices.get('id', '')}"] = arrays[given.get("source", "")][:, :3]
    found = [
        _collada_faces(part, points) for kind in ("triangles", "polylist", "polygons") for part in mesh.findall(kind)
    ]
    return np.concatenate(found) if found else np.zeros((0, 3, 3))


def _collada_faces(part: Element, points: dict[str, NDArray[np.float64]]) -> Triangles:
    inputs = part.findall("input")
    vertex = next(i for i in inputs if i.get("semantic") == "VERTEX")
    width = 1 + max(int(i.get("offset", "0")) for i in inputs)
    lists = [np.array((p.text or "").split(), dtype=np.int64) for p in part.findall("p")]
    indices = [one.reshape(-1, width)[:, int(vertex.get("offset", "0"))] for one in lists]
    corners = points[vertex.get("source", "")]
    if part.tag == "triangles":
        return np.concatenate(
            [corners[i[: len(i) // 3 * 3]].reshape(-1, 3, 3) for i in indices] or [np.zeros((0, 3, 3))]
        )
    if part.tag == "polylist" and indices:
        counts = np.array((part.findtext("vcount") or "").split(), dtype=np.int64)
        indices = np.split(indices[0], np.cumsum(counts)[:-1])
    fans = [corners[[i[0], i[k], i[k + 1]]] for i in indices for k in range(1, len(i) - 1)]
    return np.array(fans).reshape(-1, 3, 3)
