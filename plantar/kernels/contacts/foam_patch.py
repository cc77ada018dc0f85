"""A patch of foam that an obstacle sinks into: pressure by depth and rate, friction by sliding, taxel by taxel."""

import math

import numpy as np

__all__ = ["FoamPatch"]


class FoamPatch:
    """Taxels of one link, each a ray that starts inside the foam.

    `starts`: of rays (n, 3) in link frame in m; `ways`: outward unit vectors (n, 3) there; `areas`: (n,) in m^2;
    `limits`: (2, n) lengths of rays in m at the skin's face and at the end of its range; `foam`: stiffness in Pa/m,
    damping in Pa s/m, friction and slip speed in m/s. Attributes, in the world: `origins` and `rays` (n, 3) of `place`,
    `wrench` (6,) of the last `press` about the world's origin in N and N m.
    """

    def __init__(self, starts, ways, areas, limits, foam):
        self.starts = starts
        self.ways = ways
        self.areas = areas
        self.limits = limits
        self.foam = foam
        self.origins = np.zeros(starts.shape)
        self.rays = np.zeros(starts.shape)
        self.wrench = np.zeros(6)
        self._origins = self.origins
        self._rays = self.rays
        self._wrench = self.wrench
        self.turn = np.zeros(9)
        self.origin = np.zeros(3)

    def place(self, turn, origin):
        """Take the link's rotation (9,) to the world and its place (3,) in m."""
        for j in range(9):
            self.turn[j] = turn[j]
        for j in range(3):
            self.origin[j] = origin[j]
        for i in range(self.areas.shape[0]):
            for j in range(3):
                x = turn[3 * j]
                y = turn[3 * j + 1]
                z = turn[3 * j + 2]
                self._origins[i, j] = x * self.starts[i, 0] + y * self.starts[i, 1] + z * self.starts[i, 2] + origin[j]
                self._rays[i, j] = x * self.ways[i, 0] + y * self.ways[i, 1] + z * self.ways[i, 2]

    def press(self, lengths, link, obstacle, near, values, vectors):
        """Whether an obstacle presses it; its force adds up.

        `lengths`: (n,) in m at which rays meet the obstacle, -1 for a miss; `link` and `obstacle`: motion (9,): spin in
        rad/s, velocity in m/s, and the place in m that has it; `near`: distances (n,) in m, of which the least counts;
        `values`: force and depth (2, n) in N and m; `vectors`: force (n, 3) in link frame in N.
        """
        wrench = self._wrench
        for j in range(6):
            wrench[j] = 0.0
        pressed = False
        for i in range(self.areas.shape[0]):
            length = lengths[i]
            if not 0.0 <= length <= self.limits[1, i]:
                continue
            distance = length - self.limits[0, i]
            if distance < near[i]:
                near[i] = distance
            if distance < 0.0:
                pressed = True
                self._yield(i, length, -distance, link, obstacle, values, vectors)
        return pressed

    def _yield(self, i, length, depth, link, obstacle, values, vectors):
        nx = -self._rays[i, 0]
        ny = -self._rays[i, 1]
        nz = -self._rays[i, 2]
        x = self._origins[i, 0] - length * nx
        y = self._origins[i, 1] - length * ny
        z = self._origins[i, 2] - length * nz
        ox = x - obstacle[6]
        oy = y - obstacle[7]
        oz = z - obstacle[8]
        lx = x - link[6]
        ly = y - link[7]
        lz = z - link[8]
        vx = obstacle[3] + obstacle[1] * oz - obstacle[2] * oy - link[3] - (link[1] * lz - link[2] * ly)
        vy = obstacle[4] + obstacle[2] * ox - obstacle[0] * oz - link[4] - (link[2] * lx - link[0] * lz)
        vz = obstacle[5] + obstacle[0] * oy - obstacle[1] * ox - link[5] - (link[0] * ly - link[1] * lx)
        rate = vx * nx + vy * ny + vz * nz
        if depth > values[1, i]:
            values[1, i] = depth
        force = self.areas[i] * (self.foam[0] * depth + self.foam[1] * rate)
        if not force > 0.0:
            return
        vx -= rate * nx
        vy -= rate * ny
        vz -= rate * nz
        drag = self.foam[2] / math.sqrt(vx * vx + vy * vy + vz * vz + self.foam[3] * self.foam[3])
        fx = force * (nx + drag * vx)
        fy = force * (ny + drag * vy)
        fz = force * (nz + drag * vz)
        values[0, i] += force
        for j in range(3):
            vectors[i, j] += fx * self.turn[j] + fy * self.turn[3 + j] + fz * self.turn[6 + j]
        self._wrench[0] += fx
        self._wrench[1] += fy
        self._wrench[2] += fz
        self._wrench[3] += y * fz - z * fy
        self._wrench[4] += z * fx - x * fz
        self._wrench[5] += x * fy - y * fx

    def add(self, row, place, sign):
        """Add the last wrench, times a sign, about a place (3,) in m to a row (6,) in the world frame."""
        f = self._wrench
        row[0] += sign * f[0]
        row[1] += sign * f[1]
        row[2] += sign * f[2]
        row[3] += sign * (f[3] - (place[1] * f[2] - place[2] * f[1]))
        row[4] += sign * (f[4] - (place[2] * f[0] - place[0] * f[2]))
        row[5] += sign * (f[5] - (place[0] * f[1] - place[1] * f[0]))

    def add_to_link(self, row):
        """Add the last wrench about the link's origin to a row (6,) in link frame."""
        f = self._wrench
        p = self.origin
        mx = f[3] - (p[1] * f[2] - p[2] * f[1])
        my = f[4] - (p[2] * f[0] - p[0] * f[2])
        mz = f[5] - (p[0] * f[1] - p[1] * f[0])
        for j in range(3):
            row[j] += f[0] * self.turn[j] + f[1] * self.turn[3 + j] + f[2] * self.turn[6 + j]
            row[3 + j] += mx * self.turn[j] + my * self.turn[3 + j] + mz * self.turn[6 + j]
