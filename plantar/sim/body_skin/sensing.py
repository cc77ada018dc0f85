"""Simulated skin on any link, and how it presses back on obstacles.

An elastic foundation: each taxel's ray measures depth; pressure follows from depth and rate, friction from sliding.
Both act on link and obstacle, whose MuJoCo contacts are off.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import number, switch
from plantar.errors import RobotError
from plantar.sensing.link_skin import BodySkin
from plantar.sensing.reading import Reading
from plantar.sim.body_skin.electronics import SkinElectronics, SkinElectronicsSettings
from plantar.sim.body_skin.obstacle import Obstacle
from plantar.sim.body_skin.surface import OBSTACLE_GROUP

LIFT = 0.02
"""Depth in m below the surface from which rays start: what sinks in deeper is not measured."""

_CONTACT_BIT = 1 << 20  # MuJoCo's bit of contacts among obstacles and what has no skin
_LONGEST_STEP = 0.02  # s between two physics steps over which an obstacle's velocity is taken


class SkinSensing(SkinElectronicsSettings):
    """Material and quality of a skin.

    Attributes:
        stiffness: In Pa/m; by default 10 mm of 100 kPa foam.
        damping: In Pa s/m.
        friction: Coulomb's coefficient.
        slip_speed: In m/s, where friction reaches 71 % of Coulomb's.
        everything: Cast all rays, for comparison; same readings.
    """

    stiffness: float = number(1e7, "Pa/m", 1e4, 1e10)
    damping: float = number(3e4, "Pa s/m", 0.0, 1e8)
    friction: float = number(0.5, "1", 0.0, 2.0)
    slip_speed: float = number(0.02, "m/s", 1e-4, 1.0)
    everything: bool = switch(False)


class _Patch(NamedTuple):
    taxels: slice
    link: int
    body: int
    root: int
    starts: NDArray[np.float64]
    ways: NDArray[np.float64]
    areas: NDArray[np.float64]
    reach: float


class SkinSensor:
    """The skin of a machine or robot among obstacles.

    Args:
        model: The world's; contacts between skinned links and obstacles are switched off.
        skin: On links of the model.
        settings: Its material and quality.
        seed: Of noise, gain errors and dead taxels.
        obstacles: Measured geom ids; None for all of `OBSTACLE_GROUP`.

    Attributes:
        force: True normal (N,) in N at the last `apply`.
        distance: True (N,) in m; inf out of range, negative where pressed in.
        wrenches: True (L, 6) on `skin.links` about their origins, world frame.
        on_obstacles: True (6,) about each geom's middle, world frame, by name.
        temperature: True (N,) in degC of a heat model, or None.
        cast: Rays cast, over all steps.
        skipped: Rays not cast.

    Raises:
        RobotError: If a link is missing.
        SceneError: If an obstacle is unsupported.
    """

    def __init__(
        self,
        model: Any,
        skin: BodySkin,
        settings: SkinSensing,
        seed: int,
        obstacles: Sequence[int] | None = None,
    ) -> None:
        self.skin = skin
        self.settings = settings
        self._bodies = [_body(model, link) for link in skin.links]
        self._patches = [_ready(model, skin, i, self._bodies) for i in range(len(skin.patches))]
        geoms = np.flatnonzero(model.geom_group == OBSTACLE_GROUP).tolist() if obstacles is None else list(obstacles)
        self._obstacles = [Obstacle(model, g) for g in geoms]
        _separate(model, self._bodies, [o.geom for o in self._obstacles])
        self._broad = _BroadPhase(model, self._patches, geoms)
        self._touched = sorted({*self._bodies, *(o.body for o in self._obstacles)} - {0})
        self.force = np.zeros(len(skin))
        self.distance = np.full(len(skin), np.inf)
        self.wrenches = np.zeros((len(skin.links), 6))
        self.on_obstacles = {o.name: np.zeros(6) for o in self._obstacles}
        self.temperature: NDArray[np.float64] | None = None
        self.cast = 0
        self.skipped = 0
        self._applied = np.zeros((model.nbody, 6))
        self._time = -np.inf
        self._period = 0.0
        self._geoms = np.array(geoms, dtype=np.int64)
        self._before = (np.zeros((len(geoms), 3)), np.zeros((len(geoms), 9)))
        self._now = self._before
        self._dirty = True
        self._electronics = SkinElectronics(skin, settings, seed)

    def apply(self, data: Any) -> None:
        """Press obstacles and links apart, once a physics step after `mj_step1` or `mj_forward`.

        Sets their `data.xfrc_applied`; other pushes use `data.qfrc_applied`.
        """
        period = float(data.time) - self._time
        self._time = float(data.time)
        self._period = period if 0.0 < period < _LONGEST_STEP else 0.0
        self._before = self._now
        self._now = (data.geom_xpos[self._geoms], data.geom_xmat[self._geoms])
        if self._dirty:
            self._clear(data)
        near = self._broad.everything if self.settings.everything else self._broad.near(data)
        looked = 0
        for i, ks in near:
            looked += len(self._patches[i].areas)
            self._feel(data, self._patches[i], ks)
        self._dirty = bool(near)
        self.cast += looked
        self.skipped += len(self.skin) - looked

    def read(self, data: Any) -> Reading:
        """The reading of the last `apply`."""
        return self._electronics.read(float(data.time), self.force, self.distance, self.temperature)

    def patch_force(self, patch: str) -> float:
        """True normal force on a patch in N."""
        return float(self.force[self.skin.slices[patch]].sum())

    def add_applied(self, forces: NDArray[np.float64]) -> None:
        """Add to `forces` (bodies, 6) what it applies now, as MuJoCo's `xfrc_applied`."""
        forces += self._applied

    def _clear(self, data: Any) -> None:
        self.force[:] = 0.0
        self.distance[:] = np.inf
        self.wrenches[:] = 0.0
        for wrench in self.on_obstacles.values():
            wrench[:] = 0.0
        data.xfrc_applied[self._touched] = 0.0
        self._applied[self._touched] = 0.0

    def _feel(self, data: Any, patch: _Patch, obstacles: list[int]) -> None:
        rotation = data.xmat[patch.body].reshape(3, 3)
        starts = patch.starts @ rotation.T + data.xpos[patch.body]
        ways = patch.ways @ rotation.T
        nearest = self.distance[patch.taxels]
        for k in obstacles:
            lengths = self._obstacles[k].lengths(data, starts, ways, patch.reach)
            distance = np.where((lengths >= 0.0) & (lengths <= patch.reach), lengths - LIFT, np.inf)
            np.minimum(nearest, distance, out=nearest)
            pressed = np.flatnonzero(distance < 0.0)
            if len(pressed):
                points = starts[pressed] + lengths[pressed, None] * ways[pressed]
                self._press(data, patch, k, pressed, (points, -ways[pressed], -distance[pressed]))

    def _press(
        self,
        data: Any,
        patch: _Patch,
        index: int,
        pressed: NDArray[np.int64],
        contact: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]],
    ) -> None:
        # Normal and friction forces at points (m, 3) by inward normals (m, 3) and depths (m,).
        points, normals, depths = contact
        obstacle = self._obstacles[index]
        now, before = (tuple(part[index] for part in where) for where in (self._now, self._before))
        s = self.settings
        body = patch.body
        spin = data.cvel[body, :3]
        drift = data.cvel[body, 3:]
        middle = data.subtree_com[patch.root]
        sliding = obstacle.velocity(points, now, before, self._period) - drift - np.cross(spin, points - middle)
        rates = np.einsum("ij,ij->i", sliding, normals)
        forces = np.maximum(patch.areas[pressed] * (s.stiffness * depths + s.damping * rates), 0.0)
        sliding -= rates[:, None] * normals
        speeds = np.sqrt(np.einsum("ij,ij->i", sliding, sliding) + s.slip_speed**2)
        pushes = forces[:, None] * (normals + (s.friction / speeds)[:, None] * sliding)
        self.force[patch.taxels.start + pressed] += forces
        total = pushes.sum(0)
        about_origin = np.cross(points, pushes).sum(0)
        self.wrenches[patch.link, :3] += total
        self.wrenches[patch.link, 3:] += about_origin - np.cross(data.xpos[body], total)
        for target, sign in ((body, 1.0), (obstacle.body, -1.0)):
            for forces in (data.xfrc_applied, self._applied):
                forces[target, :3] += sign * total
                forces[target, 3:] += sign * (about_origin - np.cross(data.xipos[target], total))
        reaction = self.on_obstacles[obstacle.name]
        reaction[:3] -= total
        reaction[3:] -= about_origin - np.cross(data.geom_xpos[obstacle.geom], total)


class _BroadPhase:
    """Which patches are near obstacles: spheres against boxes."""

    def __init__(self, model: Any, patches: list[_Patch], geoms: list[int]) -> None:
        self.everything = [(i, list(range(len(geoms)))) for i in range(len(patches))]
        self._geoms = np.array(geoms, dtype=np.int64)
        self._bodies = np.array([p.body for p in patches])
        middles = np.array([0.5 * (p.starts.min(0) + p.starts.max(0)) for p in patches])
        spans = [np.linalg.norm(p.starts - m, axis=1).max() + p.reach for p, m in zip(patches, middles, strict=True)]
        self._middles = np.ascontiguousarray(middles[:, :, None])
        self._squares = np.square(spans)
        boxes = model.geom_aabb[self._geoms].reshape(-1, 6)
        self._centres = boxes[:, None, :3].copy()
        self._halves = boxes[:, None, 3:].copy()
        lows = [p.starts.min(0) - p.reach for p in patches]
        highs = [p.starts.max(0) + p.reach for p in patches]
        self._lows = np.array(lows)
        self._highs = np.array(highs)
        bounds = model.geom_rbound[self._geoms].copy()
        bounds[bounds == 0.0] = np.inf  # a plane has none
        self._bounds = np.square(bounds)

    def near(self, data: Any) -> list[tuple[int, list[int]]]:
        if not len(self._geoms):
            return []
        turned = data.xmat[self._bodies].reshape(-1, 3, 3) @ self._middles
        middles = data.xpos[self._bodies] + turned[:, :, 0]
        apart = middles - data.geom_xpos[self._geoms][:, None]
        local = apart @ data.geom_xmat[self._geoms].reshape(-1, 3, 3)
        outside = np.maximum(np.abs(local - self._centres) - self._halves, 0.0)
        close = np.einsum("kpi,kpi->pk", outside, outside) <= self._squares[:, None]
        rows, columns = close.nonzero()
        if not len(rows):
            return []
        turns = data.xmat[self._bodies[rows]].reshape(-1, 3, 3)
        apart = data.geom_xpos[self._geoms[columns]] - data.xpos[self._bodies[rows]]
        local = np.einsum("kji,kj->ki", turns, apart)
        outside = np.maximum(np.maximum(self._lows[rows] - local, local - self._highs[rows]), 0.0)
        met = np.einsum("ki,ki->k", outside, outside) <= self._bounds[columns]
        found: dict[int, list[int]] = {}
        for i, k in zip(rows[met].tolist(), columns[met].tolist(), strict=True):
            found.setdefault(i, []).append(k)
        return list(found.items())


def _ready(model: Any, skin: BodySkin, index: int, bodies: list[int]) -> _Patch:
    patch = skin.patches[index]
    inward = np.ascontiguousarray(patch.rotations[:, :, 2])
    link = skin.links.index(patch.link)
    return _Patch(
        taxels=skin.slices[patch.name],
        link=link,
        body=bodies[link],
        root=int(model.body_rootid[bodies[link]]),
        starts=patch.positions + LIFT * inward,
        ways=-inward,
        areas=patch.areas,
        reach=LIFT + patch.proximity_range,
    )


def _body(model: Any, link: str) -> int:
    body = int(mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, link))
    if body < 0:
        raise RobotError(f"the world has no link '{link}', which carries skin")
    return body


def _separate(model: Any, skinned: list[int], obstacles: list[int]) -> None:
    touchable = (model.geom_contype != 0) | (model.geom_conaffinity != 0)
    solid = [g for g in obstacles if touchable[g]]
    others = touchable & ~np.isin(model.geom_bodyid, skinned)
    model.geom_conaffinity[others] |= _CONTACT_BIT
    model.geom_contype[solid] = _CONTACT_BIT
    model.geom_conaffinity[solid] = _CONTACT_BIT
    for g in range(model.ngeom):
        body = model.geom_bodyid[g]
        model.body_contype[body] |= model.geom_contype[g]
        model.body_conaffinity[body] |= model.geom_conaffinity[g]
