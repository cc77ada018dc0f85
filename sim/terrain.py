"""Terrain: the ground that the robot walks on and that the controller never sees."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from plantar.errors import SceneError

__all__ = ["Terrain"]


@dataclass(frozen=True)
class Terrain:
    """Ground of a scene.

    Attributes:
        kind: "flat".
        friction: Sliding friction coefficient of sole on ground.
        height: Height of the ground in m.
    """

    kind: str = "flat"
    friction: float = 0.8
    height: float = 0.0

    @classmethod
    def from_table(cls, table: Mapping[str, Any], where: str) -> Terrain:
        """Read the `[terrain]` table of a scene.

        Raises:
            SceneError: If a value is unknown or outside what is allowed.
        """
        allowed = ("kind", "friction", "height")
        for key in table:
            if key not in allowed:
                raise SceneError(f"{where}: [terrain] has an unknown key '{key}'; allowed: {', '.join(allowed)}")
        terrain = cls(**table)
        if terrain.kind != "flat":
            raise SceneError(f"{where}: [terrain] kind is {terrain.kind!r}; allowed: flat")
        for key, low, high in (("friction", 0.05, 5.0), ("height", -10.0, 10.0)):
            value = getattr(terrain, key)
            if isinstance(value, bool) or not isinstance(value, (int, float)) or not low <= value <= high:
                raise SceneError(f"{where}: [terrain] {key} is {value!r}; allowed: {low:g} to {high:g}")
        return terrain

    def add_to(self, spec: Any) -> None:
        """Add the ground's geoms to a MuJoCo spec.

        Args:
            spec: A `mujoco.MjSpec`.
        """
        import mujoco

        spec.worldbody.add_geom(
            name="ground",
            type=mujoco.mjtGeom.mjGEOM_PLANE,
            size=[0.0, 0.0, 1.0],
            pos=[0.0, 0.0, self.height],
            contype=2,
            conaffinity=1,
            friction=[self.friction, 0.005, 0.0001],
            material="ground",
        )

