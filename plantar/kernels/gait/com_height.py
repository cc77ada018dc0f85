"""CoM height over ground that goes up and down."""

__all__ = ["CoMHeight"]


class CoMHeight:
    """Foothold height by a critically damped second-order filter.

    A first-order filter starts with speed at each slab: an impact for stiff legs.

    `ground`: initial height in m, then the filtered one; `rate` in m/s; `period` of control in s; `frequency`: natural
    frequency in rad/s.
    """

    # derived: `_FOLLOWS_GROUND` on a leg of 0.6 m
    def __init__(self, ground, period, frequency=8.0):
        self.ground = ground
        self.rate = 0.0
        self.period = period
        self.frequency = frequency

    def update(self, target):
        """Filtered height in m after a tick with `target`, the ground's height in m under the feet."""
        w = self.frequency
        # Damping ratio 1: a step of the ground neither overshoots nor jumps in speed, which the legs would have to
        # follow.
        self.rate += self.period * (w * w * (target - self.ground) - 2.0 * w * self.rate)
        self.ground += self.period * self.rate
        return self.ground
