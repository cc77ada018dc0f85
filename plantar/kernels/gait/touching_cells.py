"""Cells of a standing sole that carry, or carried until its turn lifted them."""

import numpy as np

from ..base import memory, vectors
from ..geometry import convex

__all__ = ["TouchingCells", "along_sole", "encloses"]

_INFINITE = float("inf")


class TouchingCells:
    """Contacts of a sole of n taxels.

    Args:
        places: Taxels' centers (n, 2) in sole frame in m.
        touches: Receives 1 for cells (n,) that touch, else 0.
        least_force: Running mean in N of a cell that carries.
        least_share: The same as a share of the sum of all.
        smoothing: Share of a new reading in the running mean.
        gap: Rise in m of a lifted cell.
    """

    def __init__(self, places, touches, least_force, least_share, smoothing, gap):
        self.places = np.array(places, dtype=float)
        self.touches = touches
        self.least_force = least_force
        self.least_share = least_share
        self.smoothing = smoothing
        self.gap = gap
        self.mean = np.zeros(len(touches))
        self.slope = np.zeros((len(touches), 2))
        self.time = -_INFINITE

    def lift(self):
        """Clear the contacts of a foot in the air."""
        self.time = -_INFINITE
        for i in range(self.mean.shape[0]):
            self.mean[i] = 0.0
            self.slope[i, 0] = 0.0
            self.slope[i, 1] = 0.0
            self.touches[i] = 0

    def follow(self, reading, rotation, center_of_pressure):
        """`carry` a `plantar.Reading` that is new since `lift`, and `turn`; returns whether other cells touch."""
        changed = False
        if reading.time > self.time:
            self.time = reading.time
            changed = self.carry(reading.force, rotation)
        return self.turn(rotation, center_of_pressure) or changed

    def carry(self, force, rotation):
        """Add a reading (n,) in N of a sole turned by `rotation` (3, 3) to the world; what is not finite counts as 0.

        Returns whether another cell touches.
        """
        given = memory.values(force)
        r = memory.values(rotation)
        total = 0.0
        for i in range(self.mean.shape[0]):
            now = given[i] if -_INFINITE < given[i] < _INFINITE else 0.0
            self.mean[i] += self.smoothing * (now - self.mean[i])
            total += self.mean[i]
        least = max(self.least_force, self.least_share * total)
        changed = False
        for i in range(self.mean.shape[0]):
            if self.mean[i] > least:
                changed = changed or not self.touches[i]
                self.touches[i] = 1
                # A cell that carries has not lifted off, as the sole did before or not: rises count from here.
                self.slope[i, 0] = r[6]
                self.slope[i, 1] = r[7]
        return changed

    def turn(self, rotation, center_of_pressure):
        """Clear cells that the sole's rotation (3, 3) has lifted; returns whether there are any.

        The sole turns about its center of pressure (2,): to first order a cell rises by slope times its distance from
        there.
        """
        r = memory.values(rotation)
        point = memory.values(center_of_pressure)
        changed = False
        for i in range(self.mean.shape[0]):
            if self.touches[i]:
                along = (r[6] - self.slope[i, 0]) * (self.places[i, 0] - point[0])
                aside = (r[7] - self.slope[i, 1]) * (self.places[i, 1] - point[1])
                if not along + aside < self.gap:
                    self.touches[i] = 0
                    changed = True
        return changed


def encloses(polygon, point):
    """Whether a point (2,) in m lies in a convex polygon (k, 2) in m, or on it; none of fewer than three corners."""
    if len(polygon) < 3:
        return False
    place = memory.values(point)
    return convex.signed_margin(polygon, place[0], place[1]) >= 0.0


def along_sole(rotation, position, point):
    """Way (2,) in m from a sole's origin to a point (2,) in the world, along the sole's axes seen from above.

    `rotation`: sole to world (3, 3); `position`: sole's origin (3,) in the world in m.
    """
    r = memory.values(rotation)
    at = memory.values(position)
    to = memory.values(point)
    dx = to[0] - at[0]
    dy = to[1] - at[1]
    return vectors.vector2(r[0] * dx + r[3] * dy, r[1] * dx + r[4] * dy)
