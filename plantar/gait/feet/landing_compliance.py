"""After touchdown a foot turns until the ground carries it evenly (T 4.4.1, Fig. 49-d; damping of Caron et al. 2019).

    w = A ((p - c) x f),     [w_x, w_y] = A f_z [p_y - c_y, -(p_x - c_x)]

c is the sole's centre while a line of cells carries, then the centroid of what carries.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from plantar.settings.schema import Settings, number, share

__all__ = ["DampingGains", "LandingCompliance"]


class DampingGains(Settings):
    """Gains of foot damping at touchdown.

    Attributes:
        admittance: A in rad/s for each N m.
        largest_rate: Largest rate in rad/s.
        largest_turn: Largest turn in rad, the error of a levelled sole.
        largest_force: Vertical force in N from which the foot carries the body and no longer yields.
    """

    admittance: float = share(0.241, "rad/beat/weight/sole", 0, 10)
    largest_rate: float = share(0.0247, "rad/beat", 0, 10)
    largest_turn: float = number(0.004, "rad", 0, 0.5)
    largest_force: float = share(0.415, "weight", 0, 100000)


@dataclass
class LandingCompliance:
    """Turn of one landed foot.

    Attributes:
        period: Control period in s.
        gains: Gains.
        turn: Turn (2,) about the sole's x and y axes in rad.
    """

    period: float
    gains: DampingGains = field(default_factory=DampingGains)
    turn: NDArray[np.float64] = field(default_factory=lambda: np.zeros(2))

    def reset(self) -> None:
        """The foot lifts off: the next landing begins level."""
        self.turn = np.zeros(2)

    def update(self, force: float, center_of_pressure: NDArray[np.float64], target: NDArray[np.float64]) -> None:
        """One control tick of a loaded foot.

        Args:
            force: Vertical force on it in N.
            center_of_pressure: Where that acts (2,) in the sole frame in m.
            target: Where it should act (2,) in the sole frame in m.
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
        """One control tick of a foot that comes down, or has just landed: turn it parallel to the expected ground.

        Args:
            force: Vertical force on it in N.
            slope: Rise of the sole against that ground (2,) along its x and y axes in m/m.
            gain: Rate of the turn for a slope of 1 in 1/s.
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
