"""After touchdown a foot turns until evenly carried (T 4.4.1, Fig. 49-d; damping of Caron et al. 2019).

    w = A ((p - c) x f),     [w_x, w_y] = A f_z [p_y - c_y, -(p_x - c_x)]

c is the sole's center while a line of cells carries, then the carrying part's centroid.
"""

import math
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import Settings, fixed


class DampingGains(Settings):
    """Foot damping at touchdown."""

    # A in rad/s per N m; chosen: bounded by the delay of 20 ms
    admittance: float = fixed(0.261, "rad/beat/weight/sole")
    largest_rate: float = fixed(0.0247, "rad/beat")  # Largest rate of a turn; chosen: 0.1 rad/s
    largest_turn: ClassVar[float] = 0.004  # derived: Largest turn in rad: the error of a levelled sole
    # Rate in 1/s at which it ends in the air; chosen: 33 1/s: gone in a tenth of a swing
    release: float = fixed(8.24, "1/beat")
    # Vertical force in N of a foot that carries the body and no longer yields
    largest_force: float = fixed(0.415, "weight")  # chosen: 350 N on h1, before the foot carries half of the weight


@dataclass
class LandingCompliance:
    """Turn of a landed foot. `period` of control in s; `turn` (2,) about the sole's x and y axes in rad."""

    period: float
    gains: DampingGains = field(default_factory=DampingGains)
    turn: NDArray[np.float64] = field(default_factory=lambda: np.zeros(2))

    def fade(self) -> None:
        """A tick in the air: the next landing begins level."""
        self.turn = self.turn * (1.0 - min(1.0, self.gains.release * self.period))

    def update(self, force: float, center_of_pressure: NDArray[np.float64], target: NDArray[np.float64]) -> None:
        """A tick of a loaded foot.

        `force`: vertical on it in N; `center_of_pressure` (2,), sole frame, in m; `target`: its wanted place (2,), sole
        frame, in m.
        """
        # The foot carries the body now: turning it would push the body, and its edge no longer hides the ground.
        g = self.gains
        if force > g.largest_force:
            return
        dx, dy = (center_of_pressure - target).tolist()
        gain = g.admittance * force
        # A moment about x lies along y: the turn is the lever rotated by a quarter.
        self._turn(np.array([gain * dy, -gain * dx]))

    def level(self, force: float, slope: NDArray[np.float64], gain: float) -> None:
        """A tick of a foot landing or just landed: turn it parallel to expected ground.

        `force`: vertical on it in N; `slope`: sole's rise against it (2,) along x, y in m/m; `gain`: turn rate for a
        slope of 1 in 1/s.
        """
        if force > self.gains.largest_force:
            return
        # A turn about x raises what lies along y, one about y lowers what lies along x.
        self._turn(gain * np.array([-slope[1], slope[0]]))

    def _turn(self, rate: NDArray[np.float64]) -> None:
        g = self.gains
        size = math.hypot(*rate.tolist())
        if size > g.largest_rate:
            rate = rate * (g.largest_rate / size)
        turn = self.turn + self.period * rate
        size = math.hypot(*turn.tolist())
        self.turn = turn if size <= g.largest_turn else turn * (g.largest_turn / size)
