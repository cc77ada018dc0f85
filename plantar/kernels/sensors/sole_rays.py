"""Proximity sensors of one sole: each taxel's ray against the ground."""

import math

import numpy as np

from . import ground_rays

__all__ = ["SoleRays"]

_INFINITE = float("inf")
_NONE = float("nan")
_dot = np.dot


class SoleRays:
    """Rays of n taxels, cast from the sole's current pose.

    `starts`: where rays begin (n, 3) in sole frame in m, along unit vectors `ways` (n, 3); `lift`: how far in m a ray
    begins inside sole; `most`: range of sensors in m; `origin`: sole's origin (3,) in world in m, and its `rotation`
    (3, 3), written by simulator; `solids`: rows, kinds, sizes and bounds of solids, as in `cast_rays`; `positions`:
    middles (m, 3) of all solids in world in m; `frames` (m, 9) likewise. Attributes `starts`: where the last rays began
    (n, 3) in world in m; `ways` (n, 3) along them; `lengths`: their lengths (n,) in m; below 0 without a hit;
    `distances`: distance (n,) from each taxel to ground in m; inf out of range.
    """

    def __init__(self, starts, ways, lift, most, origin, rotation, solids, positions, frames):
        self.own_starts = starts
        self.own_ways = ways
        self.lift = lift
        self.most = most
        self.origin = origin
        self.turned_back = rotation.T
        self.lowest = rotation.reshape(9)
        self.ids, self.kinds, self.sizes, self.bounds = solids
        self.positions = positions
        self.frames = frames
        count = len(starts)
        self.starts = np.zeros((count, 3))
        self.ways = np.zeros((count, 3))
        self.lengths = np.zeros(count)
        self.distances = np.zeros(count)
        self.start = self.starts
        self.way = self.ways
        self.length = self.lengths
        self.distance = self.distances
        self.sample = np.zeros(count)
        self.told = self.sample
        self.reach = 0.0
        self.height = _INFINITE

    def limit(self, reach, height):
        """Let `look` cast rays only where any taxel `lies_below`."""
        self.reach = reach
        self.height = height

    def look(self):
        """Set `distances`, by rays where ground can be in range."""
        if self.lies_below(self.reach, self.height):
            self.cast()
            self.measure()
        else:
            self.see_nothing()

    def lies_below(self, reach, height):
        """Whether any taxel, at most `reach` in m from the origin, can be below a `height` in m in world."""
        tilt = math.sqrt(self.lowest[6] * self.lowest[6] + self.lowest[7] * self.lowest[7])
        return self.origin[2] - reach * tilt <= height

    def aim(self):
        """Begin the rays at the sole's current pose."""
        _dot(self.own_starts, self.turned_back, self.starts)
        _dot(self.own_ways, self.turned_back, self.ways)
        self._shift()

    def _shift(self):
        for i in range(self.start.shape[0]):
            for j in range(3):
                self.start[i, j] = self.start[i, j] + self.origin[j]

    def cast(self):
        """Aim and cast the rays."""
        self.aim()
        ground_rays.cast_rays(
            self.start,
            self.way,
            self.most + self.lift,
            self.ids,
            self.kinds,
            self.sizes,
            self.bounds,
            self.positions,
            self.frames,
            self.length,
        )

    def measure(self):
        """Set `distances` to the rays' lengths."""
        for i in range(self.length.shape[0]):
            length = self.length[i]
            self.distance[i] = length - self.lift if 0.0 <= length <= self.most + self.lift else _INFINITE

    def see_nothing(self):
        """Set `distances` to out of range."""
        for i in range(self.distance.shape[0]):
            self.distance[i] = _INFINITE

    def tell(self, noise, row, dead):
        """Readings (n,) in m at `distances`, with a row of `NoiseRows`: inf out of range, NaN dead."""
        self._take(noise, row)
        for i in range(dead.shape[0]):
            self.told[dead[i]] = _NONE
        return self.sample.copy()

    def _take(self, noise, row):
        for i in range(self.told.shape[0]):
            value = self.distance[i] + noise.rows[row, i]
            self.told[i] = _INFINITE if value > self.most else value
