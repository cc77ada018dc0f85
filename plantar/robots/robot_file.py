"""Robots from TOML files; errors name table and field."""

import math
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.files.input_file import check_input
from plantar.common.files.model_files import named_file
from plantar.common.files.structured_text import packaged_files, read_json, read_toml
from plantar.common.optional_library import missing_libraries
from plantar.common.settings.unknown_keys import builtin_or_file, refuse_unknown_keys
from plantar.common.sides import SIDES, Side
from plantar.errors import InputError, LayoutError, RobotError
from plantar.gait.balance.balance_laws import balance_gains
from plantar.gait.controller_tables import CONTROLLER_TABLES, check_controller_table
from plantar.layouts.layout import SoleLayout
from plantar.layouts.layout_file import read_layout
from plantar.mechanics.rotation import rotation_from_angles
from plantar.robots.biped import BipedParameters
from plantar.robots.robot import Arms, FootShape, LegNames, Robot

_FOLDER = Path(__file__).parent
_LEAST_JOINTS = 4  # of a leg: hip roll and pitch, knee, ankle pitch; the ground chooses the sole's roll
_LARGEST_ANGLE = 360.0  # degrees, of a posture

# What each table of a robot file may hold; `biped` and `balance` check their own
_KEYS: Mapping[str, tuple[str, ...]] = {
    "model": ("kind", "file"),
    "foot": ("foot_length", "foot_width", "sole_center", "corner_radius", "taxels"),
    "shoe": (
        "layout",
        "origin",
        "rotation",
        "origin_right",
        "rotation_right",
        "thickness",
        "mass",
        "rim_stiffness",
        "contact_damping",
    ),
    "legs": SIDES,
    "torso": ("body", "imu_site"),
    "posture": SIDES,
    "gait": (
        "com_height",
        "stance_width",
        "leg_length",
        "largest_crouch",
        "trunk_lean",
        "single_support",
        "double_support",
        "approach_support",
        "pace",
        "ankle_reach",
        "rocks",
    ),
    "servo": ("stiffness", "damping", "own_stiffness", "own_damping", "effort_limits", "velocity_limits"),
    "arms": ("machine", "chest", *SIDES),
}


def builtin_robots() -> tuple[str, ...]:
    """Names of the built-in robots."""
    return tuple(_builtin())


def _builtin() -> dict[str, Path]:
    return {path.parent.name: path for path in packaged_files("plantar.robots", "*/robot.toml")}


@missing_libraries("sim")
def load_robot(name: str | os.PathLike[str]) -> Robot:
    """Load a robot by its built-in name or from a TOML file.

    Args:
        name: Built-in name (`builtin_robots()`) or path.

    Raises:
        RobotError: If unknown or invalid.

    Example:
        >>> load_robot("h1").biped.total_mass
        86.0
    """
    path = builtin_or_file(name, "robot", _builtin(), RobotError)
    return _RobotFile(read_toml(path, RobotError, f"robot file {path}"), path).robot()


class RobotTables:
    """The tables of a robot file."""

    def __init__(self, source: Mapping[str, Any], where: str) -> None:
        self.source = source
        self.where = where

    def place(self, *tables: str) -> str:
        """Place of an error, for its message."""
        return f"{self.where}: [{'.'.join(tables)}]" if tables else self.where

    def table(self, *tables: str) -> Mapping[str, Any]:
        """A table, or one in it; the file itself for no name."""
        found = self.source
        for i, name in enumerate(tables):
            inner = found.get(name)
            if not isinstance(inner, Mapping):
                raise RobotError(f"{self.place(*tables[:i])}: table [{name}] is missing")
            found = inner
        return found

    def text(self, field: str, *tables: str, default: str | None = None) -> str:
        """A text that is not empty.

        `tables`: names of its table and those around it; none for the file itself; `default`: required if None.
        """
        value = self.table(*tables).get(field, default)
        if not isinstance(value, str) or not value:
            raise RobotError(f"{self.place(*tables)}: '{field}' is missing or not a text")
        return value

    def switch(self, field: str, table: str) -> bool:
        """A truth value of a table, False by default.

        Takes `field`; returns the value.
        """
        value = self.table(table).get(field, False)
        if not isinstance(value, bool):
            raise RobotError(f"{self.place(table)}: '{field}' is {value!r}; allowed: true, false")
        return value

    def number(self, field: str, table: str, low: float, high: float, default: float | None = None) -> float:
        """A number of a table within limits. `default`: required if None."""
        return _checked_number(self.table(table).get(field, default), field, self.place(table), low, high)

    def numbers(self, field: str, table: str, count: int, low: float, high: float) -> tuple[float, ...]:
        """So many numbers of a table within limits.

        Takes `field`, `count`, `low` and `high`; returns the numbers.
        """
        value = self.table(table).get(field)
        if not isinstance(value, list) or len(value) != count:
            raise RobotError(f"{self.place(table)}: '{field}' is {value!r}; allowed: a list of {count} numbers")
        return tuple(_checked_number(v, field, self.place(table), low, high) for v in value)

    def number_each(self, field: str, table: str, count: int, low: float, high: float) -> tuple[float, ...]:
        """So many numbers of a table within limits, or one for all.

        Takes `field`, `count`, `low` and `high`; returns the numbers.
        """
        if isinstance(self.table(table).get(field), list):
            return self.numbers(field, table, count, low, high)
        return (self.number(field, table, low, high),) * count


class _RobotFile(RobotTables):
    def __init__(self, source: Mapping[str, Any], path: Path) -> None:
        super().__init__(source, str(path) if path.parent.parent != _FOLDER else f"robot '{path.parent.name}'")
        self.path = path

    def robot(self) -> Robot:
        """The described robot; a RobotError for a wrong table or field."""
        self._refuse_unknown_fields()
        kind = self._kind()
        biped = BipedParameters.from_table(self.table("biped"), self.where) if kind == "biped" else None
        model_file = None if kind == "biped" else self._model_file()
        foot = self._foot() if kind == "biped" or "foot" in self.source else None
        legs = self._legs()
        parts = {
            "posture": {side: self._angles(side, len(legs[side].joints)) for side in SIDES},
            **self._shoe(kind),
            **self._torso(legs),
            **self._gait(),
            **self._servo(biped, len(legs["left"].joints)),
            "balance": self._balance(),
            "controller": {
                name: check_controller_table(name, self.source[name], self.place(name), RobotError)
                for name in CONTROLLER_TABLES
                if name in self.source and name != "balance"
            },
        }
        refuse_unknown_keys(
            self.source, ("name", "description", "biped", *CONTROLLER_TABLES, *_KEYS), self.where, RobotError
        )
        return Robot(
            name=self.text("name"),
            description=str(self.source.get("description", "")),
            kind=kind,
            biped=biped,
            model_file=model_file,
            foot=foot,
            legs=legs,
            path=self.path,
            arms=self._arms() if "arms" in self.source else None,
            **parts,
        )

    def _refuse_unknown_fields(self) -> None:
        for key, allowed in _KEYS.items():
            if key in self.source:
                refuse_unknown_keys(self.table(key), allowed, self.place(key), RobotError)

    def _kind(self) -> str:
        kind = self.text("kind", "model")
        if kind not in ("biped", "mjcf", "urdf"):
            raise RobotError(f"{self.place('model')} kind is '{kind}'; allowed: biped, mjcf, urdf")
        return kind

    def _model_file(self) -> Path:
        path = self.path.parent / self.text("file", "model")
        named_file(path, (self.path.parent,), RobotError, f"{self.place('model')} file")
        check_input(path, RobotError, where=f"{self.place('model')} file {path}")
        return path

    def _foot(self) -> FootShape:
        x, y = self.numbers("sole_center", "foot", 2, -1.0, 1.0)
        return FootShape(
            self.number("foot_length", "foot", 0.01, 1.0),
            self.number("foot_width", "foot", 0.01, 1.0),
            (x, y),
            self.number("corner_radius", "foot", 0.0, 0.5),
            int(self.number("taxels", "foot", 1, 100000)),
        )

    def _legs(self) -> dict[Side, LegNames]:
        legs = {side: self._leg(side) for side in SIDES}
        shared = set(legs["left"].joints) & set(legs["right"].joints)
        if shared:
            raise RobotError(f"{self.place('legs')} both legs name joint '{min(shared)}'; each joint is of one leg")
        count = len(legs["left"].joints)
        if len(legs["right"].joints) != count:
            raise RobotError(f"{self.place('legs')} the left leg has {count} joints, the right another number")
        return legs

    def _leg(self, side: Side) -> LegNames:
        table = self.table("legs", side)
        where = self.place("legs", side)
        refuse_unknown_keys(table, ("joints", "foot_body", "sole_site"), where, RobotError)
        joints = table.get("joints")
        if not isinstance(joints, list) or not all(isinstance(j, str) for j in joints):
            raise RobotError(f"{where} joints is {joints!r}; allowed: a list of joint names")
        if len(joints) < _LEAST_JOINTS:
            raise RobotError(f"{where} joints names {len(joints)}; allowed: {_LEAST_JOINTS} or more from hip to foot")
        if len(set(joints)) != len(joints):
            twice = next(j for j in joints if joints.count(j) > 1)
            raise RobotError(f"{where} joints names '{twice}' more than once")
        site = self.text("sole_site", "legs", side, default=f"{side}_sole")
        return LegNames(tuple(joints), self.text("foot_body", "legs", side), site)

    def _angles(self, side: Side, joints: int) -> tuple[float, ...]:
        degrees = self.numbers(side, "posture", joints, -_LARGEST_ANGLE, _LARGEST_ANGLE)
        return tuple(math.radians(v) for v in degrees)

    def _shoe(self, kind: str) -> dict[str, Any]:
        exported = _exported_shoe(self._layout_file("left"))
        layouts = {side: self._layout(side) for side in SIDES}
        places = self._sole_frames(kind, layouts)
        return {
            "layouts": layouts,
            "sole_origins": {side: place[0] for side, place in places.items()},
            "sole_rotations": {side: place[1] for side, place in places.items()},
            "shoe_thickness": self.number("thickness", "shoe", 0.0, 0.1, exported.get("thickness")),
            "shoe_mass": self.number("mass", "shoe", 0.0, 20.0, exported.get("mass")),
            "rim_stiffness": self.number("rim_stiffness", "shoe", 0.0, 100.0, exported.get("rim_stiffness", 0.0)),
            "contact_damping": self.number("contact_damping", "shoe", 0.1, 10.0, 1.0),
        }

    def _sole_frames(
        self, kind: str, layouts: Mapping[Side, SoleLayout]
    ) -> dict[Side, tuple[NDArray[np.float64], NDArray[np.float64]]]:
        """Sole frames' origin (3,) in m and rotation (3, 3): as given, right mirrors left; else of the layouts."""
        if kind == "biped":
            return {side: (np.zeros(3), np.eye(3)) for side in SIDES}
        given = self.table("shoe")
        if "origin" not in given:
            poses = self._poses_in_feet(layouts)
            if poses is not None:
                return poses
        origin = np.array(self.numbers("origin", "shoe", 3, -1.0, 1.0))

        def three(field: str, most: float, otherwise: NDArray[np.float64]) -> NDArray[np.float64]:
            return np.array(self.numbers(field, "shoe", 3, -most, most)) if field in given else otherwise

        angles = three("rotation", _LARGEST_ANGLE, np.zeros(3))
        right = three("origin_right", 1.0, origin * (1.0, -1.0, 1.0))
        turned = three("rotation_right", _LARGEST_ANGLE, angles * (-1.0, 1.0, -1.0))

        def rotation(roll: float, pitch: float, yaw: float) -> NDArray[np.float64]:
            return rotation_from_angles(math.radians(yaw), math.radians(pitch), math.radians(roll))

        return {"left": (origin, rotation(*angles)), "right": (right, rotation(*turned))}

    def _poses_in_feet(
        self, layouts: Mapping[Side, SoleLayout]
    ) -> dict[Side, tuple[NDArray[np.float64], NDArray[np.float64]]] | None:
        """Sole frames that the layouts state in the frames of the feet; None where one does not."""
        poses = {side: layouts[side].pose for side in SIDES}
        found = {}
        for side, pose in poses.items():
            if pose is None or pose.body != self.text("foot_body", "legs", side):
                return None
            found[side] = (pose.position, pose.rotation)
        return found

    def _layout_file(self, side: Side) -> Path:
        path = self.path.parent / self.text("layout", "shoe").replace("{side}", side)
        return named_file(path, (self.path.parent,), RobotError, f"{self.place('shoe')} layout")

    def _layout(self, side: Side) -> SoleLayout:
        path = self._layout_file(side)
        try:
            layout = read_layout(path)
        except LayoutError as error:
            raise RobotError(f"{self.where}: {error}") from None
        if layout.side != side:
            raise RobotError(
                f"{self.place('shoe')} layout {path} is of the {layout.side} sole, not the {side} one; "
                'allowed: a name with {side} in it, as "layout_{side}.json"'
            )
        return layout

    def _torso(self, legs: Mapping[Side, LegNames]) -> dict[str, Any]:
        imu_site = self.text("imu_site", "torso")
        sites = [imu_site, *(leg.sole_site for leg in legs.values())]
        if len(set(sites)) != len(sites):
            raise RobotError(
                f"{self.where}: the IMU's site and the soles' need different names, not {', '.join(sites)}"
            )
        return {"torso_body": self.text("body", "torso"), "imu_site": imu_site}

    def _arms(self) -> Arms:
        """Arms of a built-in machine, or of a file next to the robot's."""
        machine = self.text("machine", "arms")
        if machine.endswith(".toml"):
            path = self.path.parent / machine
            machine = str(named_file(path, (self.path.parent,), RobotError, f"{self.place('arms')} machine"))
        return Arms(machine, self.text("chest", "arms"), {side: self.text(side, "arms") for side in SIDES})

    def _gait(self) -> dict[str, Any]:
        return {
            "com_height": self.number("com_height", "gait", 0.05, 5.0),
            "stance_width": self.number("stance_width", "gait", 0.01, 2.0),
            "leg_length": self.number("leg_length", "gait", 0.02, 3.0) if "leg_length" in self.table("gait") else 0.0,
            "largest_crouch": self.number("largest_crouch", "gait", 0.0, 0.5, 0.0),
            "trunk_lean": self.number("trunk_lean", "gait", 0.0, 5.0, 0.0),
            "single_support": self._duration("single_support", 0.2),
            "double_support": self._duration("double_support", 0.02),
            "approach_support": self._duration("approach_support", 0.2),
            "ankle_reach": self.number("ankle_reach", "gait", 0.0, 1.0, 1.0),
            "rocks": self.switch("rocks", "gait"),
            "pace": self.number("pace", "gait", 0.5, 5.0, 1.0),
        }

    def _duration(self, name: str, least: float) -> float:
        return self.number(name, "gait", least, 10.0) if name in self.table("gait") else 0.0

    def _servo(self, biped: BipedParameters | None, joints: int) -> dict[str, Any]:
        given = self.table("servo")
        efforts = self.numbers("effort_limits", "servo", joints, 1e-3, 1e5) if "effort_limits" in given else ()
        speeds = () if biped is None else biped.velocity_limits
        if "velocity_limits" in given:
            speeds = self.numbers("velocity_limits", "servo", joints, 1e-3, 1e3)
        own, stiff = ("own_", 0.0) if {"own_stiffness", "own_damping"} & set(given) else ("", 1.0)
        return {
            "stiffness": self.number_each("stiffness", "servo", joints, 1.0, 1e6),
            "damping": self.number_each("damping", "servo", joints, 0.0, 1e5),
            "own_stiffness": self.number_each(f"{own}stiffness", "servo", joints, stiff, 1e6),
            "own_damping": self.number_each(f"{own}damping", "servo", joints, 0.0, 1e5),
            "effort_limits": efforts,
            "velocity_limits": speeds,
        }

    def _balance(self) -> dict[str, Any]:
        balance = dict(self.table("balance"))
        try:
            balance_gains(balance)
        except InputError as error:
            raise RobotError(f"{self.where}: {error}") from None
        return balance


def _exported_shoe(layout: Path) -> dict[str, Any]:
    """Mass in kg, thickness in m and rim stiffness by `plantar shoe`."""
    found = read_json(layout, RobotError, str(layout)).get("shoe", {})
    wanted = ("mass", "thickness", "rim_stiffness") if isinstance(found, dict) else ()
    return {k: found[k] for k in wanted if k in found}


def _checked_number(value: Any, field: str, where: str, low: float, high: float) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not low <= value <= high:
        raise RobotError(f"{where}: '{field}' is {value!r}; allowed: a number from {low:g} to {high:g}")
    return float(value)
