"""A periodic walk of the pendulum: DCM and feet at the moment of a push."""

import math
from dataclasses import dataclass

import numpy as np
from capture_limit import CaptureLimits, Instant, capture_limit, mirrored
from numpy.typing import NDArray

from plantar.common.sides import Side
from plantar.errors import InputError
from plantar.mechanics.easing import minimum_jerk


@dataclass(frozen=True)
class PeriodicWalk:
    """Steps of one length and one duration, or steps in place. A step begins with its double support.

    Attributes:
        omega: Pendulum frequency in rad/s.
        length: Way of a foot ahead of the other one in m; 0 in place.
        width: Distance in m between the feet's lines.
        single: Duration of a single support in s, above 0.
        double: Duration of a double support in s; the ZMP moves at constant speed.
        zmp: ZMP under the left foot alone (2,) in m; mirrored under the right one.
    """

    omega: float
    length: float
    width: float
    single: float
    double: float
    zmp: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        if not (self.omega > 0.0 and self.single > 0.0 and self.double >= 0.0):
            raise InputError(
                f"omega, single and double are {self.omega}, {self.single} and {self.double}; "
                "allowed: above 0, above 0, 0 or more"
            )

    def instant(self, phase: float, side: Side = "left") -> Instant:
        """The walk at a `phase` of a step, 0 to 1 from its double support on, whose single support is on a `side`."""
        if not 0.0 <= phase <= 1.0:
            raise InputError(f"phase of a step is {phase}; allowed: 0 to 1")
        flip = np.array((1.0, 1.0 if side == "left" else -1.0))
        time = phase * (self.single + self.double)
        before = np.array((-self.length, -self.width))
        if time < self.double:
            dcm, swing, elapsed, left = self._swayed(time), before, 0.0, self.double - time
            velocity = np.zeros(2)
        else:
            elapsed, left = time - self.double, 0.0
            zmp = np.array(self.zmp)
            dcm = zmp + math.exp(self.omega * elapsed) * (self._begin() - zmp)
            after = np.array((self.length, -self.width))
            share, rate = minimum_jerk(elapsed / self.single)
            swing, velocity = before + share * (after - before), rate / self.single * (after - before)
        return Instant(side, dcm * flip, swing * flip, elapsed, left, velocity * flip)

    def _begin(self) -> NDArray[np.float64]:
        """DCM (2,) at the begin of the left foot's single support, from that foot."""
        zmp, step = np.array(self.zmp), np.array((self.length, -self.width))
        last = step + mirrored(self.zmp)
        w = self.omega
        by_single, by_double = math.exp(w * self.single), math.exp(w * self.double)
        # Over both supports xi_a becomes fixed + grown xi_a, and less the step that is xi_a with y turned round.
        fixed = by_double * zmp * (1.0 - by_single)
        if self.double > 0.0:
            ahead = (last - zmp) / (self.double * w)
            fixed += last + ahead - by_double * (zmp + ahead)
        return np.asarray((step - fixed) / (by_single * by_double - np.array((1.0, -1.0))))

    def _swayed(self, time: float) -> NDArray[np.float64]:
        """DCM (2,) in the double support before, from the left foot."""
        first = np.array((-self.length, -self.width)) + mirrored(self.zmp)
        speed = (np.array(self.zmp) - first) / self.double
        now, end = first + speed * time, np.array(self.zmp)
        back = math.exp(self.omega * (time - self.double))
        return np.asarray(now + speed / self.omega + back * (self._begin() - end - speed / self.omega))


def capture_map(
    limits: CaptureLimits, walk: PeriodicWalk, directions: int = 8, phases: int = 8, side: Side = "left"
) -> NDArray[np.float64]:
    """Largest captured impulses (phases, directions) in N s of a walk, from forward to the left and round."""
    if walk.omega != limits.omega:
        raise InputError(f"pendulum frequency of the walk is {walk.omega} rad/s, that of the limits {limits.omega}")
    angles = 2.0 * math.pi * np.arange(directions) / directions
    return np.array(
        [
            [capture_limit(limits, walk.instant(k / phases, side), (math.cos(a), math.sin(a))).impulse for a in angles]
            for k in range(phases)
        ]
    )
