"""Distance sensors of a mobile base: a level scan (A 3.2.4)."""

import math
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import Settings, number, whole

_NO_ECHO = 1e6  # m: distance of a ray that meets nothing


class LidarSettings(Settings):
    """The distance sensors, after safety laser scanners of mobile bases.

    Attributes:
        rate: Scans a second.
        rays: Rays around the base.
        height: Of the scan above the ground.
        reach: Largest distance.
        noise: Standard deviation of a distance.
        gap: Difference of neighbouring distances that separates two things.
    """

    rate: float = number(25.0, "1/s", 0.1, 1000)
    rays: int = whole(360, "rays", 8, 10000)
    height: float = number(0.25, "m", 0.0, 2.0)
    reach: float = number(3.0, "m", 0.1, 100)
    noise: float = number(0.01, "m", 0.0, 1.0)
    gap: float = number(0.15, "m", 0.01, 10.0)


class Lidar:
    """Scans the world around a base without the machine itself."""

    def __init__(self, model: Any, base: str, settings: LidarSettings, seed: int) -> None:
        self.settings = settings
        self._model = model
        self._base = model.body(base).id
        self._rng = np.random.default_rng([seed, 0x11DA])
        angles = np.arange(settings.rays) * (2.0 * math.pi / settings.rays)
        self._ways = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(settings.rays)])
        root = model.body_rootid[self._base]
        self._own = np.isin(model.geom_bodyid, np.flatnonzero(model.body_rootid == root))

    def scan(self, data: Any) -> NDArray[np.float64]:
        """Nearest point (m, 2) of each thing, base frame, in m."""
        s = self.settings
        rotation = data.xmat[self._base].reshape(3, 3)
        origin = data.xpos[self._base] + rotation @ np.array([0.0, 0.0, s.height])
        distances = self._distances(data, origin, self._ways @ rotation.T) + self._rng.normal(0.0, s.noise, s.rays)
        distances[~((distances > 0.0) & (distances < s.reach))] = _NO_ECHO
        group = np.cumsum(np.abs(np.diff(distances, prepend=distances[0])) > s.gap)
        if abs(distances[0] - distances[-1]) <= s.gap:  # one thing across the scan's beginning
            group[group == group[-1]] = group[0]
        nearest = [own[np.argmin(distances[own])] for own in (np.flatnonzero(group == g) for g in np.unique(group))]
        return np.array([self._ways[i, :2] * distances[i] for i in nearest if distances[i] < _NO_ECHO]).reshape(-1, 2)

    def _distances(self, data: Any, origin: NDArray[np.float64], ways: NDArray[np.float64]) -> NDArray[np.float64]:
        # Distance (rays,) along each ray; inf for a miss.
        found = np.full(len(ways), np.inf)
        for geom in np.flatnonzero(~self._own).tolist():
            center = data.geom_xpos[geom] - origin
            reach = float(self._model.geom_rbound[geom])
            kind = int(self._model.geom_type[geom])
            if kind == mujoco.mjtGeom.mjGEOM_PLANE or np.hypot(*center[:2]) - reach > self.settings.reach:
                continue
            along = ways @ center  # only rays that pass the geom's sphere
            aside = center @ center - along**2
            for i in np.flatnonzero((aside <= reach**2) & (along > -reach)).tolist():
                length = mujoco.mju_rayGeom(
                    data.geom_xpos[geom], data.geom_xmat[geom], self._model.geom_size[geom], origin, ways[i], kind, None
                )
                if 0.0 <= length < found[i]:
                    found[i] = length
        return found
