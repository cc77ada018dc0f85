"""Kernel of a model vector's entries for its joints."""

__all__ = ["JointEntries"]


class JointEntries:
    """Copies the entries at `places` (k,) of a vector (n,) to `entries` (k,)."""

    def __init__(self, vector, places, entries):
        self.vector, self.places, self.entries = vector, places, entries

    def take(self):
        for k in range(self.places.shape[0]):
            self.entries[k] = self.vector[self.places[k]]
