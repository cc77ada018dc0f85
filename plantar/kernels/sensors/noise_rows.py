"""Noise drawn many samples at a time."""

import numpy as np

__all__ = ["NoiseRows", "SampleClock", "SensedBody", "TaxelSample"]


class NoiseRows:
    """Samples of noise without end. `draw`: makes the next samples (rows, n), at least one."""

    def __init__(self, draw):
        self.draw = draw
        self.drawn = None
        self.rows = np.zeros((0, 0))
        self.row = 0

    def advance(self):
        """Move to the next sample, `rows[row]`; returns the row."""
        self.row += 1
        if self.row >= self.rows.shape[0]:
            self.drawn = self.draw()
            self.rows = self.drawn
            self.row = 0
        return self.row

    def __iter__(self):
        return self

    def __next__(self):
        row = self.advance()
        return self.drawn[row]


class SensedBody:
    """Reads k joints and an IMU.

    Args:
        positions: Coordinates (n,) of body, written by simulator.
        places: Index (k,) of each joint's angle there.
        rate: Angular velocity (3,) in rad/s, likewise.
        force: Specific force (3,) in m/s^2, likewise.
        noise: `NoiseRows` of angles in rad, rate and force (k + 6).
        offsets: Offsets (k,) of encoders in rad; empty for none.
        bias: Bias (3,) of gyro in rad/s; likewise.
    """

    def __init__(self, positions, places, rate, force, noise, offsets, bias):
        self.positions = positions
        self.places = places
        self.rate = rate
        self.force = force
        self.noise = noise
        self.offsets = offsets
        self.bias = bias
        self.arrays = np.zeros(len(places)), np.zeros(3), np.zeros(3)
        self.told_joints, self.told_rate, self.told_force = self.arrays

    def read(self):
        """New arrays: angles (k,) in rad, angular velocity (3,) in rad/s, specific force (3,) in m/s^2."""
        self._take(self.noise.advance())
        joints, rate, force = self.arrays
        return joints.copy(), rate.copy(), force.copy()

    def _take(self, row):
        count = self.places.shape[0]
        for i in range(count):
            self.told_joints[i] = self.positions[self.places[i]] + self.noise.rows[row, i]
        for i in range(3):
            self.told_rate[i] = self.rate[i] + self.noise.rows[row, count + i]
            self.told_force[i] = self.force[i] + self.noise.rows[row, count + 3 + i]
        for i in range(self.offsets.shape[0]):
            self.told_joints[i] = self.told_joints[i] + self.offsets[i]
        for i in range(self.bias.shape[0]):
            self.told_rate[i] = self.told_rate[i] + self.bias[i]


class SampleClock:
    """Says when samples are due: at multiples of a `period` in s from `begin` on, `near` of that in s counting."""

    def __init__(self, period, near):
        self.period = period
        self.near = near
        self.start = 0.0
        self.taken = 0

    def begin(self, now):
        """The first sample is due `now`, in s."""
        self.start = now
        self.taken = 0

    def due(self, now):
        """Whether a sample is due `now`, in s, which is then taken."""
        if now < self.start + self.taken * self.period - self.near:
            return False
        # Counts on from now: steps longer than the period skip samples, they do not pile up.
        self.taken = int((now - self.start) / self.period + 1e-6) + 1
        return True


_NONE = float("nan")


class TaxelSample:
    """Samples n taxels.

    `noise`: `NoiseRows` in N, n a sample; `least`: least force in N that taxels report; `dead`: indices of dead taxels.
    """

    def __init__(self, noise, count, least, most, dead):
        self.noise = noise
        self.least = least
        self.most = most
        self.dead = dead
        self.sample = np.zeros(count)
        self.told = self.sample

    def of(self, force):
        """Readings (n,) in N of forces (n,) in N; NaN if dead."""
        self._take(force, self.noise.advance())
        return self.sample.copy()

    def of_contacts(self, sole, contacts, seen, reach):
        """Readings of their `PressedSole`'s contacts; arguments as of its `stand`."""
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
