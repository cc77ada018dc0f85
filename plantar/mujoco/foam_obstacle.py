"""One obstacle as skin measures it: ray lengths and point velocities."""

from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.errors import SceneError
from plantar.kernels.sensors.ground_rays import cast_rays

_KINDS = {name: int(getattr(mujoco.mjtGeom, f"mjGEOM_{name.upper()}")) for name in (
    *("plane", "hfield", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh"),
)}  # fmt: skip
_PIECES = (_KINDS["cylinder"], _KINDS["sphere"], _KINDS["sphere"])


class Obstacle:
    """A geom that skin measures; its velocity is that of its motion."""

    def __init__(self, model: Any, geom: int) -> None:
        self.geom = geom
        self.name = model.geom(geom).name or f"geom {geom}"
        self.body = int(model.geom_bodyid[geom])
        kind = int(model.geom_type[geom])
        size = model.geom_size[geom]
        if kind not in _KINDS.values():
            raise SceneError(
                f"obstacle '{self.name}' is of a kind that skin cannot measure; allowed: {', '.join(_KINDS)}"
            )
        self._model = model
        self._ray = {_KINDS["mesh"]: mujoco.mj_rayMesh, _KINDS["hfield"]: mujoco.mj_rayHfield}.get(kind)
        self._half = float(size[1]) if kind == _KINDS["capsule"] else 0.0
        pieces = _PIECES if kind == _KINDS["capsule"] else (kind,)
        self._kinds = np.array(pieces, dtype=np.int32)
        self._ids = np.arange(len(pieces), dtype=np.int32)
        self._sizes = np.tile(size, (len(pieces), 1))
        self._bounds = np.full(len(pieces), float(model.geom_rbound[geom]))

    def motion(
        self,
        now: tuple[NDArray[np.float64], NDArray[np.float64]],
        before: tuple[NDArray[np.float64], NDArray[np.float64]],
        period: float,
    ) -> NDArray[np.float64]:
        """Returns its motion (9,) in the world by two poses: spin in rad/s, velocity in m/s, its middle in m.

        Middle (3,) in m and rotation (9,) to the world `now` and `before`, a `period` in s earlier; 0 for none.
        """
        found = np.zeros(9)
        found[6:] = now[0]
        if not period or ((now[0] == before[0]).all() and (now[1] == before[1]).all()):
            return found
        turn = now[1].reshape(3, 3) @ before[1].reshape(3, 3).T
        found[0] = 0.5 / period * (turn[2, 1] - turn[1, 2])
        found[1] = 0.5 / period * (turn[0, 2] - turn[2, 0])
        found[2] = 0.5 / period * (turn[1, 0] - turn[0, 1])
        found[3:6] = (now[0] - before[0]) / period
        return found

    def lengths(
        self, data: Any, starts: NDArray[np.float64], ways: NDArray[np.float64], reach: float
    ) -> NDArray[np.float64]:
        """Returns lengths (n,) in m of rays that meet it, -1 for a miss, in MuJoCo's `data`.

        From `starts` (n, 3) in the world in m along unit vectors `ways` (n, 3); lengths beyond `reach` in m do not
        matter.
        """
        found = np.empty(len(starts))
        if self._ray is not None:
            for i, (start, way) in enumerate(zip(starts, ways, strict=True)):
                found[i] = self._ray(self._model, data, self.geom, start, way)
            return found
        positions = data.geom_xpos[self.geom, None]
        frames = data.geom_xmat[self.geom, None]
        if self._half:  # a capsule is a cylinder and two spheres
            axis = self._half * data.geom_xmat[self.geom, 2::3]
            positions = positions + np.array([np.zeros(3), axis, -axis])
            frames = np.repeat(frames, 3, axis=0)
        cast_rays(starts, ways, reach, self._ids, self._kinds, self._sizes, self._bounds, positions, frames, found)
        return found
