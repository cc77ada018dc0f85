"""Which patches of skin are near which obstacles: spheres around patches against boxes, and the other way round."""

import numpy as np

__all__ = ["NearPatches"]


class NearPatches:
    """Pairs that may touch or be seen; those that it leaves out cannot.

    `bodies`: ids (p,) of the patches' links; `spheres`: middle in link frame and squared radius (p, 4) in m of each
    patch with its reach; `boxes`: least and largest coordinates (p, 6) of that in link frame in m; `geoms`: ids (k,) of
    obstacles; `shapes`: middle and half edges (k, 6) in m of each one's box in its own frame; `bounds`: squared radius
    (k,) in m^2 of the sphere around each. Attribute `near`: whether (p, k), of the last `look`.
    """

    def __init__(self, bodies, spheres, boxes, geoms, shapes, bounds):
        self.bodies = bodies
        self.spheres = spheres
        self.boxes = boxes
        self.geoms = geoms
        self.shapes = shapes
        self.bounds = bounds
        self.near = np.zeros((len(bodies), len(geoms)), dtype=np.uint8)
        self._near = self.near
        self.middle = np.zeros(3)
        self.apart = np.zeros(3)

    def look(self, places, turns, geom_places, geom_turns):
        """How many pairs are near; `places` (b, 3) in m and rotations `turns` (b, 9) of bodies, likewise of geoms."""
        count = 0
        for i in range(self.bodies.shape[0]):
            b = self.bodies[i]
            for j in range(3):
                self.middle[j] = places[b, j]
                for m in range(3):
                    self.middle[j] += turns[b, 3 * j + m] * self.spheres[i, m]
            for k in range(self.geoms.shape[0]):
                g = self.geoms[k]
                close = self._box_is_near(i, k, g, geom_places, geom_turns)
                if close:
                    close = self._sphere_is_near(i, k, g, b, places, turns, geom_places)
                self._near[i, k] = close
                count += close
        return count

    def _box_is_near(self, i, k, g, geom_places, geom_turns):
        """Whether the obstacle's box reaches into the patch's sphere."""
        squares = 0.0
        for j in range(3):
            self.apart[j] = self.middle[j] - geom_places[g, j]
        for j in range(3):
            local = 0.0
            for m in range(3):
                local += geom_turns[g, 3 * m + j] * self.apart[m]
            out = abs(local - self.shapes[k, j]) - self.shapes[k, 3 + j]
            if out > 0.0:
                squares += out * out
        return squares <= self.spheres[i, 3]

    def _sphere_is_near(self, i, k, g, b, places, turns, geom_places):
        """Whether the obstacle's sphere reaches into the patch's box."""
        squares = 0.0
        for j in range(3):
            self.apart[j] = geom_places[g, j] - places[b, j]
        for j in range(3):
            local = 0.0
            for m in range(3):
                local += turns[b, 3 * m + j] * self.apart[m]
            out = max(self.boxes[i, j] - local, local - self.boxes[i, 3 + j])
            if out > 0.0:
                squares += out * out
        return squares <= self.bounds[k]
