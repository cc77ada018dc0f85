"""A plantar skin in a MuJoCo model, read from simulation data."""

import math
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from threading import Lock
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.common.arguments import integer, items
from plantar.common.arrays import array
from plantar.errors import InputError
from plantar.geometry.polygon import convex_hull
from plantar.kernels.contacts.foot_contacts import ContactsInSole, FootContacts
from plantar.kernels.contacts.patch_load import PatchLoad
from plantar.kernels.contacts.taxel_load import TaxelLoad
from plantar.layouts.layout import SoleLayout
from plantar.mujoco.contacts import ContactReader
from plantar.percepts.percept import Percept
from plantar.percepts.sole_pose import SolePose
from plantar.sensing.link_skin import SkinPatch
from plantar.sensing.reading import Reading

_LIFT = 0.02  # m inside the body at which proximity rays begin
_PASSED = 20  # surfaces of its own that a ray passes at most
LoadMaker = Callable[[], PatchLoad]
"""Makes the kernel of a patch that wraps."""

_MOST_DATA = 64  # whose contacts it keeps in view, and so in memory, unless more are read at once


class SkinReading(Reading):
    """A `Reading` with what only a simulation knows, sole frame; n taxels.

    Attributes:
        force: (n,) along each taxel's axis in N.
        vectors: Force (n, 3) on each taxel in N.
        wrench: Wrench (6,) of MuJoCo's contacts on body about sole origin in N and N m.
        depth: Overlap (n,) of geoms in m, 0 elsewhere.
        carried: Whether the vectors have the whole wrench; else only the load on the sole, as its center of pressure is
            beyond the taxels or the body is pressed from above as well.
    """

    vectors: NDArray[np.float64]
    wrench: NDArray[np.float64]
    depth: NDArray[np.float64]
    carried: bool

    @property
    def position_cop_in_sole(self) -> NDArray[np.float64] | None:
        """Contacts' center of pressure (2,) at z = 0 in m; None without load."""
        fz = float(self.wrench[2])
        return np.array([-self.wrench[4] / fz, self.wrench[3] / fz]) if fz > 0.0 else None

    def __reduce__(self) -> tuple[Any, ...]:
        return _made, (self.time, self.force, self.proximity, self.vectors, self.wrench, self.depth, self.carried)


class BoundSkin:
    """A skin in a model, made by `Skin.bind`; reading leaves the simulation unchanged.

    Attributes:
        layout: The sole, n taxels; a `SkinPatch` in the patch's frame if taxels look to all sides.
        rings: Corners (k, 3) of each taxel's cell in m, sole frame.
        body: Id of body.
        geom_ids: Ids of geoms that can touch.
        position_in_body: Sole origin (3,) in the body's frame in m.
        rotation_to_body: Rotation (3, 3) from sole to body.
        reach: Gap in m up to which an unloaded contact counts as near.
        static: Taxels' places, axes, areas, widths, and hull of places, as in `TaxelLoad`.
    """

    def __init__(
        self,
        model: Any,
        layout: SoleLayout | SkinPatch,
        body: int,
        geom_ids: Sequence[int],
        position: NDArray[np.float64],
        rotation: NDArray[np.float64],
        *,
        reach: float,
        proximity: float | None,
        make_load: LoadMaker | None = None,
        rings: Sequence[NDArray[np.float64]] = (),
    ) -> None:
        self.model = model
        self.layout = layout
        self.body = body
        self.geom_ids = tuple(int(g) for g in geom_ids)
        self.position_in_body = np.array(position)
        self.rotation_to_body = np.array(rotation)
        self.reach = reach
        self._range = proximity
        self._nearest = _least_gaps(model, body).tolist()
        self.make_load = make_load
        axes = layout.rotations[:, :, 2]
        self.rings = list(rings)
        if isinstance(layout, SoleLayout) and not rings:
            self.rings = [layout.vertices[list(c)] for c in layout.corners]
        flat = 2 if make_load is None else 3
        widths = [
            float(np.linalg.norm(ring[:, :flat] - place[:flat], axis=1).max())
            for ring, place in zip(self.rings, layout.positions, strict=True)
        ]
        self.static = (
            np.array(layout.positions),
            np.ascontiguousarray(axes),
            np.array(layout.areas),
            np.array(widths),
            np.ascontiguousarray(convex_hull(layout.positions[:, :2])),
        )
        self._views: dict[int, _View] = {}
        self._most = _MOST_DATA

    def __len__(self) -> int:
        return len(self.layout)

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_views": {}}

    def __call__(self, data: Any) -> SkinReading:
        """Read the skin after a step or `mj_forward`; InputError for another model's MjData."""
        view = self._views.get(id(data)) or self._look_in(data)
        with view.lock:
            load = view.load()
            near = None if self._range is None else self._distances(view)
            now = load.forces.copy(), near, load.vectors.copy(), load.wrench.copy(), load.depths.copy(), load.carried
        return _made(data.time, *now)

    @property
    def is_patch(self) -> bool:
        """Whether it wraps, and reads only what touches it."""
        return self.make_load is not None

    @property
    def patch(self) -> SkinPatch:
        """The taxels in the frame of their body, as `plantar.wholebody` takes them."""
        layout = self.layout
        level = layout.force_threshold
        return SkinPatch(
            name=layout.name,
            link=self.model.body(self.body).name,
            positions=layout.positions @ self.rotation_to_body.T + self.position_in_body,
            rotations=self.rotation_to_body @ layout.rotations,
            areas=layout.areas,
            force_threshold=level,
            proximity_range=self._range or 0.0,
            neighbours=layout.neighbours,
        )

    def percept(self, data: Any) -> Percept:
        """The skin's reading as a `plantar.Percept`; InputError for a patch whose taxels look to all sides."""
        if not isinstance(self.layout, SoleLayout):
            raise InputError(
                f"the skin of body '{self.layout.link}' looks to all sides: it has no percept of a sole; "
                "allowed: a patch with outward and within below 84 deg"
            )
        return Percept(self.layout, self(data))

    def pose(self, data: Any) -> SolePose:
        """The sole frame in the world of an `MjData`; InputError for another model's."""
        data = (self._views.get(id(data)) or self._look_in(data)).data
        turn = data.xmat[self.body].reshape(3, 3)
        return SolePose(turn @ self.rotation_to_body, data.xpos[self.body] + turn @ self.position_in_body)

    def many(self, datas: Sequence[Any], threads: int = 1) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Read the skin in many simulations.

        Args:
            datas: MjData of model, after `mj_step` or `mj_forward`.
            threads: Number of threads.

        Returns:
            Force (b, n, 3) on each taxel in N and wrench (b, 6), sole frame.
        """
        datas = items(datas, "datas")
        vectors = np.empty((len(datas), len(self), 3))
        wrenches = np.empty((len(datas), 6))
        self._most = max(self._most, len(datas))
        views = [self._views.get(id(d)) or self._look_in(d) for d in datas]

        def work(start: int) -> None:
            for i in range(start, len(views), threads):
                with views[i].lock:
                    load = views[i].load()
                    vectors[i] = load.vectors
                    wrenches[i] = load.wrench

        _shared(work, integer(threads, "threads", 1))
        return vectors, wrenches

    def rollout(
        self, states: NDArray[np.float64], controls: NDArray[np.float64] | None = None, threads: int = 1
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Read the skin along trajectories as of `mujoco.rollout`; each state passes `mj_forward`.

        Args:
            states: Full physics states (..., nstate), of `mujoco.mjtState.mjSTATE_FULLPHYSICS`.
            controls: Controls (..., nu); None for the defaults.
            threads: Number of threads.

        Returns:
            Force (..., n, 3) on each taxel in N and wrench (..., 6), sole frame.

        Raises:
            InputError: If sizes are not the model's.
        """
        kind = mujoco.mjtState.mjSTATE_FULLPHYSICS
        given = array(states, "states", (..., mujoco.mj_stateSize(self.model, kind)))
        lead = given.shape[:-1]
        flat = np.ascontiguousarray(given.reshape(-1, given.shape[-1]))
        control = None
        if controls is not None:
            control = array(controls, "controls", (*lead, self.model.nu)).reshape(len(flat), self.model.nu)
        vectors = np.empty((len(flat), len(self), 3))
        wrenches = np.empty((len(flat), 6))
        threads = min(integer(threads, "threads", 1), max(len(flat), 1))

        def work(thread: int) -> None:
            data = mujoco.MjData(self.model)
            view = _View(self, data)
            for i in range(len(flat) * thread // threads, len(flat) * (thread + 1) // threads):
                mujoco.mj_setState(self.model, data, flat[i], kind)
                if control is not None:
                    data.ctrl[:] = control[i]
                mujoco.mj_forward(self.model, data)
                load = view.load()
                vectors[i] = load.vectors
                wrenches[i] = load.wrench

        _shared(work, threads)
        return vectors.reshape(*lead, len(self), 3), wrenches.reshape(*lead, 6)

    def _look_in(self, data: Any) -> "_View":
        if not isinstance(data, mujoco.MjData):
            raise InputError(f"a skin is read from a mujoco.MjData; got a {type(data).__name__}")
        shapes = (data.qpos.size, data.qvel.size, len(data.xpos), len(data.geom_xpos))
        model = self.model
        other = getattr(data, "model", self.model)
        own = list(self.geom_ids)
        if shapes != (model.nq, model.nv, model.nbody, model.ngeom) or not (
            other.names == model.names
            and all(np.array_equal(getattr(other, n), getattr(model, n)) for n in ("geom_bodyid", "geom_type"))
            and all(np.array_equal(getattr(other, n)[own], getattr(model, n)[own]) for n in ("geom_size", "geom_pos"))
        ):
            raise InputError("the data are of another model than the skin was bound to; bind it to that model")
        if len(self._views) >= self._most:
            self._views.pop(next(iter(self._views)), None)
        view = _View(self, data)
        self._views[id(data)] = view
        return view

    def _distances(self, view: "_View") -> NDArray[np.float64]:
        """Distance (n,) outwards to another body in m; inf beyond range."""
        axes = self.static[1] @ view.rotation.T
        starts = view.origin + self.static[0] @ view.rotation.T + _LIFT * axes
        geom = np.empty(1, dtype=np.int32)
        out = np.full(len(self), math.inf)
        reach = float(self._range or 0.0)
        nearest = self._nearest
        for i, (start, axis) in enumerate(zip(starts, axes, strict=True)):
            gap = mujoco.mj_ray(self.model, view.data, start, -axis, None, 1, self.body, geom) - _LIFT
            for _ in range(_PASSED):
                if (hit := geom.item()) < 0 or gap > reach or gap >= nearest[hit]:
                    break
                place = start - (gap + _LIFT + 1e-6) * axis
                gap += 1e-6 + mujoco.mj_ray(self.model, view.data, place, -axis, None, 1, self.body, geom)
            if hit >= 0 and nearest[hit] <= gap <= reach:
                out[i] = gap
        return out


class _View:
    """A skin's contacts in one MjData, alive with it."""

    def __init__(self, skin: BoundSkin, data: Any) -> None:
        # of one thread at a time
        self.data = data
        self.lock = Lock()
        self._reader = ContactReader(skin.model, data, (skin.geom_ids,))
        self._load: Any = TaxelLoad(*skin.static) if skin.make_load is None else skin.make_load()
        self._seen = ContactsInSole()
        self._reach = skin.reach
        self._place = data.xpos[skin.body]
        self._turn = data.xmat[skin.body].reshape(3, 3)
        self._position = skin.position_in_body
        self._rotation = skin.rotation_to_body
        self.origin = np.zeros(3)
        self.rotation = np.eye(3)
        self._seen.look_from(self.origin, self.rotation)

    def load(self) -> Any:
        """The taxels' load now, a `TaxelLoad` or `PatchLoad`; always the same object."""
        foot: FootContacts = self._reader.read()[0]
        np.dot(self._turn, self._rotation, self.rotation)
        np.dot(self._turn, self._position, self.origin)
        self.origin += self._place
        self._load.press(foot, self._seen, self._reach)
        if math.isnan(self._load.wrench[2]):  # diverged: neither in the air nor on the ground
            self._load.vectors[:] = math.nan
            self._load.forces[:, None] = math.nan
        return self._load


def _least_gaps(model: Any, body: int) -> NDArray[np.float64]:
    """Gap (geoms,) in m from which on rays see each: inf for a body's own, 0 for links before it."""
    weld = model.body_weldid
    same = model.body_rootid[model.geom_bodyid] == model.body_rootid[body]
    links = [body]
    while model.body_parentid[links[-1]]:
        links.append(model.body_parentid[links[-1]])
    of_geoms = np.where(same, weld[model.geom_bodyid], -1)
    gaps = np.where(np.isin(of_geoms, weld[links]), 0.0, -math.inf)
    return np.where(of_geoms == weld[body], math.inf, gaps)


def _made(
    time: float,
    force: NDArray[np.float64],
    proximity: NDArray[np.float64] | None,
    vectors: NDArray[np.float64],
    wrench: NDArray[np.float64],
    depth: NDArray[np.float64],
    carried: bool,
) -> SkinReading:
    reading = SkinReading.taken_over(time, force, proximity)
    reading.__dict__.update(vectors=vectors, wrench=wrench, depth=depth, carried=carried)
    return reading


def _shared(work: Any, threads: int) -> None:
    if threads == 1:
        work(0)
    else:
        with ThreadPoolExecutor(threads) as pool:
            list(pool.map(work, range(threads)))
