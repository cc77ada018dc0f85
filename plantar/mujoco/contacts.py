"""The contacts of feet, as MuJoCo lists them after a step."""

from collections.abc import Callable, Collection, Sequence
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.kernels.contacts.foot_contacts import ContactList, FeetReader, FootContacts, gather_feet

REACH = 5e-4
"""Largest gap in m between sole and ground that still counts as contact: what the rubber sole of H1 gives."""

_ELLIPTIC = int(mujoco.mjtCone.mjCONE_ELLIPTIC)


class ContactReader:
    """Gathers the contacts of several feet of one simulation.

    `feet`: ids of each foot's geoms. Attribute `read`: returns each foot's contacts after the last `mj_step` or
    `mj_forward`, in reused objects; `kernel`: what reads them; `sticks`: whether `read` does more.
    """

    def __init__(self, model: Any, data: Any, feet: Sequence[Collection[int]]) -> None:
        # a copy's may differ
        self._model = getattr(data, "model", model)
        self._data = data
        own = np.zeros((len(feet), model.ngeom), dtype=np.uint8)
        for mask, geom_ids in zip(own, feet, strict=True):
            mask[list(geom_ids)] = 1
        self._feet = tuple(FootContacts(mask) for mask in own)
        self.kernel = FeetReader(self._data, self._model.opt, self._feet, self._listed)
        self.read: Callable[[], tuple[FootContacts, ...]] = self.kernel.read
        self.sticks = bool(getattr(self._model, "flg_adhesion", False))  # geoms may, since MuJoCo 4
        if self.sticks:
            self.read = self._read_sticking

    def _listed(self) -> ContactList:
        c = self._data.contact
        friction = c.friction if self._model.opt.cone != _ELLIPTIC else None
        return ContactList(c.geom, c.pos, c.frame, c.dist, c.efc_address, c.dim, friction)

    def _read_sticking(self) -> tuple[FootContacts, ...]:
        """`read` of geoms that stick, whose forces are less their adhesion."""
        feet = self.kernel.read()
        count = self.kernel.count
        if count:
            gather_feet(feet, self.kernel.of_present(count), _net_forces(self._data, self._model.opt.cone))
        return self._feet


def _net_forces(data: Any, cone: int) -> NDArray[np.float64]:
    """Constraint forces less geoms' adhesion, as `mj_contactForce`."""
    forces: NDArray[np.float64] = data.efc_force.copy()
    for c in data.contact:
        if c.efc_address >= 0:
            edges = 1 if c.dim == 1 or cone == _ELLIPTIC else 2  # opposite ones, whose difference is friction
            forces[c.efc_address : c.efc_address + edges] -= c.adhesion / edges
    return forces
