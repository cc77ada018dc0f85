"""What each piece of ground carries, and for how long."""

import numpy as np

__all__ = ["PieceLoads"]


class PieceLoads:
    """Follows p pieces of ground under both feet, physics step by physics step.

    Args:
        numbers: Piece of each geom (geoms,), below 0 for none.
        least: Vertical force in N from which a piece carries.

    Attributes:
        largest: Largest vertical force (p,) in N on each piece.
        longest: Most steps in a row (p,) in which it carried.
    """

    def __init__(self, numbers, least):
        count = max(0, int(np.max(numbers, initial=-1)) + 1)
        self.numbers = numbers
        self.least = least
        self.loads = np.zeros(count)
        self.lasting = np.zeros(count, dtype=np.intp)
        self.largest = np.zeros(count)
        self.longest = np.zeros(count, dtype=np.intp)

    def step(self, feet):
        """Add the present contacts of each foot's `FootContacts`."""
        for piece in range(self.loads.shape[0]):
            self.loads[piece] = 0.0
        for foot in feet:
            for k in range(foot.size):
                geom = foot.ids[k, 1]
                if geom >= 0 and self.numbers[geom] >= 0:
                    self.loads[self.numbers[geom]] += foot.vectors[3 * k + 1, 2]
        for piece in range(self.loads.shape[0]):
            if self.loads[piece] > self.largest[piece]:
                self.largest[piece] = self.loads[piece]
            if self.loads[piece] < self.least:
                self.lasting[piece] = 0
                continue
            self.lasting[piece] += 1
            if self.lasting[piece] > self.longest[piece]:
                self.longest[piece] = self.lasting[piece]
        return 0
