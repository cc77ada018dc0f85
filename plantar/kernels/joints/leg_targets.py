"""Copies the legs' targets to where their tasks read them."""

from ..base import memory

__all__ = ["JointEntries", "LegTargets"]


class LegTargets:
    """Arrays that receive the targets.

    `com`: CoM (3,); `torso`: rotation (3, 3) of torso; `left`: position (3,) and rotation (3, 3) of left sole.
    """

    def __init__(self, com, torso, left, right):
        self.com = com
        self.torso = torso
        self.left, self.left_turn = left
        self.right, self.right_turn = right

    def take(self, com, torso, left, left_turn, right, right_turn):
        """Copy the targets, in the arguments' order; ValueError unless contiguous float64 arrays."""
        a = memory.values(com)
        b = memory.values(left)
        c = memory.values(right)
        d = memory.values(torso)
        e = memory.values(left_turn)
        f = memory.values(right_turn)
        for i in range(3):
            self.com[i] = a[i]
            self.left[i] = b[i]
            self.right[i] = c[i]
            for j in range(3):
                self.torso[i, j] = d[3 * i + j]
                self.left_turn[i, j] = e[3 * i + j]
                self.right_turn[i, j] = f[3 * i + j]

    def follow(self, command):
        """Copy the targets of a `plantar.gait.command.Command`; ValueError as `take`.

        Returns which feet carry no load: 1 for the left one, plus 2 for the right one.
        """
        feet = command.feet
        left = feet["left"]
        right = feet["right"]
        self.take(command.com, command.rotation_torso, left.position, left.rotation, right.position, right.rotation)
        unloaded = 1 if memory.values(left.force)[2] <= 0.0 else 0
        return unloaded + 2 if memory.values(right.force)[2] <= 0.0 else unloaded


class JointEntries:
    """Copies the entries at `places` (k,) of a vector (n,) to `entries` (k,)."""

    def __init__(self, vector, places, entries):
        self.vector = vector
        self.places = places
        self.entries = entries

    def take(self):
        for k in range(self.places.shape[0]):
            self.entries[k] = self.vector[self.places[k]]
