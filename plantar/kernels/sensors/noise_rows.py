"""Kernel of noise that is drawn many samples at a time."""

import numpy as np

__all__ = ["NoiseRows"]


class NoiseRows:
    """Samples of noise without end.

    Args:
        draw: Makes the next samples (rows, n), at least one.
    """

    def __init__(self, draw):
        self.draw = draw
        self.drawn = None
        self.rows = np.zeros((0, 0))
        self.row = 0

    def advance(self):
        """Move to the next sample, `rows[row]`, and return the row."""
        self.row += 1
        if self.row >= self.rows.shape[0]:
            self.drawn = self.rows = self.draw()
            self.row = 0
        return self.row

    def __iter__(self):
        return self

    def __next__(self):
        row = self.advance()
        return self.drawn[row]
