"""Kernels of error and Jacobian of the tasks of inverse kinematics, equal to `mj_jac` to the last bit.

A velocity moves a body by the unit motion (w, v) in `motions` (nv, 6), MuJoCo's `cdof`: a point p moves by v + w x (p -
c), c the `center` of the body's tree. `chain` (c,) are the velocities that move the body.
"""

from ..mechanics import rotations

__all__ = ["ComRows", "PointRows", "PoseRows", "Rows", "TurnRows"]


class Rows:
    """Error and Jacobian of a task."""

    def write(self):
        """Write both, into arrays that begin at zero.

        Returns:
            Whether the error is valid: a missing turn is so up to a quarter turn, and left to the task beyond.
        """
        return True


class PointRows:
    """How a point of a body moves: receives the velocity (3, nv) in `jacobian`."""

    def __init__(self, chain, motions, center, jacobian):
        self.chain, self.motions, self.center, self.jacobian = chain, motions, center, jacobian

    def write(self, x, y, z):
        """Write the rows of the point (x, y, z)."""
        chain, motions, center, out = self.chain, self.motions, self.center, self.jacobian
        x, y, z = x - center[0], y - center[1], z - center[2]
        for k in range(chain.shape[0]):
            i = chain[k]
            out[0, i] = motions[i, 3] + (motions[i, 1] * z - motions[i, 2] * y)
            out[1, i] = motions[i, 4] + (motions[i, 2] * x - motions[i, 0] * z)
            out[2, i] = motions[i, 5] + (motions[i, 0] * y - motions[i, 1] * x)


class TurnRows(Rows):
    """A body's orientation: the missing turn (3,) from `actual` to `wanted` (3, 3), and angular velocity (3, nv), in
    the world.
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
    """The pose of a frame that a body carries: missing way (3,) and turn (3,) in the world, and Jacobian (6, nv).

    Args:
        position: Desired origin (3,); `at` the current one.
        rotation: Desired rotation (3, 3) to the world; `turned` the current one.
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
    """The CoM `com` (3,) of bodies at a `target` (3,): missing way (3,) and Jacobian (3, nv).

    Args:
        chains: Velocities that move each of b bodies, one after the other, up to its `ends` (b,).
        masses: Mass (b,) of each body; `share` one over their sum.
        centers: Centers (t, 3) of trees; `trees` (b,) that of each body.
        places: CoM (b, 3) of each body.
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
