"""Contacts of many pads over a time."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.sensing.link_skin import SkinPatch
from plantar.sim.companion.dynamics import MujocoDynamics
from plantar.sim.companion.standing.pad import Pad

__all__ = ["PlannedContact", "outer_taxel"]

_FIRST = 0.05  # of its force when it touches


@dataclass
class PlannedContact:
    """One pad that presses for a while; its force swells and fades.

    Attributes:
        begin: In s.
        hold: For how long in s.
        force: In N.
        swell: Time in s over which its force grows; it fades in that time, and in 0.6 s at least.
        against: Link against which the yield is measured; empty for the centre of mass, which leans into the contacts.
        yielded: Largest yield in m along the pad's first direction.
        measured: Largest true force in N.
    """

    pad: Pad
    begin: float
    hold: float
    force: float
    swell: float = 0.3
    against: str = ""
    yielded: float = 0.0
    measured: float = 0.0
    _touched: float = field(default=math.inf, repr=False)
    _first: tuple[NDArray[np.float64], NDArray[np.float64]] | None = field(default=None, repr=False)

    def act(self, time: float, measured: float) -> None:
        """Set the pad's wanted force at `time` in s, which grows from the first touch on, by the `measured` one."""
        left = self.begin + self.hold - time
        if time <= self.begin or left <= 0.0:
            self.pad.wanted = 0.0
            return
        if math.isinf(self._touched) and measured > 0.0:
            self._touched = time
        grown = 1.0 if math.isinf(self._touched) else max(_FIRST, (time - self._touched) / self.swell)
        self.pad.wanted = self.force * min(1.0, grown, left / max(0.6, self.swell))

    def judge(self, world: Any, force: float) -> None:
        """Note the link's yield in the `world` under the pad's true `force` in N."""
        if force <= 0.0:
            return
        self.measured = max(self.measured, force)
        place, inward = self.pad.touching(world)
        if self.against:
            origin, rotation = world.pose(self.against)
            place, inward = (place - origin) @ rotation, inward @ rotation
        else:
            place = place - world.data.subtree_com[world.model.body(world.machine.base.link).id]
        if self._first is None:
            self._first = place, inward
        self.yielded = max(self.yielded, float((place - self._first[0]) @ self._first[1]))

    @property
    def compliance(self) -> float:
        """In mm/N; 0 for a pad that never pressed."""
        return 1e3 * self.yielded / self.measured if self.measured > 0.0 else 0.0


def outer_taxel(robot: MujocoDynamics, patch: SkinPatch, trunk: str, rng: np.random.Generator) -> int:
    """Returns a random taxel, of `rng`, in the middle of a `patch` that faces away from the `trunk` of a `robot` in its
    posture.
    """
    origin, rotation = robot.pose(patch.link)
    places = patch.positions @ rotation.T + origin
    outward = -(patch.rotations[:, :, 2] @ rotation.T)
    away = places - robot.pose(trunk)[0]
    away[:, 2] = 0.0
    free = np.einsum("ij,ij->i", outward, away) > 0.0 if patch.link != trunk else np.ones(len(patch), dtype=bool)
    central = np.linalg.norm(patch.positions - patch.positions.mean(0), axis=1)
    order = np.argsort(np.where(free, central, math.inf), kind="stable")
    best = order[: max(1, int(free.sum()) // 4)]
    return int(rng.choice(best))
