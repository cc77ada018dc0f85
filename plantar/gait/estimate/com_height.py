"""CoM height over ground that goes up and down."""


class CoMHeight:
    """Foothold height by a critically damped second-order filter.

    A first-order filter starts with speed at each slab: an impact for stiff legs.

    `ground`: initial height in m; `period` of control in s; `frequency`: natural frequency in rad/s.
    """

    # derived: `_FOLLOWS_GROUND` on a leg of 0.6 m
    def __init__(self, ground: float, period: float, frequency: float = 8.0) -> None:
        self.ground = ground
        self.rate = 0.0
        self._period = period
        self._frequency = frequency

    def update(self, target: float) -> float:
        """Filtered height in m after a tick with `target`, the ground's height in m under the feet."""
        w = self._frequency
        # Damping ratio 1: a step of the ground neither overshoots nor jumps in speed, which the legs would have to
        # follow.
        self.rate += self._period * (w * w * (target - self.ground) - 2.0 * w * self.rate)
        self.ground += self._period * self.rate
        return self.ground
