"""Distances that a swinging sole sees, averaged while it moves, and the highest ground's plane in them."""

import math

import numpy as np

from ..base import memory, order
from . import highest_ground

__all__ = ["GroundSight"]

_INFINITE = float("inf")
# of the median of the absolute values of normal noise; nature: 1 over the upper quartile of the normal distribution
_SIGMA_OF_MEDIAN = 1.4826


class GroundSight:
    """Map of the ground under a sole of n taxels.

    Args:
        places: Taxels (n, 2) in sole frame in m.
        corners: Sole's outline (k, 2) in m.
        averaging: Readings averaged while it moves fast and while it is still, and the way in m a tick that halves
            the latter.
        noise: Least standard deviation of a distance in m, and share of a reading in what is known of that.
        jumps: Differences of a taxel, and of the mean of all, in standard deviations, that show moved ground.
        follow: Least number of taxels on a plane for a slope, and its largest tangent.
        poses: Number of poses kept for readings that are late.

    Attributes:
        distance: Of each taxel (n,) in m; inf or NaN if unseen.
        noise: Standard deviation of a distance in m.
        seen: Number of taxels that see ground at the last `look`; `on_plane` of those on its plane.
        nearest: Down to the first contact in m; `middle` down under the sole's middle.
        found: Whether there is a plane.
        sloped: Whether enough lies on a plane that is not too steep; its tangents, 0 if none
            was found, are `slope_x`, `slope_y`.
    """

    def __init__(self, places, corners, averaging, noise, jumps, follow, poses):
        self.x = np.array(places[:, 0], dtype=float)
        self.y = np.array(places[:, 1], dtype=float)
        self.middle_x = float(places[:, 0].mean())
        self.middle_y = float(places[:, 1].mean())
        self.corners = np.array(corners, dtype=float)
        self.moving, self.still, self.halving = averaging
        self.least_noise, self.noise_share = noise
        self.jump, self.jump_of_all = jumps
        self.least, self.steepest = follow
        count = len(self.x)
        self.distance = np.full(count, _INFINITE)
        self.readings = np.zeros(count)
        self.news = np.zeros(count)
        self.work = np.zeros(count)
        self.used = np.zeros(count, dtype=np.uint8)
        self.plane = np.zeros(3)
        self.poses = np.zeros((poses, 7))  # a ring: time, position, and the sole's z axis
        self.count = 0
        self.last = 0
        self.rise = np.zeros(3)
        self.noise = self.least_noise
        self.most = self.moving
        self.seen = 0
        self.on_plane = 0
        self.nearest = 0.0
        self.middle = 0.0
        self.slope_x = 0.0
        self.slope_y = 0.0
        self.found = False
        self.sloped = False

    def begin(self):
        """Empty the map for a swing."""
        for i in range(self.distance.shape[0]):
            self.distance[i] = _INFINITE
            self.readings[i] = 0.0
        self.count = 0

    def move(self, time, position, rotation):
        """Carry the map to the sole's pose at a `time` in s: position (3,) in m, and rotation (3, 3) to the world."""
        p = memory.values(position)
        r = memory.values(rotation)
        if self.count:
            before = self.poses[self.last]
            x = p[0] - before[1]
            y = p[1] - before[2]
            z = p[2] - before[3]
            moved = math.sqrt(x * x + y * y + z * z)
            self.most = max(self.moving, self.still * self.halving / (self.halving + moved))
            self._risen(self.last, p, r)
            up = self.rise[0]
            along = self.rise[1]
            aside = self.rise[2]
            for i in range(self.distance.shape[0]):
                self.distance[i] += up + along * self.x[i] + aside * self.y[i]
            self.last = (self.last + 1) % self.poses.shape[0]
        pose = self.poses[self.last]
        pose[0] = time
        for i in range(3):
            pose[1 + i], pose[4 + i] = p[i], r[3 * i + 2]
        self.count = min(self.count + 1, self.poses.shape[0])

    def _risen(self, pose, p, r):
        """Write to `rise` the taxels' rise since a kept pose: in m, and tangents along x and y."""
        before = self.poses[pose]
        x = p[0] - before[1]
        y = p[1] - before[2]
        z = p[2] - before[3]
        self.rise[0] = r[2] * x + r[5] * y + r[8] * z
        self.rise[1] = before[4] * r[0] + before[5] * r[3] + before[6] * r[6]
        self.rise[2] = before[4] * r[1] + before[5] * r[4] + before[6] * r[7]

    def mix(self, reading, time, position, rotation):
        """Average distances (n,) in m, read at a `time` in s, into the map, which restarts on moved ground.

        Needs the pose of the last `move`.
        """
        given = memory.values(reading)
        self._risen_since(time, memory.values(position), memory.values(rotation))
        up = self.rise[0]
        along = self.rise[1]
        aside = self.rise[2]
        fresh = 0
        total = 0.0
        for i in range(self.distance.shape[0]):
            now = given[i] + (up + along * self.x[i] + aside * self.y[i])
            self.news[i] = now
            if abs(now) < _INFINITE and abs(self.distance[i]) < _INFINITE:
                news = now - self.distance[i]
                total += news
                self.work[fresh] = abs(news)
                fresh += 1
        if fresh:
            if abs(total) / fresh > self.jump_of_all * self.noise:
                for i in range(self.distance.shape[0]):
                    self.readings[i] = 0.0
            spread = _SIGMA_OF_MEDIAN * order.median(self.work, fresh)
            self.noise = max(self.least_noise, self.noise + self.noise_share * (spread - self.noise))
        for i in range(self.distance.shape[0]):
            now = self.news[i]
            known = abs(now) < _INFINITE and abs(self.distance[i]) < _INFINITE
            news = now - self.distance[i] if known else 0.0
            if not known or abs(news) > self.jump * self.noise:
                self.readings[i] = 0.0
            self.readings[i] = min(self.readings[i] + 1.0, self.most)
            self.distance[i] = self.distance[i] + news / self.readings[i] if known else now

    def _risen_since(self, time, p, r):
        """Write to `rise` the taxels' rise since a `time`, between kept poses in proportion to it."""
        size = self.poses.shape[0]
        later = self.poses[self.last, 0]
        up = 0.0
        along = 0.0
        aside = 0.0
        self.rise[0] = 0.0
        self.rise[1] = 0.0
        self.rise[2] = 0.0
        for k in range(self.count):
            pose = (self.last - k + size) % size
            then = self.poses[pose, 0]
            if k:
                self._risen(pose, p, r)
            if then <= time:
                span = later - then
                share = (time - then) / span if span > 0.0 else 1.0
                self.rise[0] += share * (up - self.rise[0])
                self.rise[1] += share * (along - self.rise[1])
                self.rise[2] += share * (aside - self.rise[2])
                return
            later = then
            up = self.rise[0]
            along = self.rise[1]
            aside = self.rise[2]

    def look(self, bias):
        """Find the highest ground, distances less a `bias` in m; returns whether three taxels see any."""
        count = self.distance.shape[0]
        seen = 0
        for i in range(count):
            self.news[i] = self.distance[i] - bias
            seen += abs(self.news[i]) < _INFINITE
        self.seen = seen
        if seen < 3:
            return False
        found = highest_ground.highest_plane(
            self.x, self.y, self.news, self.readings, self.noise, self.least, self.used, self.plane
        )
        self.found = found
        on = 0
        for i in range(count):
            if self.used[i]:
                self.work[on] = self.news[i]
                on += 1
        self.on_plane = on
        self.slope_x, self.slope_y = (self.plane[1], self.plane[2]) if found else (0.0, 0.0)
        steep = math.sqrt(self.slope_x * self.slope_x + self.slope_y * self.slope_y) > self.steepest
        self.sloped = on >= self.least and not steep
        if self.sloped and found:
            highest = -_INFINITE
            for i in range(self.corners.shape[0]):
                highest = max(highest, self.slope_x * self.corners[i, 0] + self.slope_y * self.corners[i, 1])
            self.nearest = self.plane[0] - highest
            self.middle = self.plane[0] - self.slope_x * self.middle_x - self.slope_y * self.middle_y
        else:  # the mean of the nearest third
            self.nearest = order.mean_of_least(self.work, on, max(1, on // 3)) if on else float("nan")
            self.middle = self.nearest
        return True
