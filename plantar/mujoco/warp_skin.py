"""A plantar skin in many worlds of MuJoCo Warp, on GPU or CPU."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

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
        contacts: Most contacts of sole in one world.
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
        if skin.is_patch:
            raise InputError("the skin is a patch that wraps, which MuJoCo Warp's form does not read; allowed: a sole")
        self._worlds = integer(worlds, "worlds", 1)
        self._shares = None
        if skin.shared is not None:
            self._shares = wp.array(skin.shared.shares, dtype=wp.float64)
        self._worn = None if skin.faults is None else skin.faults.worn(skin.layout, skin.seed, (self._worlds,))
        room = integer(contacts, "contacts", 1)
        self._elliptic = bool(skin.model.opt.cone) if elliptic is None else elliptic
        positions, normals, areas, widths, hull = skin.static
        own = np.zeros(skin.model.ngeom, dtype=np.int32)
        own[list(skin.geom_ids)] = 1
        sole: Any = warp_kernels.Sole()
        sole.positions = wp.array(positions, dtype=wp.vec3d)
        sole.normals = wp.array(normals, dtype=wp.vec3d)
        sole.areas = wp.array(areas, dtype=wp.float64)
        sole.widths = wp.array(widths, dtype=wp.float64)
        sole.hull = wp.array(hull, dtype=wp.vec2d)
        sole.own = wp.array(own, dtype=wp.int32)
        sole.body = skin.body
        sole.reach = skin.reach
        sole.level = bool((positions[:, 2] == 0.0).all())
        sole.place = wp.vec3d(*skin.position_in_body)
        sole.turn = wp.mat33d(*skin.rotation_to_body.ravel())
        self._sole = sole
        self._work = self._room(len(skin), room)
        self.vectors = self._work.vectors if self._shares is None else wp.zeros_like(self._work.vectors)
        self.wrench = self._work.wrench
        self.carried = self._work.carried

    def _room(self, count: int, room: int) -> Any:
        wp = self._wp
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
        self._work.size.zero_()
        wp.launch(warp_kernels.gather, dim=listed.dist.shape[0], inputs=[self._sole, contacts, self._work])
        wp.launch(warp_kernels.press, dim=self._worlds, inputs=[self._sole, self._work], block_dim=32)
        if self._shares is not None:
            inputs = [self._sole, self._shares, self._work, self.vectors]
            wp.launch(warp_kernels.share, dim=(self._worlds, len(self._skin)), inputs=inputs)
            wp.launch(warp_kernels.check_moment, dim=self._worlds, inputs=inputs)

    def force(self, time: float) -> NDArray[np.float64]:
        """Force (worlds, n) along each taxel's axis in N of the last `read`; with faults, what the taxels read of it.

        Faults are those of `TaxelFaults.worn(layout, seed, (worlds,))` at a `time` in s, applied by NumPy: on a GPU the
        forces are copied back for it.
        """
        loads = self.vectors.numpy()
        along = np.einsum("wij,ij->wi", loads, self._skin.static[1])
        return along if self._worn is None else self._worn.read(time, along, loads)

    def numpy(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
        """The last force (worlds, n, 3), wrench (worlds, 6), and carried or not (worlds,)."""
        return self.vectors.numpy(), self.wrench.numpy(), self.carried.numpy().astype(bool)
