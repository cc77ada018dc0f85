"""Kernel of the samples of taxels: their electronics' readings of forces."""

import numpy as np

__all__ = ["TaxelSample"]

_NONE = float("nan")


class TaxelSample:
    """Samples n taxels.

    Args:
        noise: `NoiseRows` in N, of which each sample takes the next n numbers.
        count: n.
        least: Least force in N that the taxels report.
        most: Largest one.
        dead: Indices of dead taxels.
    """

    def __init__(self, noise, count, least, most, dead):
        self.noise = noise
        self.least = least
        self.most = most
        self.dead = dead
        self.sample = np.zeros(count)
        self.told = self.sample

    def of(self, force):
        """Readings (n,) in N of forces (n,) in N; NaN of a dead taxel."""
        self._take(force, self.noise.advance())
        return self.sample.copy()

    def of_contacts(self, sole, contacts, seen, reach):
        """Readings of the contacts of their `PressedSole`; arguments as of its `stand`."""
        sole.stand(contacts, seen, reach)
        self._take(sole.forces, self.noise.advance())
        return self.sample.copy()

    def _take(self, force, row):
        for i in range(self.told.shape[0]):
            value = force[i] + self.noise.rows[row, i]
            if value < self.least:
                value = self.least
            elif value > self.most:
                value = self.most
            self.told[i] = value
        for i in range(self.dead.shape[0]):
            self.told[self.dead[i]] = _NONE
