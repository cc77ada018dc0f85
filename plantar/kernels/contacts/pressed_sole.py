"""Elastic sole: its taxels' load from its contacts."""

import numpy as np

from . import pressed_patch

__all__ = ["PressedSole"]

_RECENT = 4  # patches that are looked at before any other: one for each piece of ground that a sole mostly stands on


class PressedSole:
    """Spreads loads over a sole's cells, keeping what was computed for a patch.

    `gains`: reading of cell's taxel (n,) per vertical force; `grid`: distance in m within which contact points span the
    same patch; `make`: makes patch of contact points (k, 2) in m. Attributes `forces`: last forces (n,) of taxels in N.
    """

    def __init__(self, gains, grid, most, make):
        self.gains = gains
        self.grid = grid
        self.most = most
        self.make = make
        self.made = {}
        self.carried = np.zeros(len(gains))
        self.forces = self.carried
        self.part = np.zeros(len(gains))
        self.recent = [None] * _RECENT  # the patches that were pressed lately
        self.recent_counts = np.zeros(_RECENT, dtype=np.intp)  # how many points each has; 0 for none
        self.slot = 0  # of the one that was pressed last
        self._make_room(8)

    def _make_room(self, room):
        self.room = room
        self.points = np.zeros((room, 3))  # x, y and overlap
        self.places = np.zeros((_RECENT, room, 2))
        for slot in range(_RECENT):
            self.recent_counts[slot] = 0

    def press(self, contacts, vectors, reach):
        """Forces (n,) in N of the taxels under a foot's contacts, pair by pair.

        `vectors`: position, force and torque of each in sole frame (at least 3 k, 3); `reach`: largest gap in m of
        contact without load.
        """
        self.load(contacts, vectors, reach)
        return self.carried.copy()

    def stand(self, contacts, seen, reach):
        """Set `forces` from a foot's contacts.

        `seen`: `ContactsInSole`, which turns them into sole frame; `reach`: largest gap in m of contact without load.
        """
        seen.turn(contacts)
        self.load(contacts, seen.vectors, reach)

    def load(self, contacts, vectors, reach):
        """`press`, with the result in `forces`."""
        self._clear()
        if contacts.size > self.room:
            self._make_room(2 * contacts.size)
        for k in range(contacts.size):
            count, force, about_x, about_y = contacts._pair_load(vectors, reach, k, self.points)
            if force > 0.0:
                self._spread(count, force, -about_y / force, about_x / force)

    def _clear(self):
        for i in range(self.forces.shape[0]):
            self.forces[i] = 0.0

    def spread(self, points, force, x, y):
        """Forces (n,) in N of taxels under a load `force` above 0 at x, y in m, on the hull of `points` in m."""
        self._clear()
        if len(points) > self.room:
            self._make_room(2 * len(points))
        count = 0
        for px, py in points:
            self.points[count, 0] = px
            self.points[count, 1] = py
            count += 1
        self._spread(count, force, x, y)
        return self.carried.copy()

    def _spread(self, count, force, x, y):
        patch = self._patch(count)
        for i in range(self.part.shape[0]):
            self.part[i] = 0.0
        if not patch.spread(force, x, y, self.part):
            patch.settle(force, self.part)
        for i in range(self.part.shape[0]):
            self.forces[i] = self.forces[i] + self.part[i] * self.gains[i]

    def _patch(self, count):
        """Patch of the first points, mostly a recent one."""
        for i in range(_RECENT):
            slot = (self.slot + i) % _RECENT
            if self._is_recent(slot, count):
                self.slot = slot
                return self.recent[slot]
        key = pressed_patch.patch_key(np.asarray(self.points)[:count, :2].tolist(), self.grid)
        patch = self.made.get(key)
        if patch is None:
            if len(self.made) >= self.most:
                self.made.pop(next(iter(self.made)))
            patch = self.make(np.array(key) * self.grid)
            self.made[key] = patch
        slot = (self.slot + 1) % _RECENT
        self.slot = slot
        self.recent[slot] = patch
        self.recent_counts[slot] = count
        for i in range(count):
            self.places[slot, i, 0] = round(self.points[i, 0] / self.grid)
            self.places[slot, i, 1] = round(self.points[i, 1] / self.grid)
        return patch

    def _is_recent(self, slot, count):
        if count != self.recent_counts[slot]:
            return False
        for i in range(count):
            x = self.points[i, 0] / self.grid - self.places[slot, i, 0]
            y = self.points[i, 1] / self.grid - self.places[slot, i, 1]
            if not (-0.5 < x < 0.5 and -0.5 < y < 0.5):
                return False
        return True
