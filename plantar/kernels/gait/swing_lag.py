"""How long a swing foot takes to follow its command.

Drives, their delays and those of encoders make a foot follow by a time tau that no setting states:

    z_measured - z_commanded = o - tau dz_commanded/dt

A swing's rise and fall show tau by least squares; the offset o is of the body above the foot, another one each swing.
What was commanded within the last tau is still to come. A descent that does not count it corrects a distance twice:
with a time constant of 30 ms and a lag of 33 ms it oscillates about the ground instead of touching it.
"""

import numpy as np

__all__ = ["SwingLag"]

# share of what earlier swings showed that counts in the next; chosen: half forgets a wrong swing in two or three
_REMEMBERED = 0.5
# ticks of commands that are kept: a slower foot counts as that slow; chosen: 0.16 s at 200 Hz, beyond any drive's lag
_LONGEST = 32
# leg/beat of root-mean-square speed over a hundred ticks that shows a lag; chosen: 24 mm/s on h1, a tenth of a usual
# swing's
_SHOWN = 0.01


class SwingLag:
    """A swing foot's lag behind its command, by heights.

    `period` of control in s; `speed_unit`: one leg a beat in m/s. Attributes `time`: the lag in s, 0 until it has
    shown; `to_come`: height in m by which the foot still comes down by what is commanded already; negative: up.
    """

    def __init__(self, period: float, speed_unit: float) -> None:
        self.period = period
        self.least = 100.0 * (_SHOWN * speed_unit) ** 2  # derived: the hundred ticks of `_SHOWN`, summed as squares
        self.commands = np.zeros(_LONGEST)
        self.square = 0.0
        self.product = 0.0
        self.begin()

    def begin(self) -> None:
        """A swing begins."""
        self.square *= _REMEMBERED
        self.product *= _REMEMBERED
        self.count = 0
        self.speed = 0.0
        self.error = 0.0
        self.time = 0.0
        self.to_come = 0.0

    def update(self, commanded: float, measured: float) -> None:
        """Add a tick's heights in m: as `commanded` before it, and as `measured` in it."""
        commands = self.commands
        longest = commands.shape[0]
        if self.count > 0:
            # The covariance of speed and error within a swing, whatever their means.
            speed = (commanded - commands[(self.count - 1) % longest]) / self.period
            off = speed - self.speed
            error = measured - commanded
            self.speed += off / self.count
            self.error += (error - self.error) / self.count
            self.square += off * (speed - self.speed)
            self.product += off * (error - self.error)
        commands[self.count % longest] = commanded
        self.count += 1
        self.time = 0.0
        self.to_come = 0.0
        if self.square < self.least:
            return
        ticks = min(max(0.0, -self.product / self.square / self.period), longest - 2.0)
        self.time = ticks * self.period
        whole = int(ticks)
        if whole + 2 > self.count:
            return
        last = self.count - 1 - whole
        before = commands[last % longest]
        before += (ticks - whole) * (commands[(last - 1) % longest] - before)
        self.to_come = before - commanded
