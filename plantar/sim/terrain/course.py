"""A course of solids listed in the scene."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from plantar.common.settings.schema import number, tables
from plantar.common.settings.unknown_keys import refuse_unknown_keys
from plantar.errors import SceneError
from plantar.mechanics.rotation import rotation_from_angles
from plantar.sim.terrain.ground import Ground, PlannedFeet, Solid, Terrain

_SHAPES = {"box": 3, "sphere": 1, "ellipsoid": 3, "cylinder": 2}


class Course(Terrain):
    """Solids on a floor, listed as `[[terrain.solid]]` tables.

    Attributes:
        floor: Floor height in m.
        solid: Tables of `shape` (box, sphere, ellipsoid, cylinder), `size` (half sizes in m; radius; radius and half
            height), `position` of the centre in m, and `angles` (roll, pitch, yaw) in degrees.
    """

    floor: float = number(0.0, "m", -10, 10)
    solid: tuple[Mapping[str, Any], ...] = tables()

    def __post_init__(self) -> None:
        super().__post_init__()
        for i, table in enumerate(self.solid):
            _solid(table, f"terrain.solid {i}")

    def ground(self, feet: PlannedFeet, rng: np.random.Generator) -> Ground:
        solids = tuple(_solid(table, f"terrain.solid {i}") for i, table in enumerate(self.solid))
        return Ground(solids, self.floor, self.friction)


def _solid(table: Mapping[str, Any], where: str) -> Solid:
    if not isinstance(table, Mapping):
        raise SceneError(f"{where} is not a table")
    refuse_unknown_keys(table, ("shape", "size", "position", "angles"), where, SceneError)
    shape = table.get("shape", "box")
    if not isinstance(shape, str) or shape not in _SHAPES:
        raise SceneError(f"{where}: shape is {shape!r}; allowed: {', '.join(_SHAPES)}")
    size = _numbers(table.get("size"), _SHAPES[shape], f"{where}: size")
    if not all(0.0 < v <= 100.0 for v in size):
        raise SceneError(f"{where}: size is {size}; allowed: above 0, up to 100 m")
    position = _numbers(table.get("position"), 3, f"{where}: position")
    roll, pitch, yaw = (math.radians(v) for v in _numbers(table.get("angles", [0, 0, 0]), 3, f"{where}: angles"))
    x, y, z = (*size, 0.0, 0.0)[:3]
    return Solid(shape, (x, y, z), np.array(position), rotation_from_angles(yaw, pitch, roll))


def _numbers(value: Any, count: int, where: str) -> tuple[float, ...]:
    good = isinstance(value, list) and len(value) == count
    if not good or not all(type(v) in (int, float) and math.isfinite(v) for v in value):
        raise SceneError(f"{where} is {value!r}; allowed: {count} finite numbers in [ ]")
    return tuple(float(v) for v in value)
