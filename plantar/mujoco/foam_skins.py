"""Skins of foam: what sinks in is pressed back, and read as any skin of a model.

MuJoCo's contacts are points, at most a few a pair of shapes, and as stiff as the mass behind them. Foam yields where it
is pressed, by its own stiffness: each taxel's ray measures a depth, pressure follows from depth and rate, friction from
sliding. Both act on the link and on what presses, whose MuJoCo contacts with each other are off.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.arguments import instance, integer, items
from plantar.errors import InputError, RobotError
from plantar.kernels.contacts.foam_patch import FoamPatch
from plantar.kernels.contacts.near_patches import NearPatches
from plantar.kernels.contacts.pressed_patch import load_block, load_parts
from plantar.mujoco.bound_skin import LIFT, SkinReading, reading_of_block
from plantar.mujoco.foam import Foam
from plantar.mujoco.foam_obstacle import Obstacle
from plantar.mujoco.named_id import named_id
from plantar.mujoco.ray_depth import ray_depths
from plantar.sensing.link_skin import BodySkin
from plantar.sensing.reading import Reading

_CONTACT_BIT = 1 << 20  # MuJoCo's bit of contacts among obstacles and what has no skin
_LONGEST_STEP = 0.02  # s between two physics steps over which an obstacle's velocity is taken
_EXACT = 1e-9  # of the load times the extent: how exactly the taxels have the moment


class _Patch(NamedTuple):
    taxels: slice
    link: int
    body: int
    root: int
    starts: NDArray[np.float64]
    foam: FoamPatch
    reach: float


class FoamSkins:
    """Skins of foam on links of a model, among obstacles.

    Args:
        model: The world's; contacts of skinned links with obstacles are switched off in it, and obstacles touch all
            else that collides.
        skin: On links of the model: of `Skins.body_skin`, or of patches of one's own.
        obstacles: Names or ids of the geoms that press. They pass through a skinned link where it has no taxels.
        foam: What it is made of; None for `Foam()`.
        everything: Whether all rays are cast, for comparison; same readings.

    Attributes:
        body_skin: The skin, N taxels on L links.
        force: True normal (N,) in N at the last `press`.
        depth: How far (N,) each taxel yields in m, up to `LIFT` or half of its link.
        distance: True (N,) in m; inf out of range, negative where pressed in.
        wrenches: True (L, 6) on the links about their origins, world frame, by the obstacles on the robot.
        on_obstacles: True (6,) about each geom's middle, world frame, by name.
        cast: Rays cast, over all steps.
        skipped: Rays not cast.

    Raises:
        InputError: If the model is none, or obstacles are neither names nor ids.
        RobotError: If a link or obstacle is missing, or is one of a skinned link.
        SceneError: If an obstacle is of a kind that rays do not meet.

    Example:
        >>> import mujoco
        >>> from plantar.mujoco import Foam, FoamSkins, Skin, Skins
        >>> model = mujoco.MjModel.from_xml_string('''<mujoco><worldbody><body name="arm"><joint/>
        ...   <geom type="capsule" size=".04 .1" mass="1"/></body>
        ...   <body mocap="true" pos="0.08 0 0"><geom name="ball" size=".05"/></body></worldbody></mujoco>''')
        >>> skins = Skins([Skin(body="arm", around=(0, 0, 1)).bind(model)])
        >>> foam = FoamSkins(model, skins.body_skin, ["ball"], Foam(stiffness=1e7))
        >>> data = mujoco.MjData(model)
        >>> mujoco.mj_step1(model, data)
        >>> foam.press(data)
        >>> mujoco.mj_step2(model, data)
        >>> (reading,) = foam(data)
        >>> bool(reading.force.sum() > 1.0), data.ncon
        (True, 0)
    """

    def __init__(
        self,
        model: Any,
        skin: BodySkin,
        obstacles: Sequence[int | str],
        foam: Foam | None = None,
        *,
        everything: bool = False,
    ) -> None:
        instance(model, mujoco.MjModel, "model")
        self.body_skin = instance(skin, BodySkin, "skin")
        self.foam = Foam() if foam is None else instance(foam, Foam, "foam")
        self._everything = everything
        self._bodies = [_body(model, link) for link in skin.links]
        self._patches = [_ready(model, skin, i, self._bodies, self.foam) for i in range(len(skin.patches))]
        if isinstance(obstacles, str):
            raise InputError(f"obstacles is {obstacles!r}; expected a list of names or ids of geoms")
        geoms = [_geom(model, name, self._bodies) for name in items(obstacles, "obstacles")]
        self._obstacles = [Obstacle(model, g) for g in geoms]
        _separate(model, self._bodies, [o.geom for o in self._obstacles])
        self._broad = _broad_phase(model, self._patches, geoms)
        self._touched = sorted({*self._bodies, *(o.body for o in self._obstacles)} - {0})
        self._values = np.zeros((2, len(skin)))
        self.force, self.depth = self._values
        self.distance = np.full(len(skin), np.inf)
        self.wrenches = np.zeros((len(skin.links), 6))
        self.on_obstacles = {o.name: np.zeros(6) for o in self._obstacles}
        self.cast = 0
        self.skipped = 0
        self._vectors = np.zeros((len(skin), 3))
        taxels = [patch.taxels for patch in self._patches]
        self._rooms = [(self.distance[own], self._values[:, own], self._vectors[own]) for own in taxels]
        self._of_patches = np.zeros((len(self._patches), 6))
        self._applied = np.zeros((model.nbody, 6))
        self._data: Any = None
        self._time = -np.inf
        self._period = 0.0
        self._geoms = np.array(geoms, dtype=np.int64)
        self._before = (np.zeros((len(geoms), 3)), np.zeros((len(geoms), 9)))
        self._now = self._before
        self._dirty = True

    def __len__(self) -> int:
        return len(self._patches)

    def press(self, data: Any) -> None:
        """Press obstacles and links apart, once a physics step after `mj_step1` or `mj_forward`.

        Sets their `data.xfrc_applied`; other pushes use `data.qfrc_applied`.
        """
        self._data = instance(data, mujoco.MjData, "data")
        period = float(data.time) - self._time
        self._time = float(data.time)
        self._period = period if 0.0 < period < _LONGEST_STEP else 0.0
        self._before = self._now
        self._now = (data.geom_xpos[self._geoms], data.geom_xmat[self._geoms])
        if self._dirty:
            self._clear(data)
        looked = 0
        near = self._near(data)
        for i, ks in near:
            looked += len(self._patches[i].starts)
            self._feel(data, i, ks)
        self._dirty = bool(near)
        self.cast += looked
        self.skipped += len(self.body_skin) - looked

    def __call__(self, data: Any) -> tuple[SkinReading, ...]:
        """Each patch's reading of the last `press`, in its link's frame; InputError for data that were not pressed."""
        self._check(data)
        return tuple(self._reading(i) for i in range(len(self._patches)))

    def whole(self, data: Any) -> Reading:
        """One reading of all taxels, in the order of `body_skin`; InputError for data that were not pressed."""
        self._check(data)
        return Reading.taken_over(self._time, self.force.copy(), self.distance.copy())

    def patch_force(self, patch: str) -> float:
        """True normal force on a patch in N."""
        return float(self.force[self.body_skin.slices[patch]].sum())

    def add_applied(self, forces: NDArray[np.float64]) -> None:
        """Add to `forces` (bodies, 6) what it applies now, as MuJoCo's `xfrc_applied`."""
        forces += self._applied

    def _check(self, data: Any) -> None:
        if data is not self._data:
            raise InputError("the foam was not pressed in these data; call press(data) after mj_step1, in each step")

    def _reading(self, index: int) -> SkinReading:
        taxels = self._patches[index].taxels
        patch = self.body_skin.patches[index]
        block = load_block(len(patch))
        force, depth, vectors, wrench = load_parts(block)
        force[:] = self.force[taxels]
        depth[:] = self.depth[taxels]
        vectors[:] = self._vectors[taxels]
        wrench[:] = self._of_patches[index]
        # Friction acts where the obstacle's face is, below the taxels' places.
        off = np.cross(patch.positions, vectors).sum(axis=0) - wrench[3:]
        size = float(np.abs(vectors).sum() * np.abs(patch.positions).max())
        near = self.distance[taxels].copy() if patch.proximity_range else None
        return reading_of_block(self._time, force, block, near, bool(np.abs(off).max() <= _EXACT * size), None)

    def _clear(self, data: Any) -> None:
        self._values[:] = 0.0
        self.distance[:] = np.inf
        self.wrenches[:] = 0.0
        self._vectors[:] = 0.0
        self._of_patches[:] = 0.0
        for wrench in self.on_obstacles.values():
            wrench[:] = 0.0
        data.xfrc_applied[self._touched] = 0.0
        self._applied[self._touched] = 0.0

    def _near(self, data: Any) -> list[tuple[int, list[int]]]:
        """Each patch that is near obstacles, with these; all if all rays are cast."""
        if self._everything:
            return [(i, list(range(len(self._obstacles)))) for i in range(len(self._patches))]
        if not self._broad.look(data.xpos, data.xmat, data.geom_xpos, data.geom_xmat):
            return []
        rows = self._broad.near.tolist()
        return [(i, [k for k, close in enumerate(row) if close]) for i, row in enumerate(rows) if any(row)]

    def _feel(self, data: Any, number: int, obstacles: list[int]) -> None:
        patch = self._patches[number]
        foam = patch.foam
        foam.place(data.xmat[patch.body], data.xpos[patch.body])
        own = np.concatenate([data.cvel[patch.body], data.subtree_com[patch.root]])
        for k in obstacles:
            obstacle = self._obstacles[k]
            lengths = obstacle.lengths(data, foam.origins, foam.rays, patch.reach)
            now, before = ((place[k], turn[k]) for place, turn in (self._now, self._before))
            if foam.press(lengths, own, obstacle.motion(now, before, self._period), *self._rooms[number]):
                self._push(data, number, obstacle)

    def _push(self, data: Any, number: int, obstacle: Obstacle) -> None:
        # What the patch's last press has, on link and obstacle.
        patch = self._patches[number]
        foam = patch.foam
        foam.add(self.wrenches[patch.link], data.xpos[patch.body], 1.0)
        foam.add_to_link(self._of_patches[number])
        foam.add(self.on_obstacles[obstacle.name], data.geom_xpos[obstacle.geom], -1.0)
        for target, sign in ((patch.body, 1.0), (obstacle.body, -1.0)):
            if target:  # nothing moves the world
                place = data.xipos[target]
                foam.add(data.xfrc_applied[target], place, sign)
                foam.add(self._applied[target], place, sign)


def _broad_phase(model: Any, patches: list[_Patch], geoms: list[int]) -> NearPatches:
    middles = [0.5 * (p.starts.min(0) + p.starts.max(0)) for p in patches]
    spans = [np.linalg.norm(p.starts - m, axis=1).max() + p.reach for p, m in zip(patches, middles, strict=True)]
    bounds = np.square(model.geom_rbound[geoms])
    bounds[bounds == 0.0] = np.inf  # a plane has none
    return NearPatches(
        np.array([p.body for p in patches], dtype=np.intp),
        np.array([[*m, span**2] for m, span in zip(middles, spans, strict=True)]).reshape(-1, 4),
        np.array([[*(p.starts.min(0) - p.reach), *(p.starts.max(0) + p.reach)] for p in patches]).reshape(-1, 6),
        np.array(geoms, dtype=np.intp),
        model.geom_aabb[geoms].reshape(-1, 6),
        bounds,
    )


def _ready(model: Any, skin: BodySkin, index: int, bodies: list[int], foam: Foam) -> _Patch:
    patch = skin.patches[index]
    inward = np.ascontiguousarray(patch.rotations[:, :, 2])
    link = skin.links.index(patch.link)
    depths = ray_depths(model, bodies[link], patch, LIFT)
    starts = patch.positions + depths[:, None] * inward
    limits = np.array([depths, depths + patch.proximity_range])
    made_of = np.array([foam.stiffness, foam.damping, foam.friction, foam.slip_speed])
    return _Patch(
        taxels=skin.slices[patch.name],
        link=link,
        body=bodies[link],
        root=int(model.body_rootid[bodies[link]]),
        starts=starts,
        foam=FoamPatch(starts, -inward, np.ascontiguousarray(patch.areas), limits, made_of),
        reach=LIFT + patch.proximity_range,
    )


def _body(model: Any, link: str) -> int:
    body = int(mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, link))
    if body < 0:
        raise RobotError(f"the world has no link '{link}', which carries skin")
    return body


def _geom(model: Any, name: int | str, skinned: Sequence[int]) -> int:
    geom = named_id(model, "geom", name) if isinstance(name, str) else integer(name, "obstacle", 0, model.ngeom - 1)
    body = int(model.geom_bodyid[geom])
    if body in skinned:
        raise RobotError(f"obstacle '{name}' is a shape of '{model.body(body).name}', which has skin; allowed: others")
    return geom


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
