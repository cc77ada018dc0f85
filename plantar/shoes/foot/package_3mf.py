"""3MF packages: triangles of all build items from all model parts."""

from __future__ import annotations

from array import array
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO
from xml.parsers import expat

import numpy as np
from numpy.typing import NDArray

from plantar.common.files.zip_archive import open_archive
from plantar.errors import FootError

_UNITS: dict[str, tuple[str, float]] = {
    "micron": ("mm", 1e-3),
    "millimeter": ("mm", 1.0),
    "centimeter": ("cm", 1.0),
    "inch": ("in", 1.0),
    "foot": ("in", 12.0),
    "meter": ("m", 1.0),
}
_LARGEST = 100e6  # bytes that a package may unpack to
_BLOCK = 1 << 16
_LONGEST = 1_000_000  # characters of an element
_DEEPEST = 8  # components in each other
_MOST_PARTS = 10_000  # objects, components and build items
_CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02 "
_PATH = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06 path"

Array = NDArray[np.float64]
_Name = tuple[str, str]  # the model part that an object is in, and its number there


@dataclass
class _Object:
    corners: array[float] = field(default_factory=lambda: array("d"))
    faces: array[int] = field(default_factory=lambda: array("q"))
    components: list[tuple[_Name, str | None]] = field(default_factory=list)


class _Model:
    """Model parts of a package, read by element without a tree."""

    def __init__(self, most: int, where: str) -> None:
        self.unit = "millimeter"
        self.objects: dict[_Name, _Object] = {}
        self.items: list[tuple[_Name, str | None]] = []
        self.named: list[str] = []
        self._part = ""
        self._most = most
        self._where = where
        self._here = _Object()
        self._parts = 0
        self._corners = 0
        self._faces = 0

    def read(self, stream: IO[bytes], part: str) -> None:
        self._part = part
        parser = expat.ParserCreate(namespace_separator=" ")
        parser.StartElementHandler = self._start
        parser.EntityDeclHandler = self._refuse_entity
        unended = 0
        while block := stream.read(_BLOCK):
            unended = len(block) - block.rfind(b">") - 1 + (unended if b">" not in block else 0)
            if unended > _LONGEST:  # the parser goes over it again with each block
                raise FootError(f"{self._where}: an element of more than {_LONGEST} characters")
            parser.Parse(block, False)
        parser.Parse(b"", True)

    def _refuse_entity(self, *_: object) -> None:
        raise FootError(f"{self._where}: declares entities, which are not read; write out what they stand for")

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        name = tag.removeprefix(_CORE)
        if name == "vertex":
            self._corners += 1
            self._here.corners.extend((float(attributes["x"]), float(attributes["y"]), float(attributes["z"])))
        elif name == "triangle":
            self._faces += 1
            self._here.faces.extend((int(attributes["v1"]), int(attributes["v2"]), int(attributes["v3"])))
        elif name in ("object", "component", "item"):
            self._parts += 1
            self._add_part(name, attributes)
        elif name == "model" and self._part == self.named[0]:
            self.unit = attributes.get("unit", self.unit)
        if self._faces > self._most or self._corners > 3 * self._most:
            raise FootError(f"{self._where}: has more than {self._most} triangles; reduce the mesh")
        if self._parts > _MOST_PARTS:
            raise FootError(f"{self._where}: has more than {_MOST_PARTS} objects, components and items")

    def _add_part(self, name: str, attributes: dict[str, str]) -> None:
        if name == "object":
            self._here = _Object()
            self.objects[self._part, attributes.get("id", "")] = self._here
            return
        part = _plain(attributes[_PATH]) if _PATH in attributes else self._part
        if part not in self.named:
            self.named.append(part)
        use = ((part, attributes.get("objectid", "")), attributes.get("transform"))
        if name == "component":
            self._here.components.append(use)
        elif self._part == self.named[0]:
            self.items.append(use)

    def triangles(self) -> Array:
        parts: list[Array] = []
        count = 0
        calls = 0
        queue = [(item, np.eye(4), 0) for item in reversed(self.items)]
        while queue:
            (identity, move), outer, depth = queue.pop()
            calls += 1
            if depth > _DEEPEST or identity not in self.objects:
                raise FootError(f"{self._where}: the 3MF package names an object that it does not hold")
            if calls > _MOST_PARTS:
                raise FootError(f"{self._where}: is put together of more than {_MOST_PARTS} components")
            found = self.objects[identity]
            place = _matrix(move) @ outer
            count += len(found.faces) // 3
            if count > self._most:
                raise FootError(f"{self._where}: has more than {self._most} triangles; reduce the mesh")
            if found.faces:
                corners = np.array(found.corners).reshape(-1, 3)
                parts.append(corners[np.array(found.faces).reshape(-1, 3)] @ place[:3, :3] + place[3, :3])
            queue += [(use, place, depth + 1) for use in reversed(found.components)]
        return np.concatenate(parts) if parts else np.empty((0, 3, 3))


def triangles_of_3mf(path: Path, most: int) -> tuple[Array, str]:
    """Gives triangles (n, 3, 3) of all build items of the 3MF package at a path, most in number with repeats, and their
    unit.
    """
    with open_archive(path, FootError, _LARGEST) as (package, _):
        names = [i for i in package.infolist() if i.filename.lower().endswith(".model")]
        if not names:
            raise FootError(f"{path}: the 3MF package holds no model part")
        main = min(names, key=lambda i: (i.filename.lower() != "3d/3dmodel.model", i.filename))
        held = {_plain(i.filename): i for i in names}
        model = _Model(most, str(path))
        done = 0
        model.named.append(_plain(main.filename))
        while done < len(model.named):
            part = model.named[done]
            done += 1
            if part in held:
                with package.open(held[part]) as stream:
                    model.read(stream, part)
    unit, factor = _UNITS[model.unit]
    with np.errstate(all="ignore"):  # what is not finite is refused later
        return model.triangles() * factor, unit


def _plain(part: str) -> str:
    return part.lstrip("/").lower()


def _matrix(transform: str | None) -> Array:
    """3MF transform: twelve numbers, rows of a 4 x 3 matrix for row vectors."""
    out = np.eye(4)
    if transform is not None:
        out[:, :3] = np.array([float(v) for v in transform.split()[:13]]).reshape(4, 3)
    return out
