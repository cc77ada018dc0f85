"""Pads that press on a link with a wanted force, along its normal, and follow the link."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.sensing.link_skin import SkinPatch
from plantar.sim.body_skin.surface import OBSTACLE_GROUP

__all__ = ["Pad"]

_CLEAR = 0.03  # m off the skin while it does not press
_APPROACH = 0.15  # m/s
_SEARCH = 0.06  # m/s with which it comes near
_SOFTLY = 600.0  # 1/s: a large face comes slower, or it would land with far more than its force
_SETTLE = 60.0  # 1/s: how fast its force is corrected
_COLOUR = (0.85, 0.6, 0.45, 1.0)


class Pad:
    """A cylinder or a box that is moved; its face stays on a taxel's normal.

    Args:
        name: Body and geom are called "pad " and this.
        taxel: Index in the patch of the taxel in the middle of its face.
        face: Radius of its face in m.
        stiffness: In N/m of the skin under its face, about.

    Attributes:
        wanted: Force in N; 0 or less lifts it off.
        parked: Whether it is far away.
        middle: Place (3,) on the link of the middle of its face, in the link's frame in m.
    """

    def __init__(self, name: str, patch: SkinPatch, taxel: int, face: float, stiffness: float) -> None:
        self.name, self.patch, self.face = f"pad {name}", patch, face
        self.wanted = 0.0
        self.parked = True
        self.middle, self._turn = patch.positions[taxel], patch.rotations[taxel]
        self._half = 0.02
        self._gap = _CLEAR
        self._stiffness = stiffness
        self._last: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None

    @property
    def inward(self) -> NDArray[np.float64]:
        """Direction (3,) in which it presses, in the link's frame."""
        return np.asarray(self._turn[:, 2])

    def add_to(self, spec: Any) -> None:
        """Add it to a world."""
        body = spec.worldbody.add_body(name=self.name, mocap=True, pos=[0.0, 0.0, 5.0])
        body.add_geom(
            name=self.name,
            type=mujoco.mjtGeom.mjGEOM_CYLINDER,
            size=[self.face, self._half, 0.0],
            rgba=_COLOUR,
            contype=0,
            conaffinity=0,
            group=OBSTACLE_GROUP,
        )

    def act(self, world: Any, force: float, period: float) -> None:
        """Move it in the `world`, once a physics step, by its `force` in N now and the `period` in s since the last
        call.
        """
        if self.wanted > 0.0:
            rate = np.clip((force - self.wanted) * _SETTLE / self._stiffness, -_APPROACH, _APPROACH)
            rate = rate if force > 0.0 else -min(_SEARCH, _SOFTLY * self.wanted / self._stiffness)
            self._gap = max(self._gap + rate * period, -0.018)
        else:
            if self.parked:
                return
            self._gap = min(self._gap + _APPROACH * period, _CLEAR)
        origin, rotation = world.pose(self.patch.link)
        before = self._last or (origin, rotation)
        self._last = (origin, rotation)
        ahead, turned = 2.0 * origin - before[0], rotation @ before[1].T @ rotation
        inward = turned @ self.inward
        number = int(world.model.body(self.name).mocapid[0])
        self.parked = self.wanted <= 0.0 and self._gap >= _CLEAR
        if self.parked:  # out of everybody's way
            world.data.mocap_pos[number] = [0.0, 0.0, 5.0]
            self._last = None
            return
        world.data.mocap_pos[number] = ahead + turned @ self.middle - (self._gap + self._half) * inward
        mujoco.mju_mat2Quat(world.data.mocap_quat[number], np.ascontiguousarray(turned @ self._turn).ravel())

    def touching(self, world: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Target (3,) of its face in the world in m, and the direction (3,) into the link."""
        origin, rotation = world.pose(self.patch.link)
        return origin + rotation @ self.middle, rotation @ self.inward

    def force(self, on_obstacles: dict[str, NDArray[np.float64]], rotation: NDArray[np.float64]) -> float:
        """Returns the force in N along its axis, from the skin's wrenches `on_obstacles` and the pressed link's
        `rotation` (3, 3).
        """
        return float(-on_obstacles[self.name][:3] @ (rotation @ self.inward))
