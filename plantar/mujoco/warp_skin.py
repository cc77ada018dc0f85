"""A plantar skin in many worlds of MuJoCo Warp, on GPU or CPU."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from plantar.common.arguments import instance, integer
from plantar.common.optional_library import need_libraries
from plantar.errors import InputError
from plantar.mujoco import warp_kernels
from plantar.mujoco.bound_skin import BoundSkin

_CONTACTS = 32


class WarpSkin:
    """Reads a bound skin in the worlds of a `mujoco_warp.Data`.

    Args:
        skin: The skin, bound to the worlds' MjModel.
        worlds: Their number.
        contacts: Most contacts of a sole in one world; a patch that wraps takes any number.
        elliptic: Whether friction cones are elliptic; None as the MjModel.

    Attributes:
        vectors: Force (worlds, n) of vec3d on each taxel in N, sole frame; the same Warp array at each reading.
        wrench: (worlds, 6) about sole origin in N and N m, likewise.
        carried: 1 for each world (worlds,) whose taxels have the whole wrench of at most `contacts` contacts, else 0.

    Raises:
        DependencyError, InputError: If an argument is invalid.
    """

    def __init__(self, skin: BoundSkin, worlds: int, contacts: int = _CONTACTS, elliptic: bool | None = None) -> None:
        need_libraries("warp", "warp")
        import warp as wp

        self._wp = wp
        self._skin = instance(skin, BoundSkin, "skin")
        self._worlds = integer(worlds, "worlds", 1)
        self._room = integer(contacts, "contacts", 1)
        self._elliptic = bool(skin.model.opt.cone) if elliptic is None else elliptic
        self._positions = wp.array(skin.static[0], dtype=wp.vec3d)
        self._shares = None
        if skin.shared is not None:
            self._shares = wp.array(skin.shared.shares, dtype=wp.float64)
        self._worn = None if skin.faults is None else skin.faults.worn(skin.layout, skin.seed, (self._worlds,))
        own = np.zeros(skin.model.ngeom, dtype=np.int32)
        own[list(skin.geom_ids)] = 1
        self._own = wp.array(own, dtype=wp.int32)
        self._work = self._sole_work() if skin.wraps is None else self._patch_work(skin.wraps)
        self._sole = self._made_sole() if skin.wraps is None else self._made_patch(skin.wraps)
        self.vectors = self._work.vectors if self._shares is None else wp.zeros_like(self._work.vectors)
        self.wrench = self._work.wrench
        self.carried = self._work.carried

    def _seated(self, struct: Any) -> Any:
        """A `struct` with what soles and patches have in common."""
        wp = self._wp
        skin = self._skin
        struct.positions = self._positions
        struct.normals = wp.array(skin.static[1], dtype=wp.vec3d)
        struct.areas = wp.array(skin.static[2], dtype=wp.float64)
        struct.own = self._own
        struct.body = skin.body
        struct.reach = skin.reach
        struct.place = wp.vec3d(*skin.position_in_body)
        struct.turn = wp.mat33d(*skin.rotation_to_body.ravel())
        return struct

    def _made_sole(self) -> Any:
        wp = self._wp
        sole = self._seated(warp_kernels.Sole())
        positions, _, _, widths, hull = self._skin.static
        sole.widths = wp.array(widths, dtype=wp.float64)
        sole.hull = wp.array(hull, dtype=wp.vec2d)
        sole.level = bool((positions[:, 2] == 0.0).all())
        return sole

    def _made_patch(self, wraps: tuple[Any, ...]) -> Any:
        from plantar.mujoco import warp_patch_kernels

        wp = self._wp
        _, _, _, radius, rows, kinds, frames, sizes, starts, planes, limits, polygon, _ = wraps
        patch = self._seated(warp_patch_kernels.Patch())
        patch.radius = radius
        patch.geoms, patch.kinds, patch.starts = (wp.array(x, dtype=wp.int32) for x in (rows, kinds, starts))
        patch.places = wp.array(frames[:, :3], dtype=wp.vec3d)
        patch.turns = wp.array(frames[:, 3:].reshape(-1, 3, 3), dtype=wp.mat33d)
        patch.sizes = wp.array(sizes, dtype=wp.vec3d)
        patch.planes = wp.array(planes, dtype=wp.vec4d)
        patch.way, patch.axis = wp.vec3d(*limits[:3]), wp.vec3d(*limits[4:7])
        patch.way_least, patch.axis_most = float(limits[3]), float(limits[7])
        patch.low, patch.high = wp.vec3d(*limits[8:11]), wp.vec3d(*limits[11:])
        patch.polygon = wp.array(polygon, dtype=wp.vec2d)
        return patch

    def _patch_work(self, wraps: tuple[Any, ...]) -> Any:
        from plantar.mujoco import warp_patch_kernels

        wp = self._wp
        places = self._skin.static[0]
        radius = wraps[3]
        # All cells that one contact reaches are within twice its reach of each other.
        most = max(len(near) for near in cKDTree(places).query_ball_point(places, 2.0 * radius))
        work: Any = warp_patch_kernels.PatchWork()
        work.rows = wp.zeros((most, 1), dtype=wp.vec3d)  # a CPU takes one contact after the other
        work.cells = wp.zeros((most, 1), dtype=wp.int32)
        work.load, work.extent = (wp.zeros(self._worlds, dtype=wp.float64) for _ in range(2))
        work.carried = wp.zeros(self._worlds, dtype=wp.int32)
        work.vectors = wp.zeros((self._worlds, len(places)), dtype=wp.vec3d)
        work.wrench = wp.zeros((self._worlds, 6), dtype=wp.float64)
        return work

    def _sole_work(self) -> Any:
        wp = self._wp
        count = len(self._skin)
        room = self._room
        b = self._worlds
        slots = 1 if wp.get_device().is_cpu else b  # a CPU takes one world after the other
        work: Any = warp_kernels.Work()
        work.size = wp.zeros(b, dtype=wp.int32)
        work.carried = wp.zeros(b, dtype=wp.int32)
        work.pair = wp.zeros((room, b), dtype=wp.vec2i)
        work.gap = wp.zeros((room, b), dtype=wp.float64)
        for name in ("at", "force", "torque"):
            setattr(work, name, wp.zeros((room, b), dtype=wp.vec3d))
        work.points = wp.zeros((room, slots), dtype=wp.vec3d)
        work.ring, work.edges = (wp.zeros((2 * room + 2, slots), dtype=kind) for kind in (wp.vec2d, wp.vec3d))
        for name in ("weights", "prior", "normal", "gaps"):
            setattr(work, name, wp.zeros((count, slots), dtype=wp.float64))
        work.rows = wp.zeros((count, slots), dtype=wp.vec3d)
        work.vectors = wp.zeros((b, count), dtype=wp.vec3d)
        work.wrench = wp.zeros((b, 6), dtype=wp.float64)
        return work

    def read(self, data: Any) -> None:
        """Read the skin in all worlds into `vectors`, `wrench` and `carried`.

        Args:
            data: A `mujoco_warp.Data` after a step or `forward`; an InputError for another number of worlds.
        """
        if data.xpos.shape[0] != self._worlds:
            raise InputError(f"data have {data.xpos.shape[0]} worlds; the skin was made for {self._worlds}")
        wp = self._wp
        listed = data.contact
        contacts: Any = warp_kernels.Contacts()
        contacts.count = data.nacon
        contacts.world = listed.worldid
        contacts.dist = listed.dist
        contacts.pos = listed.pos
        contacts.frame = listed.frame
        contacts.geom = listed.geom
        contacts.dim = listed.dim
        contacts.friction = listed.friction.view(wp.float32) if listed.friction.ndim == 1 else listed.friction
        contacts.address = listed.efc_address
        contacts.force = data.efc.force
        contacts.adhesion = getattr(listed, "adhesion", None)  # since MuJoCo Warp 4
        contacts.xpos = data.xpos
        contacts.xmat = data.xmat
        contacts.elliptic = self._elliptic
        self._press_patch(contacts) if self._skin.is_patch else self._press_sole(contacts)
        if self._shares is not None:
            inputs = [self._shares, self._work.vectors, self.vectors]
            wp.launch(warp_kernels.share, dim=(self._worlds, len(self._skin)), inputs=inputs)
            inputs = [self._positions, self.wrench, self.vectors, self.carried]
            wp.launch(warp_kernels.check_moment, dim=self._worlds, inputs=inputs)

    def _press_sole(self, contacts: Any) -> None:
        wp = self._wp
        self._work.size.zero_()
        wp.launch(warp_kernels.gather, dim=contacts.dist.shape[0], inputs=[self._sole, contacts, self._work])
        wp.launch(warp_kernels.press, dim=self._worlds, inputs=[self._sole, self._work], block_dim=32)

    def _press_patch(self, contacts: Any) -> None:
        from plantar.mujoco import warp_patch_kernels

        wp = self._wp
        work = self._work
        room = contacts.dist.shape[0]
        if not wp.get_device().is_cpu and work.rows.shape[1] < room:
            most = work.rows.shape[0]
            work.rows, work.cells = (wp.zeros((most, room), dtype=kind) for kind in (wp.vec3d, wp.int32))
        for array in (work.load, work.extent, work.vectors, work.wrench):
            array.zero_()
        wp.launch(warp_patch_kernels.touch, dim=room, inputs=[self._sole, contacts, work])
        wp.launch(warp_patch_kernels.finish, dim=self._worlds, inputs=[self._sole, work])

    def force(self, time: float) -> NDArray[np.float64]:
        """Force (worlds, n) along each taxel's axis in N of the last `read`; with faults, what the taxels read of it.

        Faults are those of `TaxelFaults.worn(layout, seed, (worlds,))` at a `time` in s, applied by NumPy: on a GPU the
        forces are copied back for it. NaN in a world that diverged, whose taxels then remember no load.
        """
        loads = self.vectors.numpy()
        along: NDArray[np.float64] = np.einsum("wij,ij->wi", loads, self._skin.static[1])
        if self._worn is None:
            return along
        lost: NDArray[np.bool_] = np.asarray(np.isnan(along).any(axis=1))
        read: NDArray[np.float64] = self._worn.read(
            time, np.where(lost[:, None], 0.0, along), np.where(lost[:, None, None], 0.0, loads)
        )
        read[lost] = np.nan
        return read

    def numpy(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
        """The last force (worlds, n, 3), wrench (worlds, 6), and carried or not (worlds,)."""
        return self.vectors.numpy(), self.wrench.numpy(), self.carried.numpy().astype(bool)
