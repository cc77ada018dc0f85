"""Kernel that turns a foot's contacts into its sole frame."""

import numpy as np

__all__ = ["ContactsInSole"]

_dot = np.dot


class ContactsInSole:
    """Turns a foot's contacts into its sole frame, in the same arrays each time.

    Attributes:
        vectors: Position in m, force in N and torque in N m of each contact in turn (3 room, 3).
        pressed: How often there were contacts.
        in_air: How often there were none.
    """

    def __init__(self):
        self.origin = np.zeros(3)
        self.rotation = np.eye(3)
        self.pressed = 0
        self.in_air = 0
        self.room = 0
        self._make_room(8)

    def look_from(self, origin, rotation):
        """Set origin (3,) in m and rotation (3, 3) to the world of the sole, which the simulator writes."""
        self.origin = origin
        self.rotation = rotation

    def _make_room(self, room):
        """Room for so many contacts; drops those that are there."""
        self.room = room
        shifted, turned = np.zeros((3 * room, 3)), np.zeros((3 * room, 3))
        self.shifted = shifted
        self.vectors = turned
        self.rows = [(shifted[k : k + 1], turned[k : k + 1]) for k in range(3)]
        self.heads = [(shifted[: 3 * k], turned[: 3 * k]) for k in range(room + 1)]

    def turn(self, contacts):
        """Turn the current contacts of a foot's `FootContacts`."""
        count = contacts.size
        if count == 0:
            self.in_air += 1
            return
        self.pressed += 1
        if count > self.room:
            self._make_room(2 * count)
        contacts.from_origin(self.origin, self.shifted)
        if count == 1:  # BLAS adds up in another order for a single contact than for several
            for shifted, turned in self.rows:
                _dot(shifted, self.rotation, turned)
        else:
            shifted, turned = self.heads[count]
            _dot(shifted, self.rotation, turned)
