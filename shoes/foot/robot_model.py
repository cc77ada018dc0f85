"""The outer geometry of one body of a robot's model: MJCF or URDF, without a simulator."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from plantar.arrays import is_finite
from plantar.errors import FootError
from plantar.files.model_files import folders_of_model, mesh_of_urdf, named_file, parsed_model
from plantar.mechanics.rotation import rotation_from_angles
from shoes.foot.mesh_file import MOST_TRIANGLES, read_mesh
from shoes.geometry.primitives import primitive
from shoes.geometry.transforms import Pose, mjcf_rotation

__all__ = ["MODEL_FORMATS", "BodyGeometry", "read_foot_body", "side_of_name"]

MODEL_FORMATS: tuple[str, ...] = (".xml", ".mjcf", ".urdf")
"""File endings of robot models that are read."""

_SHOWN = 14  # names in a message
_MOST_SHAPES = 200  # of a foot's body
_FARTHEST = 1e6  # m

Array = NDArray[np.float64]
Element = ElementTree.Element


@dataclass(frozen=True)
class BodyGeometry:
    """The surface of a body, its frame's origin at the origin and turned as in the model's zero pose.

    Attributes:
        triangles: Triangles (n, 3, 3) in m, z up.
        side: Side that the body's name tells, None where it does not.
        note: What was read.
    """

    triangles: Array
    side: Literal["left", "right"] | None
    note: str


def side_of_name(name: str) -> Literal["left", "right"] | None:
    """Side that a body's name tells.

    Example:
        >>> side_of_name("leg_left_6_link"), side_of_name("R_ANKLE_P_S"), side_of_name("LeftFoot"), side_of_name("sole")
        ('left', 'right', 'left', None)
    """
    words = [w.lower() for w in re.findall(r"[A-Z]?[a-z]+|[A-Z]+|\d+", name)]
    left, right = (s in words or name.lower().startswith(s) for s in ("left", "right"))
    if left == right:
        left, right = "l" in words, "r" in words
    if left == right:
        return None
    return "left" if left else "right"


def read_foot_body(path: str | os.PathLike[str], body: str | None) -> BodyGeometry:
    """Read the geometry of a robot's foot from its model.

    What is drawn is taken (visual geometry), or what collides where nothing is drawn. Bodies fixed to it count as part
    of it.

    Args:
        path: MJCF (.xml, .mjcf) or URDF (.urdf, .xml) file; meshes are looked for as the model says.
        body: Name of the foot's body or link.

    Returns:
        The geometry.

    Raises:
        FootError: If the file or one of its meshes cannot be read, or there is no such body, or it has no geometry.
    """
    file = Path(path)
    root = parsed_model(file, FootError)
    if root.tag == "robot":
        bodies = _urdf_bodies(_Source(file), root, body)
    elif root.tag == "mujoco":
        bodies = _mjcf_bodies(_Source(file), root)
    else:
        raise FootError(f"{file}: the outermost element is <{root.tag}>; allowed: <mujoco> (MJCF), <robot> (URDF)")
    if body is None or body not in bodies:
        shaped = [n for n, shapes in bodies.items() if any(shapes)]
        likely = [n for n in shaped if re.search("foot|ank|sole|toe", n, re.IGNORECASE)]
        likely += [n for n in _ends_first(root, shaped) if n not in likely] if not likely else []
        shown = ", ".join(likely[:_SHOWN]) + (", ..." if len(likely) > _SHOWN else "")
        what = "name the foot's body (--body)" if body is None else f"there is no body '{body}'"
        raise FootError(f"{file}: {what}; allowed: {shown}")
    drawn, colliding = bodies[body]
    shapes = drawn or colliding
    if not shapes:
        raise FootError(f"{file}: body '{body}' has no geometry; name the body that has the foot's")
    triangles = _together(shapes, f"{file}: body '{body}'")
    kind = "drawn" if drawn else "colliding"
    return BodyGeometry(
        triangles, side_of_name(body), f"body '{body}': {len(shapes)} {kind} shape(s), in m as models are"
    )


def _ends_first(root: Element, names: list[str]) -> list[str]:
    """Names of bodies in the order in which they may be feet: ends of chains, the longest first."""
    depth: dict[str, int] = {}
    inner: set[str] = set()
    parents = {j.find("child"): j.find("parent") for j in root.findall("joint")}
    above = {c.get("link", ""): p.get("link", "") for c, p in parents.items() if c is not None and p is not None}

    def walk(element: Element, level: int, parent: str) -> None:
        for child in element:
            if child.tag == "body":
                inner.add(parent)
                depth[child.get("name", "")] = level
                walk(child, level + 1, child.get("name", ""))
            elif child.tag in ("worldbody", "frame"):
                walk(child, level, parent)

    walk(root, 0, "")
    for name in names if above else ():
        link, depth[name] = name, 0
        while link in above and depth[name] <= len(above):
            inner.add(link := above[link])
            depth[name] += 1
    return sorted(names, key=lambda n: (n in inner, -depth.get(n, 0)))


Shape = Callable[[], Array]  # gives triangles: meshes are read only of the body that is asked for
Bodies = dict[str, tuple[list[Shape], list[Shape]]]


@dataclass(frozen=True)
class _Source:
    """A model's file, and the meshes that were read for it: one that is drawn many times is read once."""

    file: Path
    held: dict[Path, Array] = field(default_factory=dict)

    def mesh(self, path: Path) -> Array:
        """Triangles of a mesh file."""
        if path not in self.held:
            self.held[path] = read_mesh(path)[0]
        return self.held[path]


def _together(shapes: list[Shape], where: str) -> Array:
    """Triangles of all shapes."""
    if len(shapes) > _MOST_SHAPES:
        raise FootError(f"{where} has {len(shapes)} shapes; allowed: up to {_MOST_SHAPES}")
    found: list[Array] = []
    count = 0
    for shape in shapes:
        with np.errstate(all="ignore"):  # sizes of 1e300: told below
            found.append(shape())
        count += len(found[-1])
        if count > MOST_TRIANGLES:
            raise FootError(f"{where} has more than {MOST_TRIANGLES} triangles; reduce its meshes")
    triangles = np.concatenate(found)
    if not (np.abs(triangles) < _FARTHEST).all():
        raise FootError(f"{where} reaches farther than {_FARTHEST:g} m")
    return triangles


def _numbers(text: str | None, default: tuple[float, ...], where: str) -> Array:
    if text is None:
        return np.array(default)
    try:
        out = np.array([float(v) for v in text.split()])
    except ValueError:
        raise FootError(f"{where}: '{text[:40]}' is no list of numbers") from None
    if len(out) < len(default) or not is_finite(out):
        raise FootError(f"{where}: '{text[:40]}' needs {len(default) or 'only'} finite numbers")
    return out


def _urdf_bodies(source: _Source, root: Element, wanted: str | None) -> Bodies:
    """The links of a URDF; drawn and colliding shapes of the wanted one and of what is fixed to it."""
    file = source.file

    def pose(element: Element | None) -> Pose:
        if element is None:
            return Pose()
        xyz = _numbers(element.get("xyz"), (0.0, 0.0, 0.0), f"{file}: origin")
        roll, pitch, yaw = _numbers(element.get("rpy"), (0.0, 0.0, 0.0), f"{file}: origin")[:3].tolist()
        return Pose(xyz[:3], rotation_from_angles(yaw, pitch, roll))

    joints = {}
    for joint in root.findall("joint"):
        parent, child = joint.find("parent"), joint.find("child")
        if parent is not None and child is not None:
            joints[child.get("link", "")] = (parent.get("link", ""), joint.get("type", ""), pose(joint.find("origin")))

    def turned(link: str) -> Array:
        """Rotation of a link to the root at the zero pose."""
        out, seen = np.eye(3), set()
        while link in joints and link not in seen:
            seen.add(link)
            link, _, step = joints[link]
            out = step.rotation @ out
        return out

    links = {link.get("name", ""): link for link in root.findall("link")}
    fixed: dict[str, list[tuple[str, Pose]]] = {}
    for child_link, (parent_link, kind, step) in joints.items():
        if kind == "fixed":
            fixed.setdefault(parent_link, []).append((child_link, step))
    bodies: Bodies = {name: ([], []) for name in links}
    if wanted in links:
        found = bodies[wanted]
        queue = [(wanted, Pose(np.zeros(3), turned(wanted)))]
        seen: set[str] = set()
        while queue:
            here, at = queue.pop()
            if here in seen:
                raise FootError(f"{file}: link '{here}' is fixed to itself, by way of others")
            seen.add(here)
            for place, tag in enumerate(("visual", "collision")):
                for item in links[here].findall(tag) if here in links else ():
                    geometry = item.find("geometry")
                    if geometry is not None and len(geometry):
                        found[place].append(_urdf_shape(source, geometry[0], at @ pose(item.find("origin"))))
            queue += [(child_link, at @ step) for child_link, step in fixed.get(here, ())]
    return bodies


def _urdf_shape(source: _Source, shape: Element, at: Pose) -> Shape:
    def read() -> Array:
        where = f"{source.file}: <{shape.tag}>"
        if shape.tag == "mesh":
            scale = _numbers(shape.get("scale"), (1.0, 1.0, 1.0), where)
            path = mesh_of_urdf(source.file, shape.get("filename", ""), FootError, where)
            return at.moved(source.mesh(path), scale)
        radius, length = (_numbers(shape.get(k), (0.0,), where)[0] for k in ("radius", "length"))
        if shape.tag == "box":
            return at.moved(primitive("box", 0.5 * _numbers(shape.get("size"), (0.0, 0.0, 0.0), where), where))
        sizes = {"cylinder": (radius, 0.5 * length), "capsule": (radius, 0.5 * length), "sphere": (radius,)}
        if shape.tag not in sizes:
            raise FootError(f"{where} is no shape that is read; allowed: mesh, box, cylinder, capsule, sphere")
        return at.moved(primitive(shape.tag, np.array(sizes[shape.tag]), where))

    return read


@dataclass
class _Defaults:
    """Attributes that MJCF elements take from their class."""

    classes: dict[str, dict[str, dict[str, str]]]

    @classmethod
    def of(cls, root: Element) -> _Defaults:
        out: dict[str, dict[str, dict[str, str]]] = {"main": {}}

        def walk(element: Element, inherited: Mapping[str, dict[str, str]], top: bool) -> None:
            name = "main" if top else element.get("class", "main")
            own = {k: dict(v) for k, v in inherited.items()}
            for child in element:
                if child.tag != "default":
                    own[child.tag] = {**own.get(child.tag, {}), **child.attrib}
            out[name] = own
            for child in element.findall("default"):
                walk(child, own, False)

        for element in root.findall("default"):
            walk(element, out["main"], True)
        return cls(out)

    def of_element(self, element: Element, child_class: str | None) -> dict[str, str]:
        """An element's attributes, those it does not state taken from its class."""
        name = element.get("class", child_class or "main")
        return {**self.classes.get(name, self.classes["main"]).get(element.tag, {}), **element.attrib}


def _mjcf_bodies(source: _Source, root: Element) -> Bodies:
    """Drawn and colliding shapes of every body of an MJCF."""
    file = source.file
    compiler: dict[str, str] = {}
    for element in root.iter("compiler"):
        compiler.update(element.attrib)
    degrees = compiler.get("angle", "degree") != "radian"
    sequence = compiler.get("eulerseq", "xyz")
    defaults = _Defaults.of(root)
    meshes = {}
    for mesh in root.iter("mesh"):
        attributes = defaults.of_element(mesh, None)
        if "file" in attributes or "name" in attributes:
            meshes[attributes.get("name", Path(attributes.get("file", "")).stem)] = attributes
    bodies: Bodies = {}

    def pose(element: Element, attributes: Mapping[str, str]) -> Pose:
        where = f"{file}: <{element.tag} name='{element.get('name', '')}'>"
        return Pose(
            _numbers(attributes.get("pos"), (0.0, 0.0, 0.0), where)[:3],
            mjcf_rotation(attributes, degrees, sequence, where),
        )

    def shapes(element: Element, at: Pose, child_class: str | None) -> Iterator[tuple[bool, Shape]]:
        """Shapes of a body and of what is fixed to it."""
        child_class = element.get("childclass", child_class)
        for child in element:
            if child.tag == "geom":
                attributes = defaults.of_element(child, child_class)
                if attributes.get("type") in ("plane", "hfield"):
                    continue
                drawn = attributes.get("contype", "1") == "0" and attributes.get("conaffinity", "1") == "0"
                yield drawn, _mjcf_shape(source, attributes, meshes, compiler, at, pose(child, attributes))
            elif child.tag == "frame" or (child.tag == "body" and not _moves(child)):
                yield from shapes(child, at @ pose(child, child.attrib), child_class)

    def walk(element: Element, rotation: Array, child_class: str | None) -> None:
        for child in element:
            if child.tag not in ("body", "frame"):
                continue
            own = child.get("childclass", child_class)
            turned = rotation @ pose(child, child.attrib).rotation
            if child.tag == "body":
                found: tuple[list[Shape], list[Shape]] = ([], [])
                for drawn, shape in shapes(child, Pose(np.zeros(3), turned), child_class):
                    found[0 if drawn else 1].append(shape)
                bodies[child.get("name", "")] = found
            walk(child, turned, own)

    for world in root.findall("worldbody"):
        walk(world, np.eye(3), None)
    return bodies


def _moves(body: Element) -> bool:
    return any(child.tag in ("joint", "freejoint") for child in body)


def _mjcf_shape(
    source: _Source,
    attributes: Mapping[str, str],
    meshes: Mapping[str, Mapping[str, str]],
    compiler: Mapping[str, str],
    body: Pose,
    own: Pose,
) -> Shape:
    def read() -> Array:
        where = f"{source.file}: <geom name='{attributes.get('name', '')}'>"
        kind = attributes.get("type", "mesh" if "mesh" in attributes else "sphere")
        at = body @ own
        if kind in ("mesh", "sdf"):
            name = attributes.get("mesh", "")
            if name not in meshes or "file" not in meshes[name]:
                raise FootError(f"{where} names mesh '{name}', which is no <asset> with a file")
            mesh = meshes[name]
            folder = compiler.get("meshdir", compiler.get("assetdir", ""))
            stated = Path(mesh["file"])
            stated = Path(stated.name) if compiler.get("strippath", "false") == "true" else stated
            place = source.file.parent / folder / stated
            triangles = source.mesh(named_file(place, folders_of_model(source.file), FootError, where))
            origin = _numbers(mesh.get("refpos"), (0.0, 0.0, 0.0), where)
            turn = mjcf_rotation({"quat": mesh.get("refquat", "1 0 0 0")}, False, "xyz", where)
            scale = _numbers(mesh.get("scale"), (1.0, 1.0, 1.0), where)
            return at.moved((triangles * scale - origin[:3]) @ turn)
        size = _numbers(attributes.get("size"), (), where)
        if "fromto" in attributes:
            ends = _numbers(attributes["fromto"], (0.0,) * 6, where)
            along = ends[:3] - ends[3:6]
            half = 0.5 * float(np.linalg.norm(along))
            turn = mjcf_rotation({"zaxis": " ".join(str(v) for v in along)}, False, "xyz", where)
            at = body @ Pose(0.5 * (ends[:3] + ends[3:6]), turn)
            size = np.array([size[0], size[0], half] if kind in ("box", "ellipsoid") else [*size[:1], half])
        return at.moved(primitive(kind, size, where))

    return read
