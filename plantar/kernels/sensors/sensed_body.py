"""Kernel of the readings of encoders and IMU of a simulated body."""

import numpy as np

__all__ = ["SensedBody"]


class SensedBody:
    """Reads k joints and an IMU.

    Args:
        positions: Coordinates (n,) of the body, written by the simulator.
        places: Index (k,) of each joint's angle there.
        rate: Angular velocity (3,) in rad/s, likewise.
        force: Specific force (3,) in m/s^2, likewise.
        noise: `NoiseRows` of the angles in rad, the rate and the force (k + 6).
        offsets: Offsets (k,) of the encoders in rad; empty for none.
        bias: Bias (3,) of the gyro in rad/s; likewise.
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
        """New arrays of angles (k,) in rad, angular velocity (3,) in rad/s and specific force (3,) in m/s^2."""
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
