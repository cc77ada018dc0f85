"""A plantar skin in a MuJoCo model, read from simulation data."""

import math
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cached_property
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
from plantar.kernels.contacts.pressed_patch import load_parts
from plantar.kernels.contacts.taxel_load import TaxelLoad
from plantar.layouts.layout import SoleLayout
from plantar.mujoco.contacts import ContactReader
from plantar.mujoco.layer import ElasticLayer, SharedLoad
from plantar.mujoco.ray_depth import ray_depths
from plantar.percepts.percept import Percept
from plantar.percepts.sole_pose import SolePose
from plantar.sensing.link_skin import SkinPatch
from plantar.sensing.reading import Reading
from plantar.sensing.taxel_faults import TaxelFaults

_PASSED = 20  # own surfaces that a ray passes at most

LIFT = 0.02
"""Depth in m inside the body at which rays begin: what is deeper is not seen."""

MOST_DATA = 64
"""How many MjData have their contacts kept in view, and so in memory, unless more are read at once."""


class SkinReading(Reading):
    """A `Reading` with what only a simulation knows, sole frame; n taxels.

    Attributes:
        force: (n,) along each taxel's axis in N; with faults, what the taxels read of it.
        vectors: Force (n, 3) on each taxel in N.
        wrench: Wrench (6,) of MuJoCo's contacts on body about sole origin in N and N m.
        depth: Overlap (n,) of geoms in m, 0 elsewhere.
        slip: Velocity (n, 3) of each loaded taxel along what it touches in m/s, 0 of the others; NaN on a flex; None if
            it is not read (`Skin(slip=True)`).
        carried: Whether the vectors have the whole wrench; else only the load on the sole, as its center of pressure is
            beyond the taxels or the body is pressed from above as well.
    """

    carried: bool
    slip: NDArray[np.float64] | None
    _block: NDArray[np.float64]

    @cached_property
    def vectors(self) -> NDArray[np.float64]:
        """Force (n, 3) on each taxel in N."""
        found: NDArray[np.float64] = load_parts(self._block)[2]
        return found

    @cached_property
    def wrench(self) -> NDArray[np.float64]:
        """Wrench (6,) of MuJoCo's contacts on body about sole origin in N and N m."""
        found: NDArray[np.float64] = load_parts(self._block)[3]
        return found

    @cached_property
    def depth(self) -> NDArray[np.float64]:
        """Overlap (n,) of geoms in m, 0 elsewhere."""
        found: NDArray[np.float64] = load_parts(self._block)[1]
        return found

    @property
    def position_cop_in_sole(self) -> NDArray[np.float64] | None:
        """Contacts' center of pressure (2,) at z = 0 in m; None without load."""
        fz = float(self.wrench[2])
        return np.array([-self.wrench[4] / fz, self.wrench[3] / fz]) if fz > 0.0 else None

    def __reduce__(self) -> tuple[Any, ...]:
        return reading_of_block, (self.time, self.force, self._block, self.proximity, self.carried, self.slip)


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
        proximity_range: Of proximity sensors in m; None for none.
        slip: Whether taxels' sliding is read.
        layer: Elastic layer over the cells, or None; `shared`: how the cells share a load by it.
        faults: Of its taxels, or None; `seed` of their draws.
        wraps: Of a patch that wraps, the arguments of `PatchLoad`, else None.
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
        slip: bool = False,
        layer: ElasticLayer | None = None,
        faults: TaxelFaults | None = None,
        seed: int = 0,
        wraps: tuple[Any, ...] | None = None,
        rings: Sequence[NDArray[np.float64]] = (),
    ) -> None:
        self.model = model
        self.layout = layout
        self.body = body
        self.geom_ids = tuple(int(g) for g in geom_ids)
        self.position_in_body = np.array(position)
        self.rotation_to_body = np.array(rotation)
        self.reach = reach
        self.proximity_range = proximity
        self.slip = slip
        self.layer = layer
        self.faults = faults
        self.seed = seed
        self._nearest = _least_gaps(model, body).tolist()
        self.wraps = wraps
        axes = layout.rotations[:, :, 2]
        self.rings = list(rings)
        if isinstance(layout, SoleLayout) and not rings:
            self.rings = [layout.vertices[list(c)] for c in layout.corners]
        flat = 2 if wraps is None else 3
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
        self.shared = None if layer is None else SharedLoad(layer, layout)
        self._depths = np.zeros(0) if proximity is None else ray_depths(model, body, self.patch, LIFT)
        self._views: dict[int, SkinView] = {}
        self._most = MOST_DATA

    def __len__(self) -> int:
        return len(self.layout)

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_views": {}}

    def __call__(self, data: Any) -> SkinReading:
        """Read the skin after a step or `mj_forward`; InputError for another model's MjData."""
        view = self._views.get(id(data)) or self._look_in(data)
        with view.lock:
            return view.reading(view.contacts(), data.time)

    @property
    def is_patch(self) -> bool:
        """Whether it wraps, and reads only what touches it."""
        return self.wraps is not None

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
            proximity_range=self.proximity_range or 0.0,
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

        shared_work(work, integer(threads, "threads", 1))
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
            InputError: If sizes are not the model's, or a number is not finite.
        """
        kind = mujoco.mjtState.mjSTATE_FULLPHYSICS
        given = array(states, "states", (..., mujoco.mj_stateSize(self.model, kind)), finite=True)
        lead = given.shape[:-1]
        flat = np.ascontiguousarray(given.reshape(-1, given.shape[-1]))
        control = None
        if controls is not None:
            control = array(controls, "controls", (*lead, self.model.nu), finite=True).reshape(len(flat), self.model.nu)
        vectors = np.empty((len(flat), len(self), 3))
        wrenches = np.empty((len(flat), 6))
        threads = min(integer(threads, "threads", 1), max(len(flat), 1))

        def work(thread: int) -> None:
            data = mujoco.MjData(self.model)
            view = SkinView(self, data)
            for i in range(len(flat) * thread // threads, len(flat) * (thread + 1) // threads):
                mujoco.mj_setState(self.model, data, flat[i], kind)
                if control is not None:
                    data.ctrl[:] = control[i]
                mujoco.mj_forward(self.model, data)
                load = view.load()
                vectors[i] = load.vectors
                wrenches[i] = load.wrench

        shared_work(work, threads)
        return vectors.reshape(*lead, len(self), 3), wrenches.reshape(*lead, 6)

    def check(self, data: Any) -> None:
        """InputError unless `data` is a `mujoco.MjData` of the skin's model."""
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

    def _look_in(self, data: Any) -> "SkinView":
        self.check(data)
        if len(self._views) >= self._most:
            self._views.pop(next(iter(self._views)), None)
        view = SkinView(self, data)
        self._views[id(data)] = view
        return view

    def distances(self, view: "SkinView") -> NDArray[np.float64]:
        """Distance (n,) outwards to another body in m; inf beyond range."""
        axes = self.static[1] @ view.rotation.T
        starts = view.origin + self.static[0] @ view.rotation.T + self._depths[:, None] * axes
        geom = np.empty(1, dtype=np.int32)
        out = np.full(len(self), math.inf)
        reach = float(self.proximity_range or 0.0)
        nearest = self._nearest
        for i, (start, axis, depth) in enumerate(zip(starts, axes, self._depths.tolist(), strict=True)):
            gap = mujoco.mj_ray(self.model, view.data, start, -axis, None, 1, self.body, geom) - depth
            for _ in range(_PASSED):
                if (hit := geom.item()) < 0 or gap > reach or gap >= nearest[hit]:
                    break
                place = start - (gap + depth + 1e-6) * axis
                gap += 1e-6 + mujoco.mj_ray(self.model, view.data, place, -axis, None, 1, self.body, geom)
            if hit >= 0 and nearest[hit] <= gap <= reach:
                out[i] = gap
        return out


class SkinView:
    """A skin's contacts in one MjData, alive with it; of one thread at a time.

    `looks`: whether it reads more than contacts; `origin` (3,), `rotation` (3, 3): the sole's in the world, at the last
    load.
    """

    def __init__(self, skin: BoundSkin, data: Any) -> None:
        self.data = data
        self.lock = Lock()
        self.looks = skin.proximity_range is not None or skin.faults is not None or skin.slip
        self.origin = np.zeros(3)
        self.rotation = np.eye(3)
        self._skin = skin
        self._reader = ContactReader(skin.model, data, (skin.geom_ids,))
        self._load: Any = TaxelLoad(*skin.static) if skin.wraps is None else PatchLoad(*skin.wraps)
        self._seen = ContactsInSole()
        self._reach = skin.reach
        self._still = np.zeros(len(self._load.block))
        self._count = len(skin)
        self._no_force = load_parts(self._still)[0]
        self._worn = None if skin.faults is None else skin.faults.worn(skin.layout, skin.seed)
        self._read_at = -math.inf
        self.carried = True
        seat = np.ascontiguousarray(skin.rotation_to_body)
        at = data.xpos[skin.body]
        self._seen.ride_on(at, data.xmat[skin.body], skin.position_in_body, seat, self.origin, self.rotation)

    def contacts(self) -> FootContacts:
        """The skin's contacts now; always the same object."""
        found: FootContacts = self._reader.read()[0]
        return found

    def load(self) -> Any:
        """The taxels' load now, a `TaxelLoad` or `PatchLoad`; always the same object."""
        return self.press(self.contacts())

    def press(self, foot: FootContacts) -> Any:
        """As `load`, of the skin's contacts now."""
        self._seen.look()
        load = self._load
        load.press(foot, self._seen, self._reach)
        if load.is_lost():  # diverged: neither in the air nor on the ground
            load.vectors[:] = math.nan
            load.forces[:] = math.nan
        self.carried = load.carried
        if self._skin.shared is not None and foot.size:
            self.carried = self._skin.shared.take(load) and load.carried
        return load

    def _slip(self, foot: FootContacts) -> NDArray[np.float64]:
        """Velocity (n, 3) of each loaded taxel along what touches nearest to it, sole frame, in m/s."""
        skin = self._skin
        load = self._load
        out = np.zeros((self._count, 3))
        loaded = np.flatnonzero(np.abs(load.vectors).max(axis=1) > 0.0)
        if not len(loaded):
            return out
        geoms = np.asarray(foot.ids)[: foot.size, 1]
        points = np.asarray(self._seen.vectors)[: 3 * foot.size : 3]
        places, axes, _, _, _ = skin.static
        away = places[loaded, None] - points
        touched = geoms[np.einsum("ijk,ijk->ij", away, away).argmin(axis=1)]
        own = self._motion(skin.body)
        for geom in set(touched.tolist()):
            here = loaded[touched == geom]
            if geom < 0:
                out[here] = math.nan
                continue
            spin, flow = own - self._motion(int(skin.model.geom_bodyid[geom]))
            out[here] = flow + places[here] @ _turning(spin)
        out[loaded] -= np.einsum("ij,ij->i", out[loaded], axes[loaded])[:, None] * axes[loaded]
        return out

    def _motion(self, body: int) -> NDArray[np.float64]:
        """Angular velocity and velocity (2, 3) of a body where the sole's origin is, sole frame."""
        data = self.data
        spin, flow = data.cvel[body].reshape(2, 3)  # about the center of mass of its tree
        moved = flow + (self.origin - data.subtree_com[self._skin.model.body_rootid[body]]) @ _turning(spin)
        return np.array([spin, moved]) @ self.rotation

    def reading(self, foot: FootContacts, time: float) -> SkinReading:
        """The reading of the skin's contacts now."""
        load = self.press(foot)
        near = None if self._skin.proximity_range is None else self._skin.distances(self)
        block = load.block.copy()
        force = block[: self._count]
        slip = self._slip(foot) if self._skin.slip else None
        if self._worn is not None and not load.is_lost():
            if time < self._read_at:  # the simulation began again
                self._worn.reset()
            self._read_at = time
            force = self._worn.read(time, force, load.vectors)
        return reading_of_block(time, force, block, near, self.carried, slip)

    def still(self, time: float) -> SkinReading:
        """The reading of a skin that nothing touches, which only looks at contacts."""
        return reading_of_block(time, self._no_force, self._still, None, True, None)


def _turning(spin: NDArray[np.float64]) -> NDArray[np.float64]:
    """Matrix (3, 3) that a place (3,) is multiplied with, from the left, for its velocity."""
    x, y, z = spin.tolist()
    return np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])


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


def reading_of_block(
    time: float,
    force: NDArray[np.float64],
    block: NDArray[np.float64],
    proximity: NDArray[np.float64] | None,
    carried: bool,
    slip: NDArray[np.float64] | None,
) -> SkinReading:
    """A reading of a kernel's `block` (see `load_parts`), made for it."""
    reading = SkinReading.taken_over(time, force, proximity)
    fields = reading.__dict__
    fields["_block"] = block
    fields["carried"] = carried
    fields["slip"] = slip
    return reading


def shared_work(work: Any, threads: int) -> None:
    """Call `work` once a thread, with its number."""
    if threads == 1:
        work(0)
    else:
        with ThreadPoolExecutor(threads) as pool:
            list(pool.map(work, range(threads)))
