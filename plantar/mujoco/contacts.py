"""The contacts of feet, as MuJoCo lists them after a step."""

from collections.abc import Collection, Sequence
from typing import Any

import mujoco
import numpy as np

from plantar.kernels.contacts.foot_contacts import ContactList, FootContacts, gather_feet

REACH = 5e-4
"""Largest gap in m between sole and ground that still counts as contact: what the rubber sole of H1 gives."""

_ELLIPTIC = int(mujoco.mjtCone.mjCONE_ELLIPTIC)


class ContactReader:
    """Gathers the contacts of several feet of one simulation.

    Args:
        model: MjModel.
        data: Its MjData.
        feet: Ids of each foot's geoms.
    """

    def __init__(self, model: Any, data: Any, feet: Sequence[Collection[int]]) -> None:
        self._model, self._data = model, data
        own = np.zeros((len(feet), model.ngeom), dtype=np.uint8)
        for mask, geom_ids in zip(own, feet, strict=True):
            mask[list(geom_ids)] = 1
        self._feet = tuple(FootContacts(mask) for mask in own)
        self._options = getattr(data, "model", model).opt  # a copy's may differ
        self._cone = self._options.cone
        self._lists: dict[int, ContactList] = {}

    def read(self) -> tuple[FootContacts, ...]:
        """Each foot's contacts after the last `mj_step` or `mj_forward`, in reused objects."""
        data, n = self._data, self._data.ncon
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
        gather_feet(self._feet, listed, data.efc_force)
        return self._feet
