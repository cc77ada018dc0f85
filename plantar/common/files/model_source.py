"""A robot's model file, MJCF or URDF, through MuJoCo's reader."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from plantar.common.files.model_files import attached_models, check_model, mesh_of_mjcf, mesh_of_urdf, parsed_model
from plantar.common.files.model_limits import quiet_mujoco, spec_of_file
from plantar.common.optional_library import optional_library
from plantar.errors import PlantarError

BELOW = "plantar_world"
"""Link that is put below the outermost ones of a URDF that has several: no body of the robot."""

LEAST = 1e-9
"""Mass in kg and inertia in kg m^2 that bodies of a URDF have at least: MuJoCo wants bodies that move to have some."""

_SETTINGS = ("option", "size", "visual", "statistic")
"""Parts of an MJCF that describe its simulation, and no robot; what they may hold changes with MuJoCo."""

_COMPILER = {"discardvisual": "false", "fusestatic": "false", "strippath": "true"}
_WORLD = "world"


@dataclass(frozen=True)
class ModelSource:
    """A checked model file. MuJoCo's editable model is made of it as often as needed.

    `root`: outermost element, of a URDF as MuJoCo is given it; `mesh_names`: of a URDF, what it calls each mesh that
    MuJoCo knows by another name; `attached`: models that an MJCF attaches; `error`: class of what is raised.
    """

    file: Path
    root: Element
    error: type[PlantarError]
    mesh_names: dict[str, str]
    attached: tuple[Path, ...]

    @property
    def is_urdf(self) -> bool:
        """Whether the file is a URDF."""
        return self.root.tag == "robot"

    def spec(self) -> Any:
        """MuJoCo's editable model, link by link, with what is drawn."""
        with optional_library("mujoco", "sim"):
            mujoco = quiet_mujoco()
        try:
            if not self.is_urdf:
                return self._mjcf(mujoco)
            spec = mujoco.MjSpec.from_string(ElementTree.tostring(self.root, encoding="unicode"))
        except Exception as problem:  # MuJoCo raises ValueError, OSError and its own
            text = " ".join(str(problem).split())
            raise self.error(f"{self.file}: cannot be read as a robot's model: {text}") from None
        spec.compiler.balanceinertia = True
        spec.compiler.boundmass = LEAST
        spec.compiler.boundinertia = LEAST
        return spec

    def _mjcf(self, mujoco: Any) -> Any:
        """Of an MJCF; without what it sets of its simulation where that is of another MuJoCo than the one here."""
        try:
            return spec_of_file(self.file)
        except ValueError as problem:
            if "Schema violation" not in str(problem):
                raise
            for part in _SETTINGS:
                for element in self.root.findall(part):
                    self.root.remove(element)
            spec = mujoco.MjSpec.from_string(ElementTree.tostring(self.root, encoding="unicode"))
            spec.modelfiledir = str(self.file.parent)
            return spec

    def mesh_path(self, spec: Any, mesh: Any) -> Path:
        """Path, perhaps missing, of a `mesh` of this file's `spec`."""
        if not self.is_urdf:
            return mesh_of_mjcf(self.file, spec, mesh, self.attached, self.error)
        where = f"{self.file}: <mesh name='{mesh.name}'>"
        return mesh_of_urdf(self.file, self.mesh_names.get(mesh.file, mesh.file), self.error, where)


def read_model_source(file: Path, error: type[PlantarError]) -> ModelSource:
    """Check a model file: its size, numbers, outermost element, and the places of the files that it names.

    Raises `error`.

    Example:
        >>> read_model_source(Path("none.xml"), PlantarError)
        Traceback (most recent call last):
        plantar.errors.PlantarError: none.xml: cannot be read (No such file or directory)
    """
    check_model(file, error)
    root = parsed_model(file, error)
    if root.tag == "robot":
        names = _prepare_urdf(root)
        if names is None:
            raise error(f"{file}: holds no link that hangs on none; allowed: a tree of links and joints")
        return ModelSource(file, root, error, names, ())
    if root.tag != "mujoco":
        raise error(f"{file}: the outermost element is <{root.tag}>; allowed: <mujoco> (MJCF), <robot> (URDF)")
    for element in root.iter():
        for key, text in element.attrib.items():
            if key not in ("name", "class") and "nan" in text.lower().split():
                raise error(f"{file}: <{element.tag}>: {key} is '{text[:40]}'; allowed: finite numbers")
    return ModelSource(file, root, error, {}, tuple(attached_models(file, root)))


def _prepare_urdf(root: Element) -> dict[str, str] | None:
    """Make a URDF one that MuJoCo reads whole; returns each mesh's own name, or None where all links hang on another.

    MuJoCo merges meshes of equal file name, knows no packages, and wants one root. So each mesh file gets a name, and
    several roots hang on a link below.

    Example:
        >>> link = '<link name="a"><visual><geometry><mesh filename="package://b/c.dae"/></geometry></visual></link>'
        >>> _prepare_urdf(ElementTree.fromstring(f"<robot>{link}</robot>"))
        {'mesh_0.stl': 'package://b/c.dae'}
    """
    given: dict[str, str] = {}
    for mesh in root.iterfind("link/*/geometry/mesh"):
        own = mesh.get("filename", "")
        mesh.set("filename", given.setdefault(own, f"mesh_{len(given)}.stl"))
    for settings in root.findall("mujoco"):
        root.remove(settings)
    children = {child.get("link", "") for child in root.iterfind("joint/child")}
    tops = [name for name in (link.get("name", "") for link in root.findall("link")) if name not in children]
    if not tops:
        return None
    if len(tops) > 1:
        _rename_world(root)
        root.insert(0, ElementTree.Element("link", {"name": BELOW}))
        for i, top in enumerate(_WORLD + "_link" if top == _WORLD else top for top in tops):
            joint = ElementTree.SubElement(root, "joint", {"name": f"{BELOW}_{i}", "type": "fixed"})
            ElementTree.SubElement(joint, "parent", {"link": BELOW})
            ElementTree.SubElement(joint, "child", {"link": top})
    ElementTree.SubElement(ElementTree.SubElement(root, "mujoco"), "compiler", _COMPILER)
    return {name: own for own, name in given.items()}


def _rename_world(root: Element) -> None:
    """Rename a link called "world", reserved by MuJoCo."""
    places = [(link, "name") for link in root.findall("link")]
    places += [(end, "link") for tag in ("parent", "child") for end in root.iterfind(f"joint/{tag}")]
    for element, key in places:
        if element.get(key) == _WORLD:
            element.set(key, f"{_WORLD}_link")
