"""A robot is data: a TOML that names its model, feet, leg joints, torso, sole layouts, posture and gains.

Reading a robot needs no simulator: the shoe builder and the command line use it too.
"""

from __future__ import annotations

import json
import math
import os
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from plantar.errors import LayoutError, RobotError
from plantar.layout import Side, SoleLayout
from plantar.layout_file import read_layout
from plantar.unknown_keys import refuse_unknown_keys
from sim.robots.biped import BipedParameters

__all__ = ["FootShape", "LegNames", "Robot", "builtin_robots", "load_robot"]

_FOLDER = Path(__file__).parent
_SIDES: tuple[Side, ...] = ("left", "right")
_LEAST_JOINTS = 6  # of a leg: a sole has six degrees of freedom
_LARGEST_ANGLE = 360.0  # degrees, of a posture

_KEYS: Mapping[str, tuple[str, ...]] = {
    "model": ("kind", "file"),
    "foot": ("foot_length", "foot_width", "sole_center", "corner_radius", "taxels"),
    "shoe": ("layout", "origin", "thickness", "mass"),
    "legs": _SIDES,
    "torso": ("body", "imu_site"),
    "posture": _SIDES,
    "gait": (
        "com_height",
        "stance_width",
        "largest_crouch",
        "largest_crouch_partial",
        "trunk_lean",
        "single_support",
        "double_support",
    ),
    "servo": ("stiffness", "damping", "effort_limits"),
}
"""What each table of a robot file may hold; `biped` and `balance` check their own."""


@dataclass(frozen=True)
class LegNames:
    """Names of one leg in the robot's model.

    Attributes:
        joints: Joint names from hip to ankle.
        foot_body: Body that wears the shoe.
        sole_site: Site that is the sole frame.
    """

    joints: tuple[str, ...]
    foot_body: str
    sole_site: str


@dataclass(frozen=True)
class FootShape:
    """The bare left foot as a rounded box, for the shoe builder. SI.

    Attributes:
        length: Length in m.
        width: Width in m.
        center: Centre (x, y) against the ankle in m.
        corner_radius: Radius of the corners in m.
        taxels: Number of taxels that the sole carries.
    """

    length: float
    width: float
    center: tuple[float, float]
    corner_radius: float
    taxels: int


@dataclass(frozen=True)
class Robot:
    """A robot as its TOML describes it.

    Attributes:
        name: Name.
        description: One line for people.
        kind: "biped" (generated from `biped`), "mjcf" or "urdf" (read from `model_file`).
        biped: Dimensions of a generated robot, else None.
        model_file: Path of the model file, else None.
        foot: Shape of the bare foot, where the file gives it.
        shoe_thickness: Outer contact face below the bare sole in m.
        shoe_mass: Mass of one shoe in kg.
        sole_origin: Sole frame's origin (3,) in the left foot's body frame in m; y changes sign for the right.
        effort_limits: Torque limit of each leg joint in N m for a robot from a model file; empty for none.
        layouts: Sole layout of each side.
        legs: Names of each leg.
        torso_body: Body that is kept upright.
        imu_site: Site of the IMU.
        posture: Joint angles of each leg in rad when standing.
        com_height: CoM height above the outer soles when walking in m.
        stance_width: Distance of the sole frames' origins when the feet stand side by side in m.
        largest_crouch: How much lower than `com_height` a scene may make the robot walk in m.
        largest_crouch_partial: The same on ground that carries only a part of a sole, where a centre of pressure at the
            heel loads the knee more.
        trunk_lean: Roll of the torso over the stance foot in rad per metre of lateral CoM motion.
        single_support: t_ss in s of a walk whose scene does not say.
        double_support: t_ds in s of a walk whose scene does not say.
        stiffness: Servo position gain in N m/rad.
        damping: Servo velocity gain in N m s/rad.
        balance: Balance law and its gains.
        path: The TOML file.
    """

    name: str
    description: str
    kind: str
    biped: BipedParameters | None
    model_file: Path | None
    foot: FootShape | None
    shoe_thickness: float
    shoe_mass: float
    sole_origin: tuple[float, float, float]
    effort_limits: tuple[float, ...]
    layouts: Mapping[Side, SoleLayout]
    legs: Mapping[str, LegNames]
    torso_body: str
    imu_site: str
    posture: Mapping[str, tuple[float, ...]]
    com_height: float
    stance_width: float
    largest_crouch: float
    largest_crouch_partial: float
    trunk_lean: float
    single_support: float
    double_support: float
    stiffness: float
    damping: float
    balance: Mapping[str, Any]
    path: Path

    def sole_rectangle(self, side: Side) -> tuple[tuple[float, float], tuple[float, float]]:
        """Bounding rectangle of a sole's outline: centre (x, y) and half size (x, y) in the sole frame in m."""
        outline = self.layouts[side].outline
        low, high = outline.min(axis=0), outline.max(axis=0)
        center, half = 0.5 * (low + high), 0.5 * (high - low)
        return (float(center[0]), float(center[1])), (float(half[0]), float(half[1]))


def builtin_robots() -> tuple[str, ...]:
    """Names of the built-in robots."""
    return tuple(sorted(p.parent.name for p in _FOLDER.glob("*/robot.toml")))


def _table(source: Mapping[str, Any], key: str, where: str) -> Mapping[str, Any]:
    value = source.get(key)
    if not isinstance(value, Mapping):
        raise RobotError(f"{where}: table [{key}] is missing")
    return value


def _text(source: Mapping[str, Any], key: str, where: str) -> str:
    value = source.get(key)
    if not isinstance(value, str) or not value:
        raise RobotError(f"{where}: '{key}' is missing or not a text")
    return value


def _number(source: Mapping[str, Any], key: str, where: str, low: float, high: float) -> float:
    value = source.get(key)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not low <= value <= high:
        raise RobotError(f"{where}: '{key}' is {value!r}; allowed: a number from {low:g} to {high:g}")
    return float(value)


def _numbers(source: Mapping[str, Any], key: str, count: int, where: str, low: float, high: float) -> tuple[float, ...]:
    value = source.get(key)
    if not isinstance(value, list) or len(value) != count:
        raise RobotError(f"{where}: '{key}' is {value!r}; allowed: a list of {count} numbers")
    return tuple(_number({key: v}, key, where, low, high) for v in value)


def load_robot(name: str | os.PathLike[str]) -> Robot:
    """Load a robot by its built-in name or from a TOML file.

    Args:
        name: A built-in name (`builtin_robots()`) or the path of a robot TOML.

    Returns:
        The robot.

    Raises:
        RobotError: If the name is unknown or the file is not valid; the message names the field.

    Example:
        >>> load_robot("h1").biped.total_mass
        86.0
    """
    path = Path(name)
    if path.suffix == ".toml":
        if not path.is_file():
            raise RobotError(f"robot file {path} does not exist")
    else:
        path = _FOLDER / str(name) / "robot.toml"
        if os.sep in str(name) or not path.is_file():
            raise RobotError(f"unknown robot '{name}'; allowed: {', '.join(builtin_robots())}, or a robot .toml file")
    try:
        source = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise RobotError(f"robot file {path} is not valid TOML: {error}") from None
    return _robot_from(source, path)


def _foot(table: Mapping[str, Any], where: str) -> FootShape:
    where = f"{where}: [foot]"
    center = _numbers(table, "sole_center", 2, where, -1.0, 1.0)
    return FootShape(
        _number(table, "foot_length", where, 0.01, 1.0),
        _number(table, "foot_width", where, 0.01, 1.0),
        (center[0], center[1]),
        _number(table, "corner_radius", where, 0.0, 0.5),
        int(_number(table, "taxels", where, 1, 100000)),
    )


def _leg(table: Mapping[str, Any], side: Side, where: str) -> LegNames:
    refuse_unknown_keys(table, ("joints", "foot_body", "sole_site"), where, RobotError)
    joints = table.get("joints")
    if not isinstance(joints, list) or not all(isinstance(j, str) for j in joints):
        raise RobotError(f"{where} joints is {joints!r}; allowed: a list of joint names")
    if len(joints) < _LEAST_JOINTS:
        raise RobotError(f"{where} joints names {len(joints)}; allowed: {_LEAST_JOINTS} or more from hip to foot")
    if len(set(joints)) != len(joints):
        twice = next(j for j in joints if joints.count(j) > 1)
        raise RobotError(f"{where} joints names '{twice}' more than once")
    site = _text({"sole_site": f"{side}_sole", **table}, "sole_site", where)
    return LegNames(tuple(joints), _text(table, "foot_body", where), site)


def _layout_file(shoe: Mapping[str, Any], side: Side, path: Path, where: str) -> Path:
    return path.parent / _text(shoe, "layout", f"{where}: [shoe]").replace("{side}", side)


def _layout(path: Path, side: Side, where: str) -> SoleLayout:
    try:
        layout = read_layout(path)
    except LayoutError as error:
        raise RobotError(f"{where}: {error}") from None
    if layout.side != side:
        raise RobotError(
            f"{where}: [shoe] layout {path} is of the {layout.side} sole, not the {side} one; "
            'allowed: a name with {side} in it, as "layout_{side}.json"'
        )
    return layout


def _robot_from(source: Mapping[str, Any], path: Path) -> Robot:
    where = str(path) if path.parent.parent != _FOLDER else f"robot '{path.parent.name}'"
    for key, allowed in _KEYS.items():
        if key in source:
            refuse_unknown_keys(_table(source, key, where), allowed, f"{where}: [{key}]", RobotError)
    model = _table(source, "model", where)
    kind = _text(model, "kind", where)
    if kind not in ("biped", "mjcf", "urdf"):
        raise RobotError(f"{where}: [model] kind is '{kind}'; allowed: biped, mjcf, urdf")
    model_file = None
    biped = None
    if kind == "biped":
        biped = BipedParameters.from_table(_table(source, "biped", where), where)
    else:
        model_file = path.parent / _text(model, "file", where)
        if not model_file.is_file():
            raise RobotError(f"{where}: [model] file {model_file} does not exist")
    foot = _table(source, "foot", where) if kind == "biped" or "foot" in source else None
    shoe = _table(source, "shoe", where)
    legs, posture, layouts = _table(source, "legs", where), _table(source, "posture", where), {}
    leg_names: dict[str, LegNames] = {}
    angles: dict[str, tuple[float, ...]] = {}
    for side in _SIDES:
        leg_names[side] = _leg(_table(legs, side, f"{where}: [legs]"), side, f"{where}: [legs.{side}]")
        turns = _numbers(
            posture, side, len(leg_names[side].joints), f"{where}: [posture]", -_LARGEST_ANGLE, _LARGEST_ANGLE
        )
        angles[side] = tuple(math.radians(v) for v in turns)
        layouts[side] = _layout(_layout_file(shoe, side, path, where), side, where)
    exported = _exported_shoe(_layout_file(shoe, "left", path, where))
    torso = _table(source, "torso", where)
    servo = _table(source, "servo", where)
    gait = _table(source, "gait", where)
    shared = set(leg_names["left"].joints) & set(leg_names["right"].joints)
    if shared:
        raise RobotError(f"{where}: [legs] both legs name joint '{min(shared)}'; each joint is of one leg")
    imu_site = _text(torso, "imu_site", f"{where}: [torso]")
    sites = [imu_site, *(leg.sole_site for leg in leg_names.values())]
    if len(set(sites)) != len(sites):
        raise RobotError(f"{where}: the IMU's site and the soles' need different names, not {', '.join(sites)}")
    joints_of_leg = len(leg_names["left"].joints)
    if len(leg_names["right"].joints) != joints_of_leg:
        raise RobotError(f"{where}: [legs] the left leg has {joints_of_leg} joints, the right another number")
    origin = (0.0, 0.0, 0.0) if biped is not None else _numbers(shoe, "origin", 3, f"{where}: [shoe]", -1.0, 1.0)
    efforts: tuple[float, ...] = ()
    if "effort_limits" in servo:
        efforts = _numbers(servo, "effort_limits", joints_of_leg, f"{where}: [servo]", 1e-3, 1e5)
    crouch = _number({"largest_crouch": 0.15, **gait}, "largest_crouch", f"{where}: [gait]", 0.0, 0.5)
    balance = dict(_table(source, "balance", where))
    refuse_unknown_keys(source, ("name", "description", "biped", "balance", *_KEYS), where, RobotError)
    return Robot(
        name=_text(source, "name", where),
        description=str(source.get("description", "")),
        kind=kind,
        biped=biped,
        model_file=model_file,
        foot=None if foot is None else _foot(foot, where),
        shoe_thickness=_number({**exported, **shoe}, "thickness", f"{where}: [shoe]", 0.0, 0.1),
        shoe_mass=_number({**exported, **shoe}, "mass", f"{where}: [shoe]", 0.0, 20.0),
        sole_origin=(origin[0], origin[1], origin[2]),
        effort_limits=efforts,
        layouts=layouts,
        legs=leg_names,
        torso_body=_text(torso, "body", f"{where}: [torso]"),
        imu_site=imu_site,
        posture=angles,
        com_height=_number(gait, "com_height", f"{where}: [gait]", 0.05, 5.0),
        stance_width=_number(gait, "stance_width", f"{where}: [gait]", 0.01, 2.0),
        largest_crouch=crouch,
        largest_crouch_partial=_number(
            {"largest_crouch_partial": crouch, **gait}, "largest_crouch_partial", f"{where}: [gait]", 0.0, crouch
        ),
        trunk_lean=_number({"trunk_lean": 0.0, **gait}, "trunk_lean", f"{where}: [gait]", 0.0, 5.0),
        single_support=_number({"single_support": 0.9, **gait}, "single_support", f"{where}: [gait]", 0.2, 10.0),
        double_support=_number({"double_support": 0.3, **gait}, "double_support", f"{where}: [gait]", 0.02, 10.0),
        stiffness=_number(servo, "stiffness", f"{where}: [servo]", 1.0, 1e6),
        damping=_number(servo, "damping", f"{where}: [servo]", 0.0, 1e5),
        balance=balance,
        path=path,
    )


def _exported_shoe(layout: Path) -> dict[str, Any]:
    """What `plantar shoe` wrote of a shoe beside its layout: mass in kg and thickness in m; a robot's file may say
    otherwise."""
    found = json.loads(layout.read_text(encoding="utf-8-sig")).get("shoe", {})
    return {k: found[k] for k in ("mass", "thickness") if k in found} if isinstance(found, dict) else {}
