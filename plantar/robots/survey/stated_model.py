"""A robot's model as its author left it, MJCF or URDF."""

import math
import re
import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import mujoco
import numpy as np

from plantar.common.files.model_source import BELOW, ModelSource, read_model_source
from plantar.errors import RobotError
from plantar.mujoco.deletion import delete_all
from plantar.robots.model_file import forget_own_simulation
from plantar.robots.survey.body_surface import SHAPES
from plantar.robots.survey.leg_chains import LEAST_JOINTS
from plantar.robots.survey.surface_file import meshes_for_mujoco
from plantar.robots.survey.wishes import angles_of, found

_COORDINATES = {mujoco.mjtJoint.mjJNT_FREE: 7, mujoco.mjtJoint.mjJNT_BALL: 4}  # of a keyframe; other joints have one
_MOST_TURNED = 20.0  # rad, three turns: hinges of robots have 10 at most, and in degrees a knee or hip has 45 or more
_IN_DEGREES = 720.0  # what is larger stands for no limit
_LIMITS = {"": "limits", "actfrc": "torque limits", "force": "force limits", "ctrl": "control limits"}
_IMU = re.compile(r"(?<![a-z])imu(?![a-z])|Imu(?![a-z])|(?<![A-Z])IMU(?![A-Z]{2})")  # a word, not in "maximum"
_Range = tuple[float, float]
_ANY: _Range = (-math.inf, math.inf)
_LEAST_SIDE = 1e-3  # m: of a box that stands for a link
_LOOPS = (mujoco.mjtEq.mjEQ_CONNECT, mujoco.mjtEq.mjEQ_WELD)


@dataclass(frozen=True)
class StatedModel:
    """A compiled model, and what else its file states.

    Attributes:
        model: The model with all joints, without motors or constraints.
        efforts: Largest torque in N m, where limited.
        speeds: Largest speed in rad/s, where limited.
        gains: Stiffness in N m/rad and damping in N m s/rad of position servos.
        imus: "site" or "body" and name of possible IMUs: with a gyro, with an accelerometer, called IMU.
        coupled: Pairs of joint names, of which the first follows the second.
        loops: Pairs of bodies tied outside the tree of joints.
        upper_posture: Joint angles of arms, head and waist, of the first keyframe or as stated; or empty.
        notes: What was left out or changed.
    """

    file: Path
    name: str
    model: Any
    efforts: Mapping[str, float]
    speeds: Mapping[str, float]
    gains: Mapping[str, tuple[float, float]]
    imus: tuple[tuple[str, str], ...]
    coupled: Sequence[tuple[str, str]]
    loops: tuple[tuple[str, str], ...]
    upper_posture: Mapping[str, float]
    notes: Sequence[str]


@dataclass
class _Stated:
    efforts: dict[str, float] = field(default_factory=dict)
    speeds: dict[str, float] = field(default_factory=dict)
    gains: dict[str, tuple[float, float]] = field(default_factory=dict)
    coupled: list[tuple[str, str]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


def read_stated_model(file: Path, folder: Path, posture: str | None = None) -> StatedModel:
    """Returns the model of a robot's `file`; converted meshes go to `folder`.

    `posture`: of arms, head and waist, as in `Wishes`; None for the first keyframe.
    """
    stated = _Stated()
    source = read_model_source(file, RobotError)
    if source.is_urdf:
        _read_joints(source.root, file, stated)
    spec = source.spec()
    if spec.body(BELOW) is not None:
        raise RobotError(f"{file}: several links hang on no other; allowed: one, the robot's base")
    _name_all(spec)
    _check_limits(spec, file)
    upper_posture = _upper_posture(spec, posture, str(file))
    _drop_other_things(spec, stated.notes)
    bare = _drop_unreadable(spec, source, folder, stated.notes)
    loops = [(e.name1, e.name2) for e in spec.equalities if e.type in _LOOPS and e.active]
    stated.coupled += [(e.name1, e.name2) for e in spec.equalities if e.type == mujoco.mjtEq.mjEQ_JOINT and e.name2]
    _collect_motors(spec, stated)
    stated.notes += named_note("gravity compensation is left out", [b.name for b in spec.bodies if b.gravcomp])
    imus = _imus_of(spec)
    forget_own_simulation(spec)
    with warnings.catch_warnings(record=True) as doubts:
        warnings.simplefilter("always")
        try:
            model = _compiled(spec, file)
        except RobotError as error:
            raise explained(error, stated.notes) from None
        if bare:
            stated.notes[:0] = _boxes_for_meshes(spec, model, bare)
            model = _compiled(spec, file)
    stated.notes += [str(doubt.message) for doubt in doubts]
    unweighed = [
        b.name
        for b in spec.bodies[1:]
        if source.is_urdf and not b.explicitinertial and model.body(b.name).mass[0] > 1e-3
    ]
    weight = sum(float(model.body(name).mass[0]) for name in unweighed)
    stated.notes += named_note(f"without an inertial, weighed by their shapes as water: {weight:.3g} kg", unweighed)
    return StatedModel(
        file=file,
        name=spec.modelname if spec.modelname not in ("", "MuJoCo Model") else file.stem,
        model=model,
        imus=imus,
        loops=tuple((_body_of(model, a), _body_of(model, b)) for a, b in loops),
        upper_posture=upper_posture,
        **vars(stated),
    )


def named_note(text: str, names: Sequence[str]) -> list[str]:
    """Gives text with names, if any."""
    return [f"{text}: {', '.join(names)}"] if names else []


def explained(error: RobotError, notes: Iterable[str]) -> RobotError:
    """Returns an `error` with explaining `notes`: which meshes are missing, first, and what may have led to it."""
    notes = tuple(notes)
    missing = [_shortened(note) for note in notes if note.startswith(("meshes ", "mesh "))][:1]
    causes = [n for n in notes if n.startswith("held, ") or ("cannot be" in n and not n.startswith("mesh"))]
    file, _, problem = str(error).partition(": ")
    return RobotError("; ".join([f"{file}: {'; '.join([*missing, problem])}", *causes[:3]]))


def _shortened(note: str, most: int = 3) -> str:
    """A note with its first names alone, so that it does not bury the error."""
    names = note.split(", ")
    return note if len(names) <= most else f"{', '.join(names[:most])} and {len(names) - most} more"


def _read_joints(root: ElementTree.Element, file: Path, stated: _Stated) -> None:
    """Limits and couplings that a URDF states and MuJoCo leaves out; joints without range are fixed."""
    turning = [joint for joint in root.findall("joint") if joint.get("type") in ("revolute", "continuous")]
    locked = [joint for joint in root.findall("joint") if _is_locked(joint, file)]
    unstated = all(joint in locked and not _states_range(joint) for joint in turning)
    if unstated and len(turning) >= 2 * LEAST_JOINTS:  # of two legs, which have a range
        for joint in turning:
            joint.set("type", "continuous")
        stated.notes.append("no joint's range is stated: all turn without limits, put theirs in the URDF's <limit>")
        locked = []
    for joint in locked:
        joint.set("type", "fixed")
    stated.notes += named_note(
        "held, as their limits leave no range (lower and upper are 0 where a URDF leaves them out)",
        [joint.get("name", "") for joint in locked],
    )
    for joint in root.findall("joint"):
        name = joint.get("name", "")
        limit = joint.find("limit")
        mimic = joint.find("mimic")
        if mimic is not None:
            stated.coupled.append((name, mimic.get("joint", "")))
        for key, found_limits in (("effort", stated.efforts), ("velocity", stated.speeds)):
            value = _number(None if limit is None else limit.get(key))
            if 0.0 < value < math.inf:
                found_limits[name] = value


def _is_locked(joint: ElementTree.Element, file: Path) -> bool:
    """Whether a joint has no range, which MuJoCo takes as unlimited."""
    limit = joint.find("limit")
    if joint.get("type") not in ("revolute", "prismatic") or limit is None:
        return False
    lower = _number(limit.get("lower"))
    upper = _number(limit.get("upper"))
    if -math.inf < lower < upper < math.inf:
        return False
    if not lower == upper == 0.0:
        raise RobotError(
            f"{file}: joint '{joint.get('name', '')}' has limits from {lower:g} to {upper:g}; allowed: lower below "
            "upper, or a joint of type fixed or continuous"
        )
    return True


def _states_range(joint: ElementTree.Element) -> bool:
    limit = joint.find("limit")
    return limit is not None and bool({"lower", "upper"} & set(limit.attrib))


def _number(text: str | None) -> float:
    try:
        return float(text or "0")
    except ValueError:
        return 0.0


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
    delete_all(spec, others)


def _joints_below(body: Any) -> list[Any]:
    return [*body.joints, *(joint for child in body.bodies for joint in _joints_below(child))]


def _drop_unreadable(spec: Any, source: ModelSource, folder: Path, notes: list[str]) -> dict[str, str]:
    """Take away what MuJoCo cannot read; returns missing meshes by name of the body that is left without a shape."""
    for material in spec.materials:
        material.textures = [""] * len(material.textures)
    for part in ("textures", "skins", "hfields", "flexes"):
        delete_all(spec, getattr(spec, part))
    delete_all(spec, [g for g in spec.geoms if g.type in (mujoco.mjtGeom.mjGEOM_HFIELD, mujoco.mjtGeom.mjGEOM_SDF)])
    empty = [g for g in spec.geoms if _is_empty(g)]
    if empty:
        notes.append(f"{len(empty)} shapes without a size are left out")
    delete_all(spec, empty)
    weighing = {g.meshname for g in spec.geoms if not g.parent.explicitinertial}
    for mesh in list(spec.meshes):  # a hull holds for open surfaces, too, but weighs more
        if mesh.inertia == mujoco.mjtMeshInertia.mjMESH_INERTIA_LEGACY and mesh.name not in weighing:
            mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX
    drawn = [(mesh, source.mesh_path(spec, mesh)) for mesh in spec.meshes if mesh.file]
    meshes = meshes_for_mujoco((path for _, path in drawn), folder, source.file)
    lost: dict[str, str] = {}
    unread: dict[str, int] = {}
    for mesh, path in drawn:
        readable = meshes[path]
        if readable is not None:
            mesh.file = str(readable.resolve())
            continue
        users = [g for g in spec.geoms if g.meshname == mesh.name]
        unread[path.name] = unread.get(path.name, 0) + len(users)
        lost |= {geom.parent.name: path.name for geom in users}
        delete_all(spec, [*users, mesh])
    if len(unread) == 1:
        notes.extend(
            f"mesh {name} cannot be read; the {n} shape(s) made of it are left out" for name, n in unread.items()
        )
    elif unread:
        text = (
            f"meshes cannot be read; the {sum(unread.values())} shapes made of them are left out: {', '.join(unread)}"
        )
        notes.append(_shortened(text))
    spec.strippath = False  # as it is for a URDF, MuJoCo 4 would look for these files beside the model
    return {name: mesh for name, mesh in lost.items() if not len(spec.body(name).geoms)}


def _boxes_for_meshes(spec: Any, model: Any, bare: Mapping[str, str]) -> list[str]:
    """Give each body whose meshes are missing the box of even density that has its mass and inertia; returns a note.

    Of a box with sides a, b, c: inertia about the first axis is m (b^2 + c^2) / 12, and so on.
    """
    made = []
    for name in bare:
        body = model.body(name)
        inertia = body.inertia
        sides = np.sqrt(np.maximum(6.0 * (inertia.sum() - 2.0 * inertia), 0.0) / max(float(body.mass[0]), 1e-9))
        if sides.min() < _LEAST_SIDE:  # a frame, or a link without a mass
            continue
        spec.body(name).add_geom(
            type=mujoco.mjtGeom.mjGEOM_BOX, size=0.5 * sides, pos=body.ipos, quat=body.iquat, mass=0.0
        )
        made.append(f"{name} ({bare[name]}) " + " x ".join(f"{1e3 * side:.0f}" for side in sides) + " mm")
    return named_note("meshes are missing: boxes by mass and inertia stand for them", made)


def _is_empty(geom: Any) -> bool:
    sizes = SHAPES.get(mujoco.mjtGeom(geom.type), ("", 0))[1]
    if sizes == 2 and math.isfinite(geom.fromto[0]):
        sizes = 1
    return not geom.meshname and not bool((geom.size[:sizes] > 0.0).all())


def _upper_posture(spec: Any, posture: str | None, where: str) -> Mapping[str, float]:
    """Angles in rad by hinge of a keyframe, or as a posture states them."""
    if posture == "zero":
        return {}
    if posture is not None and "=" in posture:
        return angles_of(posture, [j.name for j in spec.joints if j.type == mujoco.mjtJoint.mjJNT_HINGE], where)
    keys = [key for key in spec.keys if len(key.qpos)]
    if posture is not None:
        found([key.name for key in keys], posture, "--posture", where)
        keys = [key for key in keys if key.name == posture]
    qpos = next((np.array(key.qpos) for key in keys), np.zeros(0))
    places = np.cumsum([0, *(_COORDINATES.get(j.type, 1) for j in spec.joints)])
    if len(qpos) != places[-1] or not np.isfinite(qpos).all():
        return {}
    placed = zip(spec.joints, places, strict=False)
    return {j.name: float(qpos[at]) for j, at in placed if j.type == mujoco.mjtJoint.mjJNT_HINGE}


def _collect_motors(spec: Any, stated: _Stated) -> None:
    rates: dict[str, tuple[float, float]] = {}  # and torques of velocity servos, which count where they are alone
    torques: dict[str, list[_Range]] = {}
    servos: set[str] = set()
    for motor in spec.actuators:
        gear = float(motor.gear[0]) or 1.0
        gain = float(motor.gainprm[0])
        spring = float(motor.biasprm[1])
        rate = float(motor.biasprm[2])
        force = _times(gear, _range(motor, "force"))
        pushes = motor.gaintype == mujoco.mjtGain.mjGAIN_FIXED and gain != 0.0 and spring == 0.0
        if pushes and (motor.biastype == mujoco.mjtBias.mjBIAS_NONE or rate != -gain):
            force = _both(force, _times(gear * gain, _range(motor, "ctrl")))
        holds = gain > 0.0 and spring == -gain
        if motor.trntype == mujoco.mjtTrn.mjTRN_TENDON:
            tendon = spec.tendon(motor.target)
            force = _both(force, _range(tendon, "actfrc"))
            for wrap in tendon.path:
                if wrap.type == mujoco.mjtWrap.mjWRAP_JOINT:  # of a fixed one
                    torques.setdefault(wrap.target.name, []).append(_times(wrap.coef, force))
                    servos |= {wrap.target.name} if holds else set()
        if motor.trntype not in (mujoco.mjtTrn.mjTRN_JOINT, mujoco.mjtTrn.mjTRN_JOINTINPARENT):
            continue
        if holds:  # a rate above 0 is a ratio of critical, whatever the gear
            stiffness, damping = stated.gains.get(motor.target, (0.0, 0.0))
            more = -rate if rate > 0.0 else -(gear**2) * rate
            both = damping + more if min(damping, more) >= 0.0 else min(damping, more)  # ratios do not add
            stated.gains[motor.target] = (stiffness + gear**2 * gain, both)
        elif gain > 0.0 and rate == -gain and spring == 0.0:
            rates[motor.target] = (gear**2 * gain, _weaker(force))
            force = _ANY
        torques.setdefault(motor.target, []).append(force)
    stated.notes += named_note("servos on tendons are replaced by one a joint", sorted(servos))
    for name in rates.keys() & stated.gains.keys():  # a position servo that a velocity servo damps
        stiffness, damping = stated.gains[name]
        stated.gains[name] = (stiffness, damping + rates[name][0] if damping >= 0.0 else damping)
    one_way = []
    for joint in spec.joints:
        known = [t for t in torques.get(joint.name, []) if t != _ANY]
        total = sum(low for low, _ in known), sum(high for _, high in known)
        one_way += [joint.name] if known and not total[0] < 0.0 < total[1] else []
        moved = _weaker(total) if known else rates.get(joint.name, (0.0, math.inf))[1]
        limit = min(moved, _weaker(_range(joint, "actfrc")), stated.efforts.get(joint.name, math.inf))
        if limit < math.inf:
            stated.efforts[joint.name] = limit
    stated.notes += named_note("motors that push one way only are taken to push both ways", one_way)


def _range(element: Any, kind: str) -> _Range:
    low, high = getattr(element, f"{kind}range").tolist()
    known = getattr(element, f"{kind}limited") != mujoco.mjtLimited.mjLIMITED_FALSE and low < high
    return (low, high) if known else _ANY


def _times(factor: float, limits: _Range) -> _Range:
    low, high = sorted(factor * limit for limit in limits)
    return (low, high) if factor else _ANY


def _both(one: _Range, other: _Range) -> _Range:
    return max(one[0], other[0]), min(one[1], other[1])


def _weaker(limits: _Range) -> float:
    return min(-limits[0], limits[1]) if limits[0] < 0.0 < limits[1] else max(map(abs, limits))


def _check_limits(spec: Any, file: Path) -> None:
    of_joints = [("joint", joint, kind) for joint in spec.joints for kind in ("", "actfrc")]
    of_motors = [("motor", motor, kind) for motor in spec.actuators for kind in ("force", "ctrl")]
    for what, element, kind in of_joints + of_motors:
        low, high = getattr(element, f"{kind}range").tolist()
        where = f"{file}: {what} '{element.name or element.target}' has {_LIMITS[kind]} from {low:g} to {high:g}"
        known = getattr(element, f"{kind}limited") != mujoco.mjtLimited.mjLIMITED_FALSE and (low or high)
        if known and not -math.inf < low < high < math.inf:
            raise RobotError(f"{where}; allowed: finite ones, lower below upper, or none")
        turns = 0.0 if kind or element.type != mujoco.mjtJoint.mjJNT_HINGE else max(-low, high)
        if _MOST_TURNED < turns <= _IN_DEGREES and not element.compiler.degree:
            raise RobotError(
                f"{where} rad, which look like degrees; allowed: {_MOST_TURNED:g} rad, 3 turns, at most, or none"
            )


def _imus_of(spec: Any) -> tuple[tuple[str, str], ...]:
    kinds = (mujoco.mjtSensor.mjSENS_GYRO, mujoco.mjtSensor.mjSENS_ACCELEROMETER)
    named = ("site", "body")
    found = [("site", s.objname) for k in kinds for s in spec.sensors if s.type == k and spec.site(s.objname)]
    places = zip(named, (spec.sites, spec.bodies), strict=True)
    return tuple(dict.fromkeys([*found, *((what, e.name) for what, es in places for e in es if _IMU.search(e.name))]))


def _compiled(spec: Any, file: Path) -> Any:
    for _ in ("as it is", "without collisions of meshes"):  # flat and broken ones have no convex hull
        try:
            return spec.compile()
        except ValueError as error:
            problem = error
        for geom in [g for g in spec.geoms if g.type == mujoco.mjtGeom.mjGEOM_MESH]:
            geom.contype = 0
            geom.conaffinity = 0
    raise RobotError(f"{file}: cannot be simulated: {' '.join(str(problem).split())}") from None


def _body_of(model: Any, name: str) -> str:
    site = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, name) if name else -1
    body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name) if name else 0
    return str(model.body(body if body >= 0 else int(model.site_bodyid[site])).name)
