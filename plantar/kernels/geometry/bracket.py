# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
# cython: infer_types=True
"""Kernel that closes a bracket of three angles around a summit.

Plain Python that also compiles ahead of time (`bracket.pxd` gives the C types). `any_angle` climbs with it.
"""

from __future__ import annotations

import math

__all__ = ["Bracket"]

_GOLDEN = 0.3819660112501051
_PARABOLA, _CROSSING, _BESIDE, _SECTION = range(4)  # ways to a summit
_SLACK = 1e-7  # share of the area that a summit may stand higher than what is taken for it
_ASIDE = 0.02  # share of a bracket that a summit is looked for beside where it is known
_INF = math.inf


class Bracket:
    """Three angles, the middle one of the largest area, and the ones beyond them; the next angle to look at.

    The summit of the parabola through the three is tried first; where that does not halve the bracket, the crossing of
    the slopes on both sides, as edges that take over from each other make one, as long as it comes closer to what it
    promises; then a golden section. A summit that comes out as promised is looked at once more from beside, if the
    slopes were known from afar only.

    Attributes:
        at: Middle angle in rad; mine its area, the largest so far.
        low: Angle on the side that the climb came from; high the one ahead, which may be the smaller one. Theirs are
            the areas at_low and at_high.
        angle: Angle to look at next, as `propose` leaves it.
    """

    def __init__(self):
        self.low = self.at_low = self.beyond_low = self.at_beyond_low = 0.0
        self.at = self.mine = 0.0
        self.high = self.at_high = self.beyond_high = self.at_beyond_high = 0.0
        self.angle = self.promised = self.summit = self.width = 0.0
        self.missed = _INF
        self.steep = 1.0
        self.way = _PARABOLA

    def begin(self, low, at_low, at, mine):
        """Begin uphill: from one angle to one of more area."""
        self.low = self.beyond_low = low
        self.at_low = self.at_beyond_low = at_low
        self.at = at
        self.mine = mine

    def stride(self, angle, area):
        """Go on to an angle of more area, in the same direction."""
        self.beyond_low = self.low
        self.at_beyond_low = self.at_low
        self.low = self.at
        self.at_low = self.mine
        self.at = angle
        self.mine = area

    def close(self, angle, area):
        """End uphill: an angle in the same direction that has no more area."""
        self.high = self.beyond_high = angle
        self.at_high = self.at_beyond_high = area
        self.way = _PARABOLA
        self.missed = _INF
        self.steep = 1.0

    def is_closed(self, least):
        """Whether it is narrower than an angle in rad, or so flat that nothing is left to find."""
        self.width = abs(self.high - self.low)
        return self.width < least or self.mine - min(self.at_low, self.at_high) < _SLACK * self.mine

    def propose(self):
        """Choose the angle to look at next."""
        far = self.high if abs(self.high - self.at) > abs(self.at - self.low) else self.low
        self.angle = self.at + _GOLDEN * (far - self.at)
        self.promised = self.summit = 0.0
        if self.way == _PARABOLA:
            self._parabola()
        elif self.way == _CROSSING and self.beyond_low != self.low and self.beyond_high != self.high:
            self._crossing()
        elif self.way == _BESIDE:
            least = min(_SLACK * self.mine / self.steep, 0.5 * abs(self.angle - self.at))
            self.angle = self._aside(least)

    def _aside(self, least):
        """An angle so far from the middle one, in the wider half."""
        return self.at + (least if self.high - self.at > self.at - self.low else -least)

    def _parabola(self):
        """The summit of the parabola through the three angles."""
        p = (self.at_low - self.mine) / (self.low - self.at)
        q = (self.at_high - self.mine) / (self.high - self.at)
        bend = (p - q) / (self.low - self.high)
        p -= bend * (self.low - self.at)
        if bend < 0.0:
            trial = self.at - 0.5 * p / bend
            self.summit = self.mine - 0.25 * p * p / bend
            least = _ASIDE * self.width  # beside where it is known already
            if abs(trial - self.at) < least:
                trial = self._aside(least)
            if min(self.low, self.high) < trial < max(self.low, self.high):
                self.angle = trial
                self.promised = self.mine + (p + bend * (trial - self.at)) * (trial - self.at)

    def _crossing(self):
        """Where the slopes on both sides meet."""
        p = (self.at_low - self.at_beyond_low) / (self.low - self.beyond_low)
        q = (self.at_high - self.at_beyond_high) / (self.high - self.beyond_high)
        here = self.at_low + p * (self.at - self.low)
        there = self.at_high + q * (self.at - self.high)
        if abs(here - self.mine) < abs(there - self.mine):  # which of the two slopes it stands on
            here = self.mine
            p = (self.mine - self.at_low) / (self.at - self.low)
            there = self.at_high + q * (self.at - self.high)
        else:
            there = self.mine
            q = (self.mine - self.at_high) / (self.at - self.high)
        if p != q:
            trial = self.at + (there - here) / (p - q)
            if min(self.low, self.high) < trial < max(self.low, self.high) and trial != self.at:
                self.angle = trial
                self.promised = here + p * (trial - self.at)
                self.summit = self.promised
                self.steep = max(abs(p), abs(q))

    def take(self, area):
        """Take the area at the proposed angle.

        Returns:
            Whether the summit is known: it came out as promised.
        """
        angle = self.angle
        beyond = (angle > self.at) == (self.high > self.at)
        if area > self.mine:
            if beyond:
                self.stride(angle, area)
            else:
                self.beyond_high = self.high
                self.at_beyond_high = self.at_high
                self.high = self.at
                self.at_high = self.mine
                self.at = angle
                self.mine = area
        elif beyond:
            self.beyond_high = self.high
            self.at_beyond_high = self.at_high
            self.high = angle
            self.at_high = area
        else:
            self.beyond_low = self.low
            self.at_beyond_low = self.at_low
            self.low = angle
            self.at_low = area
        return self._is_known(area)

    def _is_known(self, area):
        """Whether the summit is known; if not, which way to it comes next."""
        gap = abs(self.promised - area)
        if self.way == _BESIDE:
            if area < self.mine:
                return True
            self.way = _SECTION
        elif gap < 0.1 * _SLACK * self.mine and self.summit < (1.0 + _SLACK) * self.mine:
            if self.way == _PARABOLA:
                return True
            self.way = _BESIDE  # a slope that is known from afar only may rise on
        elif self.way == _CROSSING and self.promised > 0.0:
            self.way = _CROSSING if gap < 0.25 * self.missed else _SECTION
            self.missed = gap
        elif abs(self.high - self.low) <= 0.5 * self.width:
            self.way = _PARABOLA
        elif self.way == _PARABOLA:
            self.way = _CROSSING
            self.missed = _INF
        else:
            self.way = _PARABOLA
        return False
