"""Joint torques at rest against gravity, less other forces (`mj_rne`, summed in its order)."""

import numpy as np

from ..base import memory

__all__ = ["StaticLoad"]


class StaticLoad:
    """Loads of a model and of its joints.

    Args:
        parents: Parent of each body (b,), listed before it; first the world.
        bodies: Body of each velocity (nv,).
        inertias: Each body's `cinert` (b, 10); the last four are mass times way, and mass.
        motions: Unit motion (nv, 6) of each velocity: w, then v.
        gravity: Acceleration (3,) of falling body.
        places: Velocities (k,) of joints.
        torques: Receives their loads (k,).
    """

    def __init__(self, parents, bodies, inertias, motions, gravity, places, torques):
        self.parents = parents
        self.bodies = bodies
        self.inertias = inertias
        self.motions = motions
        self.gravity = gravity
        self.places = places
        self.torques = torques
        self.wrenches = np.zeros((len(parents), 6))
        self.load = np.zeros(len(bodies))

    def weigh(self):
        """Begin with the load of gravity."""
        wrenches = self.wrenches
        inertias = self.inertias
        motions = self.motions
        x = -self.gravity[0]
        y = -self.gravity[1]
        z = -self.gravity[2]
        count = self.parents.shape[0]
        for b in range(1, count):
            i = inertias[b, 6]
            j = inertias[b, 7]
            k = inertias[b, 8]
            mass = inertias[b, 9]
            wrenches[b, 0] = j * z - k * y
            wrenches[b, 1] = k * x - i * z
            wrenches[b, 2] = i * y - j * x
            wrenches[b, 3] = mass * x
            wrenches[b, 4] = mass * y
            wrenches[b, 5] = mass * z
        for b in range(count - 1, 0, -1):
            p = self.parents[b]
            if p > 0:
                for n in range(6):
                    wrenches[p, n] += wrenches[b, n]
        for v in range(self.load.shape[0]):
            b = self.bodies[v]
            even = motions[v, 0] * wrenches[b, 0] + motions[v, 2] * wrenches[b, 2]
            odd = motions[v, 1] * wrenches[b, 1] + motions[v, 3] * wrenches[b, 3]
            self.load[v] = (even + odd) + (motions[v, 4] * wrenches[b, 4] + motions[v, 5] * wrenches[b, 5])

    def less(self, lever, force, x, y, z):
        """Subtract what a force (3,) in N carries at a point (x, y, z) in m, which moves by the `PointRows` lever."""
        numbers = memory.values(force)
        lever.write(x, y, z)
        rows = lever.jacobian
        for v in range(self.load.shape[0]):
            self.load[v] -= numbers[0] * rows[0, v] + numbers[1] * rows[1, v] + numbers[2] * rows[2, v]

    def stand(self, levers, left, left_point, left_place, right, right_point, right_place):
        """Write the loads of a robot on its soles.

        `levers`: `PointRows` of the left and right sole; `left`: ground force (3,) in N on the left sole, none where it
        does not press; `left_point`: point (2,) in m where it acts, at the height of `left_place` (3,) in m; the right
        one's likewise. Returns the left sole's share of the vertical force.
        """
        self.weigh()
        pressing = self._press(levers[0], left, left_point, left_place)
        other = self._press(levers[1], right, right_point, right_place)
        self.take()
        return pressing / (pressing + other) if pressing + other > 0.0 else 0.5

    def _press(self, lever, force, point, place):
        """Subtract what a sole carries; returns the vertical force in N, 0 where it does not press."""
        pressing = memory.values(force)[2]
        if not pressing > 0.0:
            return 0.0
        at = memory.values(point)
        self.less(lever, force, at[0], at[1], memory.values(place)[2])
        return pressing

    def take(self):
        """Write the loads of the joints."""
        for k in range(self.places.shape[0]):
            self.torques[k] = self.load[self.places[k]]
