"""A URDF as MuJoCo reads it: all links kept, meshes renamed."""

from __future__ import annotations

from xml.etree import ElementTree

__all__ = ["BELOW", "urdf_for_mujoco"]

_COMPILER = {"discardvisual": "false", "fusestatic": "false", "strippath": "true"}
_WORLD = "world"

BELOW = "plantar_world"
"""Name of the link that is put below the outermost ones: no body of the robot."""


def urdf_for_mujoco(root: ElementTree.Element) -> tuple[str | None, dict[str, str]]:
    """The text of a URDF for MuJoCo's reader.

    MuJoCo merges the root link into the world, and meshes of the same file name in two folders; it knows no packages.
    So the root hangs on a link above, and each mesh gets a name.

    Returns:
        The text, None where every link hangs on another; and the URDF's name of each mesh.

    Example:
        >>> link = '<link name="a"><visual><geometry><mesh filename="package://b/c.dae"/></geometry></visual></link>'
        >>> urdf_for_mujoco(ElementTree.fromstring(f"<robot>{link}</robot>"))[1]
        {'mesh_0.stl': 'package://b/c.dae'}
    """
    names: dict[str, str] = {}
    for mesh in root.iterfind("link/*/geometry/mesh"):
        name = f"mesh_{len(names)}.stl"
        names[name] = mesh.get("filename", "")
        mesh.set("filename", name)
    for own in root.findall("mujoco"):
        root.remove(own)
    children = {c.get("link", "") for c in root.iterfind("joint/child")}
    tops = [link.get("name", "") for link in root.findall("link") if link.get("name", "") not in children]
    if not tops:
        return None, {}
    if tops != [_WORLD]:
        _rename_world(root)
        root.insert(0, ElementTree.Element("link", {"name": BELOW}))
        for i, top in enumerate(_WORLD + "_link" if t == _WORLD else t for t in tops):
            joint = ElementTree.SubElement(root, "joint", {"name": f"{BELOW}_{i}", "type": "fixed"})
            ElementTree.SubElement(joint, "parent", {"link": BELOW})
            ElementTree.SubElement(joint, "child", {"link": top})
    ElementTree.SubElement(ElementTree.SubElement(root, "mujoco"), "compiler", _COMPILER)
    return ElementTree.tostring(root, encoding="unicode"), names


def _rename_world(root: ElementTree.Element) -> None:
    """Rename a link called "world", a name that MuJoCo reserves."""
    places = [(e, "name") for e in root.findall("link")]
    places += [(e, "link") for tag in ("parent", "child") for e in root.iterfind(f"joint/{tag}")]
    for element, key in places:
        if element.get(key) == _WORLD:
            element.set(key, f"{_WORLD}_link")
