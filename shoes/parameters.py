"""Every dimension of the shoe: one named parameter each, with default, range and unit."""

from __future__ import annotations

import json
import math
import os
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

from plantar.errors import InputError

__all__ = ["ShoeParameters", "read_parameters"]


def _parameter(default: float, low: float, high: float, unit: str, text: str) -> Any:
    return field(default=default, metadata={"low": low, "high": high, "unit": unit, "text": text})


@dataclass(frozen=True)
class ShoeParameters:
    """Dimensions of a tactile shoe, from the ground up. Lengths in mm.

    Raises:
        InputError: If a value is out of its range, or two values contradict each other.

    Example:
        >>> ShoeParameters(plate_thickness=14.0).floor
        6.5
    """

    plate_thickness: float = _parameter(12.0, 3.0, 40.0, "mm", "contact face to the face the foot stands on")
    patch_depth: float = _parameter(5.0, 0.5, 20.0, "mm", "recess that takes the skin patch, from the contact face")
    pocket_depth: float = _parameter(2.5, 0.2, 20.0, "mm", "hexagonal taxel pocket, above the patch recess")
    pocket_clearance: float = _parameter(0.3, 0.0, 2.0, "mm", "gap between the skin patch and the wall around it")
    rib: float = _parameter(2.0, 0.8, 8.0, "mm", "wall between two taxel pockets")
    border: float = _parameter(2.0, 0.8, 20.0, "mm", "wall around the skin patch")
    rim_height: float = _parameter(12.0, 2.0, 60.0, "mm", "rim above the face the foot stands on")
    rim_thickness: float = _parameter(3.0, 0.8, 15.0, "mm", "rim wall")
    clearance: float = _parameter(0.5, 0.0, 5.0, "mm", "gap between foot and rim (printer tolerance)")
    overhang_max: float = _parameter(10.0, 0.0, 40.0, "mm", "how far the shoe may reach beyond the foot")
    wall_min: float = _parameter(1.2, 0.4, 5.0, "mm", "thinnest wall the printer makes")
    sole_band: float = _parameter(5.0, 0.5, 20.0, "mm", "height of the lowest part of the foot that is its sole")
    density: float = _parameter(1.01, 0.1, 10.0, "g/cm3", "of the printed material; 1.01 is PA12")

    def __post_init__(self) -> None:
        for name, value in self.as_dict().items():
            low, high, unit, _ = self.range_of(name)
            number = isinstance(value, (int, float)) and not isinstance(value, bool)
            if not (number and math.isfinite(value) and low <= value <= high):
                raise InputError(f"shoe parameter {name} is {value!r} {unit}; allowed: {low:g} to {high:g} {unit}")
            object.__setattr__(self, name, float(value))
        if self.floor < self.wall_min:
            raise InputError(
                f"shoe parameters leave {self.floor:g} mm of floor above the pockets (plate_thickness - patch_depth - "
                f"pocket_depth); allowed: wall_min = {self.wall_min:g} mm or more"
            )
        for name in ("rib", "border", "rim_thickness"):
            if getattr(self, name) < self.wall_min:
                raise InputError(
                    f"shoe parameter {name} is {getattr(self, name):g} mm; "
                    f"allowed: wall_min = {self.wall_min:g} mm or more"
                )
        if self.border + self.pocket_clearance > self.overhang_max + self.clearance + self.rim_thickness:
            raise InputError(
                f"shoe parameter border is {self.border:g} mm; "
                "allowed: what overhang_max, clearance and rim_thickness leave"
            )

    @property
    def floor(self) -> float:
        """Thickness between the taxel pockets and the foot in mm."""
        return self.plate_thickness - self.patch_depth - self.pocket_depth

    @property
    def height(self) -> float:
        """Height of the whole shoe in mm."""
        return self.plate_thickness + self.rim_height

    def as_dict(self) -> dict[str, float]:
        """All parameters by name."""
        return {f.name: getattr(self, f.name) for f in fields(self)}

    @classmethod
    def range_of(cls, name: str) -> tuple[float, float, str, str]:
        """Lowest and highest value, unit and meaning of a parameter.

        Raises:
            InputError: If there is no such parameter; the message names all of them.
        """
        for f in fields(cls):
            if f.name == name:
                return f.metadata["low"], f.metadata["high"], f.metadata["unit"], f.metadata["text"]
        raise InputError(f"unknown shoe parameter '{name}'; allowed: {', '.join(f.name for f in fields(cls))}")

    @classmethod
    def from_mapping(cls, values: Mapping[str, Any]) -> ShoeParameters:
        """Defaults with some values replaced.

        Args:
            values: Parameter names and values in the parameter's unit.

        Raises:
            InputError: If a name is unknown or a value is out of its range.
        """
        for name in values:
            cls.range_of(name)
        return cls(**values)


def read_parameters(path: str | os.PathLike[str]) -> ShoeParameters:
    """Read shoe parameters from a JSON or TOML file; what it does not name keeps its default.

    Args:
        path: File that ends in .json or .toml and holds `name = value` pairs, in mm.

    Returns:
        The checked parameters.

    Raises:
        InputError: If the file cannot be read, or a name or value is not allowed.
    """
    file = Path(path)
    if file.suffix.lower() not in (".json", ".toml"):
        raise InputError(f"parameter file {file} ends in '{file.suffix}'; allowed: .json, .toml")
    try:
        text = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "not a text file"
        raise InputError(f"parameter file {file} cannot be read ({reason})") from None
    try:
        values = json.loads(text) if file.suffix.lower() == ".json" else tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(f"parameter file {file} is not valid {file.suffix[1:].upper()} ({error})") from None
    if not isinstance(values, dict):
        raise InputError(f"parameter file {file} is not a table of name = value pairs")
    try:
        return ShoeParameters.from_mapping(values)
    except InputError as error:
        raise InputError(f"{file}: {error}") from None
