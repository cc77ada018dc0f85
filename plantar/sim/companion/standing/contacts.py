"""Contacts of many pads over a time: when each presses, how hard, and how far the robot yields to it."""

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
    """One pad that presses from a time on for a while; its force swells and fades.

    Attributes:
        begin: Time in s at which it begins to press.
        hold: Time in s for which it presses.
        force: Its force in N.
        swell: Time in s over which its force grows; it fades in that time, and in 0.6 s at least.
        against: Link against which it is measured how far the pressed link yields; empty for the centre of mass, which
            leans into the contacts.
        yielded: How far in m the link yielded along the pad's first direction, at most.
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
        """Set the pad's wanted force: it comes near as if for all of it, which then grows from the first touch on.

        Args:
            time: Time in s.
            measured: Force in N with which it presses now.
        """
        left = self.begin + self.hold - time
        if time <= self.begin or left <= 0.0:
            self.pad.wanted = 0.0
            return
        if math.isinf(self._touched) and measured > 0.0:
            self._touched = time
        grown = 1.0 if math.isinf(self._touched) else max(_FIRST, (time - self._touched) / self.swell)
        self.pad.wanted = self.force * min(1.0, grown, left / max(0.6, self.swell))

    def judge(self, world: Any, force: float) -> None:
        """Take note of how far the link has yielded.

        Args:
            world: The world.
            force: True force of the pad in N.
        """
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
        """Yield in mm/N; 0 for a pad that never pressed."""
        return 1e3 * self.yielded / self.measured if self.measured > 0.0 else 0.0


def outer_taxel(robot: MujocoDynamics, patch: SkinPatch, trunk: str, rng: np.random.Generator) -> int:
    """A taxel at random of those in the middle of a patch that face away from the trunk, where a hand can reach it.

    Args:
        robot: The machine in its posture.
        patch: The patch.
        trunk: Link that hands cannot reach through.
        rng: Random numbers.

    Returns:
        Its index.
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
