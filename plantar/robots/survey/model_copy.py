"""A copy of a robot's model as it walks: upright floating base, leg joints, the rest held."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.atomic import write_text
from plantar.mujoco.mesh_surface import mesh_surface
from plantar.mujoco.quaternions import quaternion_of
from plantar.robots.survey.body_surface import SHAPES
from plantar.robots.survey.leg_chains import Legs
from plantar.robots.survey.surface_file import simplified, stl_bytes

MESH_FOLDER = "meshes"
"""Folder of its meshes, next to the copy."""

UPRIGHT = "upright"
"""Body that is put above one whose own axes are turned: x forward, y left, z up in the robot's posture."""

_CELLS = 40  # along the longest side of a mesh that is only looked at


def write_model_copy(
    model: Any,
    legs: Legs,
    folder: Path,
    name: str,
    held: Mapping[str, float],
    imu: tuple[str, str, str] | None,
) -> str:
    """Write the copy and its simplified meshes; returns the upright body's name.

    `folder`: for "model.xml" and meshes; `held`: angles in rad by name of other joints; the rest as in the file; `imu`:
    "site" or "body" of IMU, its name, and name of the copy's site; or None.
    """
    return _Copy(model, legs, folder, held).written(name, imu)


def add_rotors(file: Path, rotors: Mapping[str, float]) -> None:
    """Give joints of copy `file` the inertia `rotors` in kg m^2, by name."""
    root = ElementTree.fromstring(file.read_text(encoding="utf-8"))
    for joint in root.iter("joint"):
        if joint.get("name") in rotors:
            joint.set("armature", f"{rotors[joint.get('name', '')]:.9g}")
    write_text(file, ElementTree.tostring(root, encoding="unicode") + "\n")


class _Copy:
    def __init__(self, model: Any, legs: Legs, folder: Path, held: Mapping[str, float]) -> None:
        self.model = model
        self.legs = legs
        self.folder = folder
        self.hinges = {j for leg in legs.by_side.values() for j in leg.joints}
        self.feet = frozenset(b for leg in legs.by_side.values() for b in leg.parts)
        self.meshes: dict[int, str] = {}
        data = mujoco.MjData(model)
        for joint in range(model.njnt):
            angle = held.get(model.joint(joint).name)
            if angle is not None and joint not in self.hinges:
                data.qpos[model.jnt_qposadr[joint]] = angle
        mujoco.mj_kinematics(model, data)
        self.positions = data.xpos
        self.rotations = data.xmat.reshape(-1, 3, 3)

    def written(self, name: str, imu: tuple[str, str, str] | None) -> str:
        model = self.model
        legs = self.legs
        root = Element("mujoco", model=name)
        SubElement(root, "compiler", angle="radian", autolimits="true", meshdir=MESH_FOLDER, balanceinertia="true")
        assets = SubElement(root, "asset")
        world = SubElement(root, "worldbody")
        top = int(model.body_rootid[legs.pelvis])
        turned = legs.rotation @ self.rotations[top]
        upright = model.body(top).name
        parent = world
        base = np.array([0.0, 0.0, self._height(top)])
        if not np.allclose(turned, np.eye(3), atol=1e-4):
            upright = UPRIGHT if UPRIGHT not in {model.body(i).name for i in range(model.nbody)} else f"{UPRIGHT}_base"
            parent = SubElement(world, "body", name=upright, pos=_text(base))
            base = np.zeros(3)
        self._body(parent, top, base, turned)
        taken = "root" in {model.joint(joint).name for joint in self.hinges}
        world[0].insert(0, Element("freejoint", {} if taken else {"name": "root"}))
        if imu is not None:
            self._imu(root, *imu)
        if not self.meshes:
            root.remove(assets)
        for file in self.meshes.values():
            SubElement(assets, "mesh", name=Path(file).stem, file=file, inertia="shell")
        ElementTree.indent(root)
        write_text(self.folder / "model.xml", ElementTree.tostring(root, encoding="unicode") + "\n")
        return str(upright)

    def _height(self, top: int) -> float:
        ankle = min(float((self.legs.rotation @ leg.ankle)[2]) for leg in self.legs.by_side.values())
        return 1.2 * (float((self.legs.rotation @ self.positions[top])[2]) - ankle)

    def _body(self, parent: Element, body: int, position: NDArray[np.float64], rotation: Any) -> None:
        model = self.model
        element = SubElement(
            parent, "body", name=model.body(body).name, pos=_text(position), quat=_text(quaternion_of(rotation))
        )
        if model.body_mass[body] > 0.0:
            SubElement(
                element,
                "inertial",
                pos=_text(model.body_ipos[body]),
                quat=_text(model.body_iquat[body]),
                mass=f"{model.body_mass[body]:.9g}",
                diaginertia=_text(np.maximum(model.body_inertia[body], 1e-12)),
            )
        first = int(model.body_jntadr[body])
        count = int(model.body_jntnum[body])
        for joint in range(first, first + count):
            if joint in self.hinges:
                self._joint(element, joint)
        for geom in np.flatnonzero(model.geom_bodyid == body).tolist():
            self._geom(element, geom)
        for child in np.flatnonzero(model.body_parentid == body).tolist():
            if child != body and child != 0:
                back = self.rotations[body].T
                at = back @ (self.positions[child] - self.positions[body])
                self._body(element, child, at, back @ self.rotations[child])

    def _joint(self, element: Element, joint: int) -> None:
        model = self.model
        dof = int(model.jnt_dofadr[joint])
        attributes = {"pos": _text(model.jnt_pos[joint]), "axis": _text(model.jnt_axis[joint])}
        if model.jnt_limited[joint]:
            attributes["range"] = _text(model.jnt_range[joint])
        if model.qpos0[model.jnt_qposadr[joint]]:
            attributes["ref"] = f"{model.qpos0[model.jnt_qposadr[joint]]:.9g}"
        for key, values in (
            ("damping", model.dof_damping),
            ("armature", model.dof_armature),
            ("frictionloss", model.dof_frictionloss),
        ):
            if values[dof]:
                attributes[key] = f"{values[dof]:.9g}"
        SubElement(element, "joint", {"name": model.joint(joint).name, **attributes})

    def _geom(self, element: Element, geom: int) -> None:
        model = self.model
        kind = int(model.geom_type[geom])
        body = int(model.geom_bodyid[geom])
        attributes = {"pos": _text(model.geom_pos[geom]), "quat": _text(model.geom_quat[geom]), "type": "mesh"}
        if kind == mujoco.mjtGeom.mjGEOM_MESH:
            attributes["mesh"] = Path(self._mesh(int(model.geom_dataid[geom]), body in self.feet)).stem
        elif kind in SHAPES:
            name, sizes = SHAPES[mujoco.mjtGeom(kind)]
            attributes |= {"type": name, "size": _text(model.geom_size[geom][:sizes])}
        else:
            return
        collides = bool(model.geom_contype[geom] or model.geom_conaffinity[geom])
        drawn = (model.geom_contype == 0) & (model.geom_conaffinity == 0) & (model.geom_bodyid == body)
        if not collides or kind == mujoco.mjtGeom.mjGEOM_MESH:  # legs collide by simple shapes, soles by their boxes
            attributes |= {"contype": "0", "conaffinity": "0"}
        attributes["group"] = "3" if collides and drawn.any() else "1"
        material = int(model.geom_matid[geom])
        attributes["rgba"] = _text(model.mat_rgba[material] if material >= 0 else model.geom_rgba[geom])
        SubElement(element, "geom", attributes)

    def _mesh(self, mesh: int, whole: bool) -> str:
        if mesh not in self.meshes:
            corners, faces = mesh_surface(self.model, mesh)
            triangles = corners[faces]
            fewer = triangles if whole else simplified(triangles, _CELLS)
            triangles = fewer if len(fewer) >= 4 else triangles
            (self.folder / MESH_FOLDER).mkdir(exist_ok=True)
            self.meshes[mesh] = f"mesh_{mesh}.stl"
            (self.folder / MESH_FOLDER / self.meshes[mesh]).write_bytes(stl_bytes(triangles))
        return self.meshes[mesh]

    def _imu(self, root: Element, kind: str, name: str, site: str) -> None:
        model = self.model
        body = model.body(name).id if kind == "body" else int(model.site(name).bodyid[0])
        own = model.site(name) if kind == "site" else None
        at, turn = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0)) if own is None else (own.pos, own.quat)
        wearers = (e for e in root.iter("body") if e.get("name") == model.body(body).name)
        SubElement(next(wearers), "site", name=site, pos=_text(at), quat=_text(turn))


def _text(values: Any) -> str:
    return " ".join(f"{float(v) + 0.0:.9g}" for v in values)
