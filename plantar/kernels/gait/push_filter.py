"""Low pass of the disagreement between base and pendulum, which is a push where it is large."""

import math

__all__ = ["PushFilter"]


class PushFilter:
    """Disagreement `x`, `y` in m/s^2, low-passed; `acts`: whether it is a push's.

    `share` of a new value; `begins`: size in m/s^2 above which a push begins; `ends`: below which it ends.
    """

    def __init__(self, share, begins, ends):
        self.share = share
        self.begins = begins
        self.ends = ends
        self.rest()

    def rest(self):
        """Begin again without a disagreement."""
        self.x = 0.0
        self.y = 0.0
        self.acts = False

    def update(self, x, y, pendulum_x, pendulum_y):
        """Take in a tick's accelerations in m/s^2: the base's, and the pendulum's."""
        self.x += self.share * (x - pendulum_x - self.x)
        self.y += self.share * (y - pendulum_y - self.y)
        self.acts = math.hypot(self.x, self.y) > (self.ends if self.acts else self.begins)
