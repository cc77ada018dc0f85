"""One obstacle as skin feels it: how far rays go until they meet it, and how fast its points move."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.errors import SceneError
from plantar.kernels.ground_rays import cast_rays

__all__ = ["Obstacle"]

_KINDS = {name: int(getattr(mujoco.mjtGeom, f"mjGEOM_{name.upper()}")) for name in (
    *("plane", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh"),
)}  # fmt: skip
_PIECES = (_KINDS["cylinder"], _KINDS["sphere"], _KINDS["sphere"])


class Obstacle:
    """A geom that skin feels. Its velocity comes from its motion, since a mocap body has none of its own.

    Args:
        model: The MjModel.
        geom: Index of the geom.

    Attributes:
        name: Name of the geom.
        geom: Index of the geom.
        body: Index of its body.

    Raises:
        SceneError: If it is neither a plane, sphere, capsule, ellipsoid, cylinder, box nor mesh.
    """

    def __init__(self, model: Any, geom: int) -> None:
        self.geom = geom
        self.name = model.geom(geom).name or f"geom {geom}"
        self.body = int(model.geom_bodyid[geom])
        kind, size = int(model.geom_type[geom]), model.geom_size[geom]
        if kind not in _KINDS.values():
            raise SceneError(f"obstacle '{self.name}' is of a kind that skin cannot feel; allowed: {', '.join(_KINDS)}")
        self._model = model
        self._mesh = kind == _KINDS["mesh"]
        self._half = float(size[1]) if kind == _KINDS["capsule"] else 0.0
        pieces = _PIECES if kind == _KINDS["capsule"] else (kind,)
        self._kinds = np.array(pieces, dtype=np.int32)
        self._ids = np.arange(len(pieces), dtype=np.int32)
        self._sizes = np.tile(size, (len(pieces), 1))
        self._bounds = np.full(len(pieces), float(model.geom_rbound[geom]))
        self._position, self._rotation = np.zeros(3), np.eye(3)
        self._linear, self._angular = np.zeros(3), np.zeros(3)

    def follow(self, data: Any, period: float) -> None:
        """Take over where it is; its velocity follows from where it was.

        Args:
            data: The MjData.
            period: Time in s since the last call; 0 where the velocity shall count as 0.
        """
        position, rotation = data.geom_xpos[self.geom], data.geom_xmat[self.geom].reshape(3, 3)
        if period and (position != self._position).any() | (rotation != self._rotation).any():
            turn = rotation @ self._rotation.T
            self._linear = (position - self._position) / period
            self._angular = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
            self._angular *= 0.5 / period
        else:
            self._linear = self._angular = np.zeros(3)
        self._position, self._rotation = position.copy(), rotation.copy()

    def velocity(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Velocity (m, 3) in m/s of its points (m, 3) in the world."""
        return np.asarray(self._linear + np.cross(self._angular, points - self._position))

    def lengths(
        self, data: Any, starts: NDArray[np.float64], ways: NDArray[np.float64], reach: float
    ) -> NDArray[np.float64]:
        """How far rays go until they meet it.

        Args:
            data: The MjData.
            starts: Where the rays begin (n, 3) in the world in m.
            ways: Unit vectors (n, 3) along them.
            reach: Length in m beyond which a meeting need not be found.

        Returns:
            Lengths (n,) in m; -1 for a ray that meets nothing.
        """
        found = np.empty(len(starts))
        if self._mesh:
            for i, (start, way) in enumerate(zip(starts, ways, strict=True)):
                found[i] = mujoco.mj_rayMesh(self._model, data, self.geom, start, way)
            return found
        positions, frames = data.geom_xpos[self.geom, None], data.geom_xmat[self.geom, None]
        if self._half:  # a capsule is a cylinder and two spheres
            axis = self._half * data.geom_xmat[self.geom, 2::3]
            positions = positions + np.array([np.zeros(3), axis, -axis])
            frames = np.repeat(frames, 3, axis=0)
        cast_rays(starts, ways, reach, self._ids, self._kinds, self._sizes, self._bounds, positions, frames, found)
        return found
