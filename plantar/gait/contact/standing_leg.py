"""How high a leg has to stand for its knee to carry the weight, and how far it reaches from there.

With the hip above the ZMP p and the ankle at a, a height h apart, the knee is a share s of the way from a to p, and k
ahead of that line:

    s = (h^2 + shank^2 - thigh^2) / (2 h^2),     k = sqrt(shank^2 - (s h)^2)

The weight's lever about it is |p - (a + s (p - a) + k)|. A p behind the ankle, on a heel, has the longest one, which
shrinks as the robot stands higher and its knee comes back. A leg that swings reaches a place d away over the ground
with its hip at most sqrt((0.985 (thigh + shank))^2 - d^2) above the ankle there.
"""

import math
from typing import NamedTuple

# derived: Of thigh and shank that a leg stretches to, cos(10 degrees): the knee of equal ones keeps 20 degrees from
# straight.
_STRETCHED = 0.985
_HALVINGS = 12  # derived: of the rise, whose largest is some hundredths of a leg: to a hundredth of a millimetre
# chosen: of the way from ankle to hip that a standing leg comes down at most: below it no knee of a biped bears
_LOWEST = 0.5


class StandingLeg(NamedTuple):
    """A leg of three pitching joints, as it stands in a walk.

    Attributes:
        thigh: Length in m.
        shank: Length in m.
        apart: Hip above the ankle in m.
        rise: How much higher it may stand in m.
        ankle: Along the sole from its origin in m.
        ahead: 1 for a knee ahead of hip and ankle, -1 for one behind.
        lever: Of the weight, in m, at the knee's torque limit.
        high: Ankle above the sole in m.
        aside: Hip from the body's middle in m.
        hip: In the torso's frame (x, y, z) in m.
    """

    thigh: float
    shank: float
    apart: float
    rise: float
    ankle: float
    ahead: float
    lever: float
    high: float
    aside: float
    hip: tuple[float, float, float]

    def strip(self, rise: float = 0.0) -> tuple[float, float]:
        """Returns middle and half width in m, along the sole, of where the knee bears the weight, standing higher by
        `rise` in m.
        """
        apart = max(self.apart + rise, 1e-6)  # nature: floating point: no division by 0
        foot = (apart**2 + self.shank**2 - self.thigh**2) / (2.0 * apart)
        share = foot / apart
        knee = math.sqrt(max(self.shank**2 - foot**2, 0.0))
        return self.ankle + self.ahead * knee / (1.0 - share), self.lever / (1.0 - share)

    def rise_for(self, place: float, share: float) -> float:
        """Returns the least rise in m at which the weight at a `place` along the sole in m takes no more than a `share`
        of the knee's limit; all that there is if none does.
        """

        return 0.0 if self._bears(place, share, 0.0) else self._least(place, share, 0.0)

    def lowest_for(self, place: float, share: float) -> float:
        """Returns the least rise in m, negative for lower, as in `rise_for`, but below where it walks, too."""
        return self._least(place, share, -_LOWEST * self.apart)

    def _bears(self, place: float, share: float, rise: float) -> bool:
        middle, half = self.strip(rise)
        return abs(place - middle) <= share * half

    def _least(self, place: float, share: float, low: float) -> float:
        """Least rise in m from a `low` one on at which the knee bears the weight."""
        high = self.rise
        for _ in range(_HALVINGS):
            rise = 0.5 * (low + high)
            if self._bears(place, share, rise):
                high = rise
            else:
                low = rise
        return high

    def spread(self, aside: float, rise: float) -> float:
        """Returns how far ahead of the body in m the ankle reaches level ground, `aside` of the body's middle in m,
        standing higher by `rise` in m.
        """
        return self._left(math.hypot(self.apart + rise, max(aside - self.aside, 0.0)))

    def tallest(self, away: float) -> float:
        """Returns how high in m above the sole the hip is at most, `away` in m over the ground from the ankle there."""
        return self._left(away) + self.high

    def _left(self, length: float) -> float:
        """What a stretched leg in m reaches at right angles to a `length` in m."""
        long = _STRETCHED * (self.thigh + self.shank)
        return math.sqrt(max(long**2 - length**2, 0.0))
