"""The contacts of feet, as MuJoCo lists them after a step."""

from collections.abc import Collection, Sequence
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.kernels.contacts.foot_contacts import ContactList, FootContacts, gather_feet

REACH = 5e-4
"""Largest gap in m between sole and ground that still counts as contact: what the rubber sole of H1 gives."""

_ELLIPTIC = int(mujoco.mjtCone.mjCONE_ELLIPTIC)


class ContactReader:
    """Gathers the contacts of several feet of one simulation.

    `feet`: ids of each foot's geoms. Attribute `count`: contacts of all bodies at the last `read`.
    """

    def __init__(self, model: Any, data: Any, feet: Sequence[Collection[int]]) -> None:
        # a copy's may differ
        self._model = getattr(data, "model", model)
        self._data = data
        own = np.zeros((len(feet), model.ngeom), dtype=np.uint8)
        for mask, geom_ids in zip(own, feet, strict=True):
            mask[list(geom_ids)] = 1
        self._feet = tuple(FootContacts(mask) for mask in own)
        self._options = self._model.opt
        self._cone = self._options.cone
        self._sticks = bool(getattr(self._model, "flg_adhesion", False))  # of geoms, since MuJoCo 4
        self._lists: dict[int, ContactList] = {}
        self.count = 0

    def read(self) -> tuple[FootContacts, ...]:
        """Each foot's contacts after the last `mj_step` or `mj_forward`, in reused objects."""
        data = self._data
        n = data.ncon
        self.count = n
        if not n:
            for foot in self._feet:
                foot.clear()
            return self._feet
        if self._options.cone != self._cone:
            self._cone = self._options.cone
            self._lists.clear()
        listed = self._lists.get(n)
        if listed is None:
            c = data.contact
            friction = c.friction if self._cone != _ELLIPTIC else None
            listed = ContactList(c.geom, c.pos, c.frame, c.dist, c.efc_address, c.dim, friction)
            self._lists[n] = listed
        gather_feet(self._feet, listed, _net_forces(data, self._cone) if self._sticks else data.efc_force)
        return self._feet


def _net_forces(data: Any, cone: int) -> NDArray[np.float64]:
    """Constraint forces less geoms' adhesion, as `mj_contactForce`."""
    forces: NDArray[np.float64] = data.efc_force.copy()
    for c in data.contact:
        if c.efc_address >= 0:
            edges = 1 if c.dim == 1 or cone == _ELLIPTIC else 2  # opposite ones, whose difference is friction
            forces[c.efc_address : c.efc_address + edges] -= c.adhesion / edges
    return forces
