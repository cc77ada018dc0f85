"""A robot's model as its author left it, MJCF or URDF."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import mujoco
import numpy as np

from plantar.errors import RobotError
from plantar.files.model_files import check_model, mesh_of_urdf, parsed_model
from plantar.robots.model_file import forget_own_simulation
from plantar.sim.survey.body_surface import SHAPES
from plantar.sim.survey.surface_file import meshes_for_mujoco

# How MuJoCo must read a URDF: with what is drawn, link by link, and with links that have no mass
_URDF_COMPILER = {
    "strippath": "false",
    "discardvisual": "false",
    "fusestatic": "false",
    "balanceinertia": "true",
    "boundmass": "1e-9",
    "boundinertia": "1e-12",
}

_COORDINATES = {mujoco.mjtJoint.mjJNT_FREE: 7, mujoco.mjtJoint.mjJNT_BALL: 4}  # of a keyframe; other joints have one
_LOOPS = (mujoco.mjtEq.mjEQ_CONNECT, mujoco.mjtEq.mjEQ_WELD)


@dataclass(frozen=True)
class ModelSource:
    """A compiled model, and what else its file states, by joint.

    Attributes:
        model: The model with all joints, without motors or constraints.
        efforts: Largest torque in N m, where limited.
        speeds: Largest speed in rad/s, where limited.
        gains: Stiffness in N m/rad and damping in N m s/rad of position servos.
        imus: "site" or "body" and name of possible IMUs: with a gyro, with an accelerometer, called IMU.
        coupled: Pairs of joint names, of which the first follows the second.
        loops: Pairs of bodies tied outside the tree of joints.
        upper_posture: Joint angles of the first keyframe, or empty.
        notes: What was left out or changed.
    """

    file: Path
    name: str
    model: Any
    efforts: Mapping[str, float]
    speeds: Mapping[str, float]
    gains: Mapping[str, tuple[float, float]]
    imus: tuple[tuple[str, str], ...]
    coupled: tuple[tuple[str, str], ...]
    loops: tuple[tuple[str, str], ...]
    upper_posture: Mapping[str, float]
    notes: tuple[str, ...]


@dataclass
class _Stated:
    efforts: dict[str, float] = field(default_factory=dict)
    speeds: dict[str, float] = field(default_factory=dict)
    gains: dict[str, tuple[float, float]] = field(default_factory=dict)
    coupled: list[tuple[str, str]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


def read_model(file: Path, folder: Path) -> ModelSource:
    """Returns a robot's model.

    Args:
        file: MJCF (.xml, .mjcf) or URDF (.urdf, .xml) of a robot or scene.
        folder: For converted meshes.

    Raises:
        RobotError: If unreadable, or with files outside its place.
    """
    check_model(file, RobotError)
    stated = _Stated()
    root = parsed_model(file, RobotError)
    urdf = _urdf_text(root, file, folder, stated) if root.tag == "robot" else ""
    try:
        spec = mujoco.MjSpec.from_string(urdf) if urdf else mujoco.MjSpec.from_file(str(file))
    except Exception as error:  # MuJoCo's parser raises ValueError, OSError and its own errors
        raise RobotError(f"{file}: cannot be read: {' '.join(str(error).split())}") from None
    _name_all(spec)
    posture = _first_keyframe(spec)
    _drop_other_things(spec, stated.notes)
    _drop_unreadable(spec, file, folder, stated.notes)
    loops = [(e.name1, e.name2) for e in spec.equalities if e.type in _LOOPS]
    stated.coupled += [(e.name1, e.name2) for e in spec.equalities if e.type == mujoco.mjtEq.mjEQ_JOINT and e.name2]
    _collect_motors(spec, stated)
    imus = _imus_of(spec)
    forget_own_simulation(spec)
    model = _compiled(spec, file)
    return ModelSource(
        file=file,
        name=spec.modelname if spec.modelname not in ("", "MuJoCo Model") else file.stem,
        model=model,
        efforts=stated.efforts,
        speeds=stated.speeds,
        gains=stated.gains,
        imus=imus,
        coupled=tuple(stated.coupled),
        loops=tuple((_body_of(model, a), _body_of(model, b)) for a, b in loops),
        upper_posture=posture,
        notes=tuple(stated.notes),
    )


def _urdf_text(root: ElementTree.Element, file: Path, folder: Path, stated: _Stated) -> str:
    drawn = [
        (link, shape, mesh, mesh_of_urdf(file, mesh.get("filename", ""), RobotError, f"{file}: <{shape.tag}>"))
        for link in root.iter("link")
        for shape in [*link.findall("visual"), *link.findall("collision")]
        for mesh in shape.findall("geometry/mesh")[:1]
    ]
    meshes = meshes_for_mujoco((path for *_, path in drawn), folder, file)
    for link, shape, mesh, path in drawn:
        found = meshes[path]
        if found is None:
            stated.notes.append(f"{shape.tag} mesh {path.name} of link {link.get('name')} cannot be read; left out")
            link.remove(shape)
        else:
            mesh.set("filename", str(found.resolve()))
    for own in root.findall("mujoco"):
        root.remove(own)
    locked = [name for joint in root.findall("joint") if (name := _locked(joint, file))]
    if locked:
        stated.notes.append(
            f"held, as their limits leave no range (lower and upper are 0 where a URDF leaves them out): "
            f"{', '.join(locked)}"
        )
    for joint in root.findall("joint"):
        name, limit, mimic = joint.get("name", ""), joint.find("limit"), joint.find("mimic")
        if mimic is not None:
            stated.coupled.append((name, mimic.get("joint", "")))
        for key, found_limits in (("effort", stated.efforts), ("velocity", stated.speeds)):
            value = _number(None if limit is None else limit.get(key))
            if value > 0.0:
                found_limits[name] = value
    ElementTree.SubElement(ElementTree.SubElement(root, "mujoco"), "compiler", _URDF_COMPILER)
    return ElementTree.tostring(root, encoding="unicode")


def _locked(joint: ElementTree.Element, file: Path) -> str:
    """Name of a joint without range, which MuJoCo takes as unlimited; else empty.

    Raises:
        RobotError: If limits contradict.
    """
    name, limit = joint.get("name", ""), joint.find("limit")
    if joint.get("type") not in ("revolute", "prismatic") or limit is None:
        return ""
    lower, upper = _number(limit.get("lower")), _number(limit.get("upper"))
    if lower < upper:
        return ""
    if lower > upper or lower != 0.0:
        raise RobotError(
            f"{file}: joint '{name}' has limits from {lower:g} to {upper:g}; allowed: lower below upper, "
            "or a joint of type fixed"
        )
    joint.set("type", "fixed")
    return name


def _number(text: str | None) -> float:
    try:
        value = float(text or "0")
    except ValueError:
        return 0.0
    return value if math.isfinite(value) else 0.0


def _name_all(spec: Any) -> None:
    for kind, elements in (("body", spec.bodies), ("joint", spec.joints)):
        taken = {e.name for e in elements}
        for i, element in enumerate(elements):
            if not element.name:
                name = f"{kind}_{i}"
                element.name = name if name not in taken else f"{name}_of_the_model"


def _drop_other_things(spec: Any, notes: list[str]) -> None:
    things = list(spec.worldbody.bodies)
    if len(things) < 2:
        return
    robot = max(things, key=lambda t: sum(j.type == mujoco.mjtJoint.mjJNT_HINGE for j in _joints_below(t)))
    others = [thing for thing in things if thing is not robot]
    notes.append(f"left out, as they are no part of the robot: {', '.join(thing.name for thing in others)}")
    for thing in others:
        spec.delete(thing)


def _joints_below(body: Any) -> list[Any]:
    return [*body.joints, *(joint for child in body.bodies for joint in _joints_below(child))]


def _drop_unreadable(spec: Any, file: Path, folder: Path, notes: list[str]) -> None:
    for material in spec.materials:
        material.textures = [""] * len(material.textures)
    for part in ("textures", "skins", "hfields", "flexes"):
        for element in list(getattr(spec, part)):
            spec.delete(element)
    for geom in [g for g in spec.geoms if g.type in (mujoco.mjtGeom.mjGEOM_HFIELD, mujoco.mjtGeom.mjGEOM_SDF)]:
        spec.delete(geom)
    empty = [g for g in spec.geoms if _is_empty(g)]
    if empty:
        notes.append(f"{len(empty)} shapes without a size are left out")
    for geom in empty:
        spec.delete(geom)
    weighing = {g.meshname for g in spec.geoms if not g.parent.explicitinertial}
    for mesh in list(spec.meshes):  # a hull holds for open surfaces, too, but weighs more
        if mesh.inertia == mujoco.mjtMeshInertia.mjMESH_INERTIA_LEGACY and mesh.name not in weighing:
            mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX
    place = file.parent / spec.meshdir
    drawn = [(m, place / (Path(m.file).name if spec.strippath else m.file)) for m in spec.meshes if m.file]
    meshes = meshes_for_mujoco((path for _, path in drawn), folder, file)
    for mesh, path in drawn:
        found = meshes[path]
        if found is not None:
            if found != path:
                mesh.file = str(found.resolve())
            continue
        users = [g for g in spec.geoms if g.meshname == mesh.name]
        notes.append(f"mesh {path.name} cannot be read; the {len(users)} shape(s) made of it are left out")
        for geom in users:
            spec.delete(geom)
        spec.delete(mesh)


def _is_empty(geom: Any) -> bool:
    sizes = SHAPES.get(mujoco.mjtGeom(geom.type), ("", 0))[1]
    if sizes == 2 and math.isfinite(geom.fromto[0]):
        sizes = 1
    return not geom.meshname and not bool((geom.size[:sizes] > 0.0).all())


def _first_keyframe(spec: Any) -> dict[str, float]:
    qpos = next((np.array(key.qpos) for key in spec.keys if len(key.qpos)), np.zeros(0))
    places = np.cumsum([0, *(_COORDINATES.get(j.type, 1) for j in spec.joints)])
    if len(qpos) != places[-1] or not np.isfinite(qpos).all():
        return {}
    placed = zip(spec.joints, places, strict=False)
    return {j.name: float(qpos[at]) for j, at in placed if j.type == mujoco.mjtJoint.mjJNT_HINGE}


def _collect_motors(spec: Any, stated: _Stated) -> None:
    rates: dict[str, float] = {}
    for joint in spec.joints:
        bound = _bound(joint.actfrclimited, joint.actfrcrange)
        if bound < math.inf:
            stated.efforts[joint.name] = bound
    for motor in spec.actuators:
        if motor.trntype not in (mujoco.mjtTrn.mjTRN_JOINT, mujoco.mjtTrn.mjTRN_JOINTINPARENT):
            continue
        gear = abs(float(motor.gear[0])) or 1.0
        gain, rate = float(motor.gainprm[0]), float(motor.biasprm[2])
        if gain > 0.0 and motor.biasprm[1] == -gain:  # a rate above 0 is a ratio of critical, whatever the gear
            stated.gains[motor.target] = (gear**2 * gain, -rate if rate > 0.0 else -(gear**2) * rate)
        elif gain > 0.0 and rate == -gain and motor.biasprm[1] == 0.0:
            rates[motor.target] = gear**2 * gain
        limits = [stated.efforts.get(motor.target, math.inf), gear * _bound(motor.forcelimited, motor.forcerange)]
        if gain and motor.biastype == mujoco.mjtBias.mjBIAS_NONE and motor.gaintype == mujoco.mjtGain.mjGAIN_FIXED:
            limits.append(gear * abs(gain) * _bound(motor.ctrllimited, motor.ctrlrange))
        if min(limits) < math.inf:
            stated.efforts[motor.target] = min(limits)
    for name in rates.keys() & stated.gains.keys():  # a position servo that a velocity servo damps
        stiffness, damping = stated.gains[name]
        stated.gains[name] = (stiffness, damping + rates[name] if damping >= 0.0 else damping)


def _bound(limited: Any, span: Any) -> float:
    both = -float(span[0]), float(span[1])
    known = limited != mujoco.mjtLimited.mjLIMITED_FALSE and -both[0] < both[1]
    return math.inf if not known else min(both) if min(both) > 0.0 else max(map(abs, both))  # of the weaker direction


def _imus_of(spec: Any) -> tuple[tuple[str, str], ...]:
    found = []
    for kind in (mujoco.mjtSensor.mjSENS_GYRO, mujoco.mjtSensor.mjSENS_ACCELEROMETER):
        found += [("site", s.objname) for s in spec.sensors if s.type == kind and spec.site(s.objname) is not None]
    for what, elements in (("site", spec.sites), ("body", spec.bodies)):
        found += [(what, e.name) for e in elements if "imu" in e.name.lower()]
    return tuple(dict.fromkeys(found))


def _compiled(spec: Any, file: Path) -> Any:
    for attempt in ("as it is", "without collisions of meshes"):
        try:
            return spec.compile()
        except ValueError as error:
            problem = error
        for geom in spec.geoms if attempt == "as it is" else ():  # flat and broken meshes have no convex hull
            if geom.type == mujoco.mjtGeom.mjGEOM_MESH:
                geom.contype = geom.conaffinity = 0
    raise RobotError(f"{file}: cannot be simulated: {' '.join(str(problem).split())}") from None


def _body_of(model: Any, name: str) -> str:
    site = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, name) if name else -1
    body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name) if name else 0
    return str(model.body(body if body >= 0 else int(model.site_bodyid[site])).name)
