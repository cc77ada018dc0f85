"""Kernels of the tasks of inverse kinematics: error and Jacobian of each.

A velocity moves a body by the unit motion (w, v), MuJoCo's `cdof`: a point p goes along v + w x (p - c). The results
are those of `mj_jac` to the last bit. `plantar.robots.kinematics.tasks` is the public face. Each object writes to its
own arrays, which begin at zero.
"""

from __future__ import annotations

from ..mechanics import rotations

__all__ = ["ComRows", "PointRows", "PoseRows", "Rows", "TurnRows"]


class Rows:
    """Error and Jacobian of a task."""

    def write(self):
        """Write both.

        Returns:
            Whether the error is as it should be: a turn that is missing is so up to a quarter turn, and beyond that is
            another one, which is left to the task.
        """
        return True


class PointRows:
    """How a point of a body moves.

    Args:
        chain: Velocities (c,) that move the body.
        motions: Unit motion (nv, 6) of each velocity: w, then v.
        center: Center (3,) of the body's tree.
        jacobian: Receives the velocity (3, nv) of the point.
    """

    def __init__(self, chain, motions, center, jacobian):
        self.chain, self.motions, self.center, self.jacobian = chain, motions, center, jacobian

    def write(self, x, y, z):
        """Write how the point (x, y, z) moves."""
        chain, motions, center, out = self.chain, self.motions, self.center, self.jacobian
        x, y, z = x - center[0], y - center[1], z - center[2]
        for k in range(chain.shape[0]):
            i = chain[k]
            out[0, i] = motions[i, 3] + (motions[i, 1] * z - motions[i, 2] * y)
            out[1, i] = motions[i, 4] + (motions[i, 2] * x - motions[i, 0] * z)
            out[2, i] = motions[i, 5] + (motions[i, 0] * y - motions[i, 1] * x)


class TurnRows(Rows):
    """A body's orientation.

    Args:
        chain: Velocities (c,) that move the body.
        motions: Unit motion (nv, 6) of each velocity: w, then v.
        wanted: Wanted rotation (3, 3) from the body to the world frame.
        actual: Its rotation.
        error: Receives the missing turn (3,) in the world frame.
        jacobian: Receives the angular velocity (3, nv) in the world frame.
    """

    def __init__(self, chain, motions, wanted, actual, error, jacobian):
        self.chain, self.motions, self.wanted, self.actual = chain, motions, wanted, actual
        self.error, self.jacobian = error, jacobian

    def write(self):
        """See `Rows`."""
        chain, motions, out = self.chain, self.motions, self.jacobian
        for k in range(chain.shape[0]):
            i = chain[k]
            for j in range(3):
                out[j, i] = motions[i, j]
        return rotations.missing_turn(self.wanted, self.actual, self.error)


class PoseRows(Rows):
    """The pose of a frame that a body carries.

    Args:
        chain: Velocities (c,) that move the body.
        motions: Unit motion (nv, 6) of each velocity: w, then v.
        center: Center (3,) of the body's tree.
        position: Wanted origin (3,).
        rotation: Wanted rotation (3, 3) from the frame to the world frame.
        at: The origin (3,).
        turned: The rotation (3, 3).
        error: Receives the missing way (3,) and turn (3,) in the world frame.
        jacobian: Receives the velocity (3, nv) of the origin and the angular velocity (3, nv) in the world frame.
    """

    def __init__(self, chain, motions, center, position, rotation, at, turned, error, jacobian):
        self.position, self.at, self.error = position, at, error
        self.point = PointRows(chain, motions, center, jacobian[:3])
        self.turn = TurnRows(chain, motions, rotation, turned, error[3:], jacobian[3:])

    def write(self):
        """See `Rows`."""
        at = self.at
        for i in range(3):
            self.error[i] = self.position[i] - at[i]
        self.point.write(at[0], at[1], at[2])
        return self.turn.write()


class ComRows(Rows):
    """The CoM of bodies.

    Args:
        chains: Velocities that move each of b bodies, one after the other.
        ends: End (b,) of each body's velocities there.
        masses: Mass (b,) of each body.
        share: One over their sum.
        motions: Unit motion (nv, 6) of each velocity: w, then v.
        centers: Centers (t, 3) of trees.
        trees: Tree (b,) of each body.
        places: CoM (b, 3) of each body.
        target: Wanted CoM (3,) of all.
        com: Their CoM (3,).
        error: Receives the missing way (3,).
        jacobian: Receives the velocity (3, nv) of the CoM.
    """

    def __init__(self, chains, ends, masses, share, motions, centers, trees, places, target, com, error, jacobian):
        self.chains, self.ends, self.masses, self.share = chains, ends, masses, share
        self.motions, self.centers, self.trees, self.places = motions, centers, trees, places
        self.target, self.com, self.error, self.jacobian = target, com, error, jacobian

    def write(self):
        """See `Rows`."""
        chains, motions, centers, places, out = self.chains, self.motions, self.centers, self.places, self.jacobian
        for j in range(3):
            self.error[j] = self.target[j] - self.com[j]
            for i in range(out.shape[1]):
                out[j, i] = 0.0
        begin = 0
        for b in range(self.ends.shape[0]):
            mass, t = self.masses[b], self.trees[b]
            x, y, z = places[b, 0] - centers[t, 0], places[b, 1] - centers[t, 1], places[b, 2] - centers[t, 2]
            for k in range(begin, self.ends[b]):
                i = chains[k]
                out[0, i] += (motions[i, 3] + (motions[i, 1] * z - motions[i, 2] * y)) * mass
                out[1, i] += (motions[i, 4] + (motions[i, 2] * x - motions[i, 0] * z)) * mass
                out[2, i] += (motions[i, 5] + (motions[i, 0] * y - motions[i, 1] * x)) * mass
            begin = self.ends[b]
        for j in range(3):
            for i in range(out.shape[1]):
                out[j, i] *= self.share
        return True
