"""Kernel of the samples of taxels: what their electronics make of the forces on them."""

from __future__ import annotations

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
        """What the taxels read.

        Args:
            force: Force (n,) on each taxel in N.

        Returns:
            Readings (n,) in N, NaN of a dead taxel.
        """
        self._take(force, self.noise.advance())
        return self.sample.copy()

    def of_contacts(self, sole, contacts, seen, reach):
        """What the taxels read of what presses on their sole.

        Args:
            sole: The `PressedSole`.
            contacts: As its `stand` takes them.
            seen: Likewise.
            reach: Likewise.

        Returns:
            Readings as of `of`.
        """
        sole.stand(contacts, seen, reach)
        self._take(sole.forces, self.noise.advance())
        return self.sample.copy()

    def _take(self, force, row):
        """One sample with a row of the noise."""
        for i in range(self.told.shape[0]):
            value = force[i] + self.noise.rows[row, i]
            if value < self.least:
                value = self.least
            elif value > self.most:
                value = self.most
            self.told[i] = value
        for i in range(self.dead.shape[0]):
            self.told[self.dead[i]] = _NONE
