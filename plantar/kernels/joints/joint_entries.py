"""Kernel of the entries (k,) of a model's vector (n,) that belong to its joints."""

from __future__ import annotations

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

    def take(self):
        """Copy the entries as they are now."""
        for k in range(self.places.shape[0]):
            self.entries[k] = self.vector[self.places[k]]
