"""Machines with skin: an MJCF, and a TOML with base, joints, drives and skin."""

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.files.input_file import is_file
from plantar.common.files.model_files import check_model, named_file
from plantar.common.files.model_limits import spec_of_file
from plantar.common.files.structured_text import packaged_files, read_toml
from plantar.common.settings.schema import Settings, choice, number, tables, text
from plantar.common.settings.unknown_keys import builtin_or_file, nearest, refuse_other_than_texts, refuse_unknown_keys
from plantar.errors import RobotError
from plantar.mechanics.lip import GRAVITY
from plantar.mujoco.deletion import delete_all
from plantar.sim.body_skin.surface import OBSTACLE_GROUP

_KEYS = ("name", "description", "model", "base", "servo", "joint_defaults", "joints", "patch")
_UNSEEN = 4  # geom group that pictures leave out
_ONE_DOF = (mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_SLIDE)


class BaseTable(Settings):
    """What carries the joints. Lengths in m.

    Attributes:
        kind: "fixed"; "mobile", whose first three joints move it along x, along y and about z; or "floating", with a
            free joint.
        link: Link that is the base; empty takes the first.
        footprint: Corners [x, y] in its frame of its area on the ground, counter-clockwise, kept away from obstacles.
    """

    kind: str = choice("fixed", "mobile", "floating")
    link: str = text("")
    footprint: tuple[tuple[float, float], ...] = tables("a list of corners [x, y] in m")


class ServoTable(Settings):
    """How joints are commanded.

    Attributes:
        kind: Input of a joint's drive.
        velocity_gain: Gain of a velocity servo as a share of the joint's effort limit for an error of its speed limit.
        position_gain: Gain of a position servo.
    """

    kind: str = choice("torque", "velocity", "position")
    velocity_gain: float = number(20.0, "1", 0.1, 1000)
    position_gain: float = number(60.0, "1/s", 0.1, 1000)


class JointTable(Settings):
    """Limits of a joint and its position in the posture.

    Attributes:
        effort: Largest torque in N m, or force in N of a slide; 0 for no limit.
        velocity: Largest speed in rad/s or m/s; 0 for no limit.
        posture: In degrees, or in m of a slide.
    """

    effort: float = number(0.0, "N m")
    velocity: float = number(0.0, "rad/s")
    posture: float = number(0.0, "deg", -1080, 1080)


@dataclass(frozen=True)
class Machine:
    """A machine; joints are in the model's order.

    `joints`: limits of each joint, by name; `patches`: unread `[[patch]]` tables, for `plantar.sim.body_skin.surface`.
    """

    name: str
    description: str
    path: Path
    model_file: Path
    base: BaseTable
    servo: ServoTable
    joints: Mapping[str, JointTable]
    patches: tuple[Mapping[str, Any], ...] = field(default=())

    @property
    def efforts(self) -> NDArray[np.float64]:
        """Largest joint torques (k,) in N m or N; infinite without limit."""
        return np.array([joint.effort or math.inf for joint in self.joints.values()])

    @property
    def velocities(self) -> NDArray[np.float64]:
        """Largest joint speeds (k,) in rad/s or m/s; infinite without limit."""
        return np.array([joint.velocity or math.inf for joint in self.joints.values()])

    @property
    def posture(self) -> NDArray[np.float64]:
        """Joint positions (k,) of the posture in rad or m."""
        slides = {j.name for j in self.spec().joints if j.type == mujoco.mjtJoint.mjJNT_SLIDE}
        return np.array([t.posture if n in slides else math.radians(t.posture) for n, t in self.joints.items()])

    def spec(self) -> Any:
        """The machine alone as a new `mujoco.MjSpec` with a motor a joint. Its geoms touch
        obstacles, not each other.
        """
        spec = _parsed(self.model_file, f"machine '{self.name}'")
        for part in ("keys", "equalities", "tendons", "pairs", "excludes", "sensors", "actuators", "lights"):
            delete_all(spec, getattr(spec, part))
        delete_all(spec, spec.worldbody.geoms)
        spec.option.gravity = [0.0, 0.0, -GRAVITY]
        spec.option.density = 0.0
        spec.option.viscosity = 0.0
        spec.option.timestep = 0.001
        for geom in spec.geoms:
            if geom.group == OBSTACLE_GROUP:
                geom.group = _UNSEEN  # many models keep their collision shapes in the group of obstacles
            if geom.contype or geom.conaffinity:
                geom.contype = 1
                geom.conaffinity = 2
        for name, joint in self.joints.items():
            motor = spec.add_actuator(name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
            motor.gainprm[0] = 1.0
            motor.ctrllimited = joint.effort > 0.0
            motor.ctrlrange = [-joint.effort, joint.effort]
        return spec

    def ranges(self, model: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lowest and highest joint positions (k,) in rad or m; infinite without a stop."""
        joints = [model.joint(name) for name in self.joints]
        held = np.array([bool(joint.limited[0]) for joint in joints])
        low, high = np.array([joint.range for joint in joints]).T
        return np.where(held, low, -np.inf), np.where(held, high, np.inf)


def builtin_machines() -> tuple[str, ...]:
    """Names of the built-in machines."""
    return tuple(_builtin())


def _builtin() -> dict[str, Path]:
    return {path.parent.name: path for path in packaged_files("plantar.sim", "companion/machines/*/machine.toml")}


def load_machine(name: str | os.PathLike[str]) -> Machine:
    """Load a machine by built-in name (`builtin_machines()`) or TOML path.

    Raises:
        RobotError: If unknown or invalid.

    Example:
        >>> load_machine("planar-arm").base.kind
        'fixed'
    """
    path = builtin_or_file(name, "machine", _builtin(), RobotError)
    own = Path(name).suffix == ".toml"
    where = str(path) if own else f"machine '{name}'"
    source = read_toml(path, RobotError, f"machine file {path}")
    refuse_unknown_keys(source, _KEYS, where, RobotError)
    refuse_other_than_texts(source, ("name", "description"), where, RobotError)
    model_file = _model_file(source, path, where)
    spec = _parsed(model_file, where)
    base = BaseTable.from_table(source.get("base", {}), f"{where}: [base]", RobotError)
    machine = Machine(
        name=source.get("name", path.parent.name if path.stem == "machine" else path.stem),
        description=source.get("description", ""),
        path=path,
        model_file=model_file,
        base=_checked_base(base, spec, where),
        servo=ServoTable.from_table(source.get("servo", {}), f"{where}: [servo]", RobotError),
        joints=_joints(source, spec, where),
        patches=_patches(source, spec, where),
    )
    try:
        machine.spec().compile()
    except ValueError as error:
        raise RobotError(f"{where}: the model cannot be simulated: {' '.join(str(error).split())}") from None
    return machine


def _model_file(source: Mapping[str, Any], path: Path, where: str) -> Path:
    table = source.get("model")
    if not isinstance(table, Mapping):
        raise RobotError(f'{where}: table [model] is missing; it needs file = "..."')
    refuse_unknown_keys(table, ("file",), f"{where}: [model]", RobotError)
    file = table.get("file")
    if not isinstance(file, str) or not file:
        raise RobotError(f"{where}: [model]: 'file' is missing or not a text")
    return named_file(path.parent / file, (path.parent,), RobotError, f"{where}: [model]")


def _parsed(file: Path, where: str) -> Any:
    if not is_file(file):
        raise RobotError(f"{where}: model file {file} does not exist")
    check_model(file, RobotError)  # MuJoCo would follow no matter what it names
    try:
        spec = spec_of_file(file)
    except Exception as error:  # MuJoCo's parser raises ValueError, OSError and its own errors
        raise RobotError(f"{where}: model file {file} cannot be read: {' '.join(str(error).split())}") from None
    spec.compiler.fusestatic = False
    return spec


def _checked_base(base: BaseTable, spec: Any, where: str) -> BaseTable:
    where = f"{where}: [base]"
    bodies = [b.name for b in spec.bodies if b.name and b.name != "world"]
    if base.link and base.link not in bodies:
        raise RobotError(f"{where} link: {_unknown('link', base.link, bodies)}")
    floats = any(j.type == mujoco.mjtJoint.mjJNT_FREE for j in spec.joints)
    if floats != (base.kind == "floating"):
        has = "a free joint" if floats else "no free joint"
        raise RobotError(f"{where} kind is '{base.kind}' but the model has {has}; allowed with one: floating")
    if base.kind == "mobile":
        first = [(j.type, tuple(np.round(j.axis, 6))) for j in spec.joints[:3]]
        if first != [(kind, tuple(axis)) for kind, axis in zip(_MOBILE, np.eye(3).tolist(), strict=True)]:
            raise RobotError(
                f"{where} kind is 'mobile'; the model's first joints must slide along x, y and turn about z"
            )
    corners = np.array(base.footprint, dtype=object)
    good = not len(corners) or (
        corners.ndim == 2
        and corners.shape[0] >= 3
        and corners.shape[1] == 2
        and all(isinstance(v, int | float) and math.isfinite(v) for v in corners.ravel())
    )
    if not good:
        raise RobotError(f"{where} footprint is not valid; allowed: three or more corners [x, y] in m")
    return base if base.link or not bodies else BaseTable(base.kind, bodies[0], base.footprint)


_MOBILE = (mujoco.mjtJoint.mjJNT_SLIDE, mujoco.mjtJoint.mjJNT_SLIDE, mujoco.mjtJoint.mjJNT_HINGE)


def _joints(source: Mapping[str, Any], spec: Any, where: str) -> dict[str, JointTable]:
    given = source.get("joints", {})
    defaults = source.get("joint_defaults", {})
    JointTable.from_table(defaults, f"{where}: [joint_defaults]", RobotError)
    if not isinstance(given, Mapping):
        raise RobotError(f"{where}: [joints] is not a table of tables, one a joint")
    found = {}
    for joint in spec.joints:
        if joint.type == mujoco.mjtJoint.mjJNT_FREE:
            continue
        if joint.type not in _ONE_DOF or not joint.name:
            raise RobotError(
                f"{where}: joint '{joint.name}' is a ball joint or has no name; allowed: named hinge, slide"
            )
        table = given.get(joint.name, {})
        if not isinstance(table, Mapping):
            raise RobotError(f"{where}: [joints.{joint.name}] is not a table")
        found[joint.name] = JointTable.from_table({**defaults, **table}, f"{where}: [joints.{joint.name}]", RobotError)
    if not found:
        raise RobotError(f"{where}: the model has no joints")
    for name in given:
        if name not in found:
            raise RobotError(f"{where}: [joints]: {_unknown('joint', name, list(found))}")
    return found


def _patches(source: Mapping[str, Any], spec: Any, where: str) -> tuple[Mapping[str, Any], ...]:
    patches = source.get("patch", [])
    bodies = [b.name for b in spec.bodies if b.name and b.name != "world"]
    if not isinstance(patches, list) or not all(isinstance(p, Mapping) for p in patches):
        raise RobotError(f"{where}: 'patch' is not a list of tables; allowed: [[patch]]")
    for table in patches:
        name = table.get("name", "?")
        link = table.get("link")
        if link not in bodies:
            raise RobotError(f"{where}: patch '{name}': {_unknown('link', link, bodies)}")
    return tuple(patches)


def _unknown(what: str, name: Any, known: list[str]) -> str:
    return f"the model has no {what} '{name}'; {nearest(str(name), known)}it has {', '.join(known)}"
