"""Terrain: the ground that the robot walks on and that the controller never sees."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from sim.table import limits

__all__ = ["Terrain"]


@dataclass(frozen=True)
class Terrain:
    """Ground of a scene.

    Attributes:
        kind: "flat": an endless level plane.
        friction: Sliding friction coefficient of sole on ground.
        height: Height of the ground in m.
    """

    kind: str = field(default="flat", metadata={"choices": ("flat",)})
    friction: float = field(default=0.8, metadata=limits(0.05, 5.0))
    height: float = field(default=0.0, metadata=limits(-10.0, 10.0))

    def add_to(self, spec: Any) -> None:
        """Add the ground's geoms to a `mujoco.MjSpec`."""
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
