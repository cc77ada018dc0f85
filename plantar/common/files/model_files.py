"""Allowed places of files that a robot's file names: only files that came with it.

- A robot TOML names files in its own folder and below.
- A model (MJCF, URDF) also in the folder above it, unless that is, or holds, the home folder or that of temporary
  files.
- `package://name/...` is looked for in the folders above the model whose package.xml states that name, or that are
  called so.
- Folders in the environment variable PLANTAR_MODEL_FOLDERS (separated as PATH is) are allowed in addition.
"""

import os
import re
import tempfile
from collections.abc import Iterable
from importlib.util import find_spec
from itertools import product
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element

from plantar.common.files.gate import read_apart
from plantar.common.files.image_size import stated_size
from plantar.common.files.input_file import check_input, open_input, read_input
from plantar.common.files.model_limits import MOST_PARTS, check_model_size, quiet_mujoco
from plantar.common.files.xml_file import XML_MOST, parse_xml
from plantar.errors import PlantarError

VARIABLE = "PLANTAR_MODEL_FOLDERS"
"""Environment variable with folders from which models may take files, too."""

_MOST_INCLUDES = 100
_LARGEST_PART = 100e6  # bytes of a mesh, or of a texture or height field once it is unpacked
_PASSED: set[tuple[Path, int]] = set()
_OWN = Path(__file__).resolve().parents[2]


def named_file(path: Path, folders: tuple[Path, ...], error: type[PlantarError], where: str) -> Path:
    """Returns path of a file named by another, if it lies in `folders`, links followed, or below.

    Else raises `error`, naming `where`.

    Example:
        >>> named_file(Path("/etc/passwd"), (Path("/robots/mine"),), PlantarError, "robot.toml")
        Traceback (most recent call last):
        plantar.errors.PlantarError: robot.toml: names /etc/passwd, ...
    """
    try:
        place = path.resolve()
    except (OSError, RuntimeError, ValueError) as problem:
        raise error(f"{where}: names {path}, which cannot be read ({problem})") from None
    allowed = (*(f.resolve() for f in folders), *_besides())
    if not any(place.is_relative_to(folder) for folder in allowed):
        shown = ", ".join(str(f) for f in allowed)
        raise error(f"{where}: names {path}, which lies elsewhere; allowed: files in {shown} (set {VARIABLE} for more)")
    return path


def _besides() -> tuple[Path, ...]:
    return tuple(Path(text).resolve() for text in os.environ.get(VARIABLE, "").split(os.pathsep) if text)


def _is_a_package(folder: Path) -> bool:
    """Whether a folder can be one robot's: not the home or temporary folder."""
    common = [Path(tempfile.gettempdir()).resolve()]
    home = os.path.expanduser("~")
    common += [Path(home).resolve()] if home != "~" else []
    return not any(place.is_relative_to(folder) for place in common)


def folders_of_model(file: Path) -> tuple[Path, ...]:
    """Folders for a model's files: its own, and the one above where that is a package.

    Example:
        >>> [f.as_posix() for f in folders_of_model(Path("/robots/mine/xml/mine.xml"))]
        ['/robots/mine/xml', '/robots/mine']
    """
    own = file.parent.resolve()
    return (own, own.parent) if own != own.parent and _is_a_package(own.parent) else (own,)


def mesh_of_urdf(file: Path, name: str, error: type[PlantarError], where: str) -> Path:
    """Returns path, perhaps missing, of mesh `name` of a URDF `file`; `package://` is found in the folders above it.

    Raises `error`, naming `where`, for forbidden places.

    Example:
        >>> mesh_of_urdf(Path("/robots/mine/mine.urdf"), "foot.stl", PlantarError, "mine.urdf").as_posix()
        '/robots/mine/foot.stl'
    """
    plain = re.sub(r"^(package|model|file)://", "", name)
    own = folders_of_model(file)
    if not name.startswith(("package:", "model:")):
        return named_file(file.parent / plain, own, error, where)
    plain = plain.lstrip("/")  # of package:///name/..., which other readers take, too
    parts = Path(plain).parts
    inside = Path(*parts[1:]) if len(parts) > 1 else Path(plain)
    above = tuple(f for f in file.resolve().parents if parts and _is_called(f, parts[0]) and _is_a_package(f))
    allowed = (*own, *above)
    for folder in (file.parent, *allowed, *(f.parent for f in above), *_besides()):
        for candidate in (folder / plain, folder / inside):
            if os.path.isfile(candidate):
                return named_file(candidate, allowed, error, where)
    return named_file(file.parent / inside, allowed, error, where)


def _is_called(folder: Path, name: str) -> bool:
    """Whether a folder is the ROS package of a name: by its package.xml, or where it has none by its own name."""
    manifest = folder / "package.xml"
    if not manifest.is_file():
        return folder.name == name
    try:
        stated = parse_xml(read_input(manifest, PlantarError, XML_MOST), PlantarError, str(manifest)).findtext("name")
    except PlantarError:
        return folder.name == name
    return name in ((stated or "").strip(), folder.name)


def mesh_of_mjcf(file: Path, spec: Any, mesh: Any, attached: Iterable[Path], error: type[PlantarError]) -> Path:
    """Returns path, perhaps missing, of a `mesh` of MJCF `file`, read as `spec`, with models `attached`.

    Raises `error` for forbidden places.
    """
    name = re.split(r"[/\\]", mesh.file)[-1] if spec.strippath else mesh.file
    places = [path.parent / mesh.compiler.meshdir / name for path in (file, *attached)]
    found = next((place for place in places if place.is_file()), places[0])
    return named_file(found, folders_of_model(file), error, f"{file}: <mesh name='{mesh.name}'>")


def attached_models(file: Path, root: Element) -> list[Path]:
    """Returns models that MJCF `file`, outermost element `root`, attaches."""
    return [file.parent / element.get("file", "") for element in root.iter("model") if element.get("file")]


def parsed_model(file: Path, error: type[PlantarError]) -> Element:
    """Returns outermost element of an MJCF or URDF `file`, with MJCF includes in place.

    Raises `error` if a file is unreadable, no XML, included twice, or in a forbidden place.

    Example:
        >>> parsed_model(Path("none.xml"), PlantarError)
        Traceback (most recent call last):
        plantar.errors.PlantarError: none.xml: cannot be read (No such file or directory)
    """
    return _included(file, file, set(), error)


def files_of_model(file: Path, error: type[PlantarError]) -> set[Path]:
    """Returns full paths of an MJCF or URDF file and its includes; error as of `parsed_model`."""
    seen: set[Path] = set()
    _included(file, file, seen, error)
    return seen


def _included(file: Path, main: Path, seen: set[Path], error: type[PlantarError]) -> Element:
    place = Path(os.path.realpath(file))
    if place in seen:
        raise error(f"{file}: is included twice, or includes itself; allowed: each file once")
    if len(seen) > _MOST_INCLUDES:
        raise error(f"{main}: includes more than {_MOST_INCLUDES} files")
    seen.add(place)
    root = parse_xml(read_input(file, error, XML_MOST), error, str(file))
    if root.tag == "robot":
        for compiler, mesh in product(root.findall("mujoco/compiler"), root.findall("link/*/geometry/mesh")):
            drawn = Path(mesh.get("filename", ""))
            inside = Path(compiler.get("meshdir", ""), drawn.name)  # where MuJoCo takes it from
            if not (file.parent / drawn).is_file() and (file.parent / inside).is_file():
                mesh.set("filename", str(inside))
        return root
    for parent in list(root.iter()):
        for index, child in reversed(list(enumerate(parent))):
            if child.tag == "include":
                name = child.get("file", "")
                # MuJoCo takes it from the main file's folder; from the including one's where only that has it.
                found = next((p for p in (main.parent / name, file.parent / name) if p.exists()), main.parent / name)
                named_file(found, folders_of_model(main), error, str(file))
                parent[index : index + 1] = list(_included(found, main, seen, error))
    return root


def check_model(file: Path, error: type[PlantarError]) -> None:
    """Refuse models of too many parts or with files in other places; foreign ones are tried in MuJoCo first.

    Raises class `error`.

    Example:
        >>> check_model(Path("none.xml"), PlantarError)
        Traceback (most recent call last):
        plantar.errors.PlantarError: none.xml: cannot be read (No such file or directory)
    """
    _check_names(file, error, {Path(os.path.realpath(file))})
    if find_spec("mujoco") is not None:
        quiet_mujoco()
        key = file.resolve(), file.stat().st_mtime_ns
        if key not in _PASSED and not key[0].is_relative_to(_OWN):
            if (bodies := int(read_apart("model", file, error)["bodies"])) > MOST_PARTS:
                raise error(f"{file}: has {bodies} bodies; allowed: up to {MOST_PARTS} of a robot's model")
            _PASSED.add(key)


def _check_names(file: Path, error: type[PlantarError], seen: set[Path]) -> None:
    root = parsed_model(file, error)
    check_model_size(root, error, str(file))
    compiler = {k: v for element in root.iter("compiler") for k, v in element.attrib.items()}
    urdf = root.tag == "robot"
    strip = compiler.get("strippath", "true" if urdf else "false") == "true"  # MuJoCo's own defaults
    inside = [compiler[key] for key in ("meshdir", "texturedir", "assetdir") if key in compiler] or [""]
    folders = folders_of_model(file)
    for element in root.iter():
        for key, name in element.attrib.items():
            if not key.startswith("file") or not name:
                continue
            where = f"{file}: <{element.tag}>"
            if urdf and not strip:
                mesh_of_urdf(file, name, error, where)
            for folder in inside:
                path = file.parent / folder / (re.split(r"[/\\]", name)[-1] if strip else name)
                if not urdf or strip:
                    named_file(path, folders, error, where)
                    _check_size(path, element.tag, error, where)
            nested = Path(os.path.realpath(file.parent / name))
            if element.tag == "model" and nested not in seen and os.path.isfile(nested):
                seen.add(nested)
                if len(seen) > _MOST_INCLUDES:
                    raise error(f"{file}: names more than {_MOST_INCLUDES} models")
                named_file(nested, folders, error, where)
                _check_names(nested, error, seen)


def _check_size(path: Path, tag: str, error: type[PlantarError], where: str) -> None:
    """Refuse a mesh, height field or texture that is too large or no file; missing ones are the reader's."""
    if tag not in ("mesh", "hfield", "texture", "skin") or not os.path.exists(path):
        return
    check_input(path, error, _LARGEST_PART, f"{where}: {path}")
    if tag != "mesh":
        with open_input(path, error) as stream:
            size = stated_size(stream.read(1 << 16))
        if size is not None and size.memory > _LARGEST_PART:
            raise error(
                f"{where}: {path} takes {size.memory / 1e6:.0f} MB; allowed: up to {_LARGEST_PART / 1e6:.0f} MB"
            )
