"""Kernel of the entries of a model's vector that belong to its joints, in the order of joint vectors.

Plain Python that also compiles ahead of time (`joint_entries.pxd` gives the C types).
"""

from __future__ import annotations

from . import memory

__all__ = ["JointEntries"]


class JointEntries:
    """Some entries of a vector.

    Args:
        vector: The vector (n,).
        places: Where the entries stand in it (k,).
        entries: Receives them (k,).
    """

    def __init__(self, vector, places, entries):
        self.vector, self.places, self.entries = vector, places, entries

    def less(self, share):
        """Subtract another vector (n,), a contiguous array of float64, from the vector."""
        numbers = memory.values(share)
        for i in range(self.vector.shape[0]):
            self.vector[i] -= numbers[i]

    def take(self):
        """Copy the entries as they are now."""
        for k in range(self.places.shape[0]):
            self.entries[k] = self.vector[self.places[k]]
