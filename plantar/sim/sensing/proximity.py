"""Simulated proximity of a sole: one ray a taxel along its -z, and its electronics.

Rays are costly: none for a sole not asked for or out of range.
"""

import math
from collections.abc import Collection
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.kernels.sensors.sole_rays import SoleRays
from plantar.kernels.sensors.sole_sampling import ProximitySampling
from plantar.layouts.layout import SoleLayout
from plantar.mujoco.named_id import named_id
from plantar.sim.plant.ground import GroundColours
from plantar.sim.sensing.white_noise import white_noise
from plantar.sim.terrain import GROUND_GROUP

_LIFT = 0.02  # m inside the foot at which rays begin, so that a taxel that is pressed into the ground still sees it
_GROUPS = np.array([1 if i == GROUND_GROUP else 0 for i in range(6)], dtype=np.uint8)
_SIMPLE = tuple(
    int(getattr(mujoco.mjtGeom, f"mjGEOM_{s}")) for s in ("PLANE", "SPHERE", "ELLIPSOID", "CYLINDER", "BOX")
)


class SoleProximity:
    """Distances from the taxels of one sole to the ground.

    `site`: name of the sole frame's site; `sensing_range` in m; `ground_top`: largest ground height in m; `colours`:
    None: as light as at calibration.
    """

    def __init__(
        self,
        model: Any,
        layout: SoleLayout,
        site: str,
        sensing_range: float = 0.05,
        ground_top: float = math.inf,
        colours: GroundColours | None = None,
    ) -> None:
        self.layout = layout
        self.range = sensing_range
        self._model = model
        self._site = named_id(model, "site", site)
        axes = layout.rotations[:, :, 2]
        self._start = np.ascontiguousarray(layout.positions + _LIFT * axes)
        self._way = np.ascontiguousarray(-axes)
        self._reach = float(np.linalg.norm(layout.positions[:, :2], axis=1).max())
        self._top = ground_top
        self._colours = colours
        ids = np.flatnonzero(model.geom_group == GROUND_GROUP)
        kinds = model.geom_type[ids].astype(np.int32)
        self._simple = bool(np.isin(kinds, _SIMPLE).all())
        self._solids = ids.astype(np.int32), kinds, model.geom_size[ids], model.geom_rbound[ids]
        self._data: Any = None  # in which the rays are cast
        self._rays: SoleRays | None = None

    def _rays_in(self, data: Any) -> SoleRays:
        if self._rays is None or data is not self._data:
            self._data = data
            place = data.site_xpos[self._site], data.site_xmat[self._site].reshape(3, 3)
            ground = self._solids, data.geom_xpos, data.geom_xmat
            self._rays = SoleRays(self._start, self._way, _LIFT, self.range, *place, *ground)
            self._rays.limit(self._reach, self._top + self.range)
        return self._rays

    def plain_rays(self, data: Any) -> SoleRays | None:
        """Rays in `data` whose own `look` is all there is to do; None on ground that only MuJoCo casts rays on, or of
        several colours.
        """
        return self._rays_in(data) if self._simple and self._colours is None else None

    def within_range(self, data: Any) -> bool:
        """Whether any ground can be in range."""
        return bool(self._rays_in(data).lies_below(self._reach, self._top + self.range))

    def distances(self, data: Any) -> NDArray[np.float64]:
        """Noise-free distance (n,) to the ground in m as its colour shows it.

        inf out of range; negative up to 20 mm inside the ground.
        """
        return np.array(self.look(data).distances)

    def look(self, data: Any) -> SoleRays:
        """Cast rays where ground can be in range; returns them with `distances`."""
        rays = self._rays_in(data)
        if self._simple and self._colours is None:
            rays.look()
            return rays
        if not self.within_range(data):
            rays.see_nothing()
            return rays
        if self._simple:
            rays.cast()
        else:
            rays.aim()
            geom = np.empty(1, dtype=np.int32)
            for i, (start, way) in enumerate(zip(rays.starts, rays.ways, strict=True)):
                rays.lengths[i] = mujoco.mj_ray(self._model, data, start, way, _GROUPS, 1, -1, geom)
        rays.measure()
        if self._colours is not None:
            distances = rays.distances
            met = rays.starts + rays.lengths[:, None] * rays.ways
            distances *= self._colours.stretch(met)
        return rays


class ProximitySensor:
    """Proximity as its electronics deliver it: noisy, biased, with dead taxels.

    `proximity`: the noise-free sensor; `noise_std` in m; `bias` in m; `rng`: advances at each `read`, with or without
    rays; `dead`: indices that read NaN. Attribute `samples`: the kernel that keeps count of them.
    """

    def __init__(
        self,
        proximity: SoleProximity,
        noise_std: float,
        bias: float,
        rng: np.random.Generator,
        dead: Collection[int] = (),
    ) -> None:
        self.proximity = proximity
        self.dead = np.array(sorted(dead), dtype=np.int64)
        count = len(proximity.layout)
        self.samples = ProximitySampling(white_noise(rng, bias, noise_std, count), count, self.dead)

    @property
    def cast(self) -> int:
        """How many rays were cast."""
        return int(self.samples.cast)

    @property
    def skipped(self) -> int:
        """How many rays were left out, since no caller wanted them."""
        return int(self.samples.skipped)

    def read(self, data: Any, wanted: bool, everything: bool = False) -> NDArray[np.float64] | None:
        """One sample.

        `everything`: cast the rays in any case. Returns (n,) in m, inf out of range, NaN for a dead taxel; None where
        not wanted.
        """
        if not (wanted or everything):
            self.samples.skip()
            return None
        rays = self.proximity.look(data)
        if not wanted:
            self.samples.leave()
            return None
        sample: NDArray[np.float64] = self.samples.of(rays)
        return sample
