"""The mass of a robot by its model: read by MuJoCo's own reader of MJCF, and summed over the links of a URDF."""

from __future__ import annotations

import math
from importlib.util import find_spec
from pathlib import Path
from xml.etree import ElementTree

from plantar.errors import FootError
from plantar.files.model_files import check_model, parsed_model

__all__ = ["model_mass"]


def model_mass(path: Path, body: str) -> tuple[float | None, str]:
    """Mass of the robot that a body belongs to.

    In an MJCF, bodies without a stated inertia have that of their shapes, sizes and settings come from classes and
    includes: MuJoCo decides. In a URDF the links state it; MuJoCo would merge the trunk into the world.

    Args:
        path: MJCF or URDF file.
        body: Name of a body of the robot.

    Returns:
        The mass in kg, None where it cannot be told; and a note.

    Raises:
        FootError: If the file names others that lie where they may not.
    """
    root = parsed_model(path, FootError)
    if root.tag == "robot":
        mass = _urdf_mass(root)
    else:
        if find_spec("mujoco") is None:
            return None, "the robot's mass is not read: MuJoCo is not installed"
        check_model(path, FootError)
        try:
            mass = _mjcf_mass(path, body)
        except Exception as error:  # MuJoCo raises ValueError, OSError and its own
            return None, f"the robot's mass is not read: {' '.join(str(error).split())[:90]}"
    if not (math.isfinite(mass) and mass > 0.0):
        return None, "the robot's model states no mass"
    return mass, f"the robot's mass is {mass:.4g} kg, of its model"


def _mjcf_mass(path: Path, body: str) -> float:
    """Mass in kg of the tree of bodies that a body belongs to; 0 where there is none of that name."""
    import mujoco

    try:
        model = mujoco.MjSpec.from_file(str(path)).compile()
    except ValueError:  # a mesh is not there: of bodies that state their inertia it weighs nothing
        spec = mujoco.MjSpec.from_file(str(path))
        meshes = [(b, g) for b in spec.bodies for g in b.geoms if g.type == mujoco.mjtGeom.mjGEOM_MESH]
        if not all(b.explicitinertial for b, _ in meshes):
            raise
        for thing in [*(g for _, g in meshes), *spec.meshes]:
            spec.delete(thing)
        model = spec.compile()
    found = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, body)
    return float(model.body_subtreemass[model.body_rootid[found]]) if found >= 0 else 0.0


def _urdf_mass(root: ElementTree.Element) -> float:
    """Sum of the masses of all links in kg; not a number where one is none."""
    try:
        return sum(float(m.get("value", "nan")) for m in root.findall("link/inertial/mass"))
    except ValueError:
        return math.nan
