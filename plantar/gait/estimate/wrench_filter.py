"""Lasting push: low-passed VRP offset (K 19), which stays (K 18) or decays.

With u_w(s) = u_w e^(-s / lasts), constant-offset forms over a horizon T use

    mean(T) = u_w a (1 - e^(-a' T)) / (1 - e^(-w T)),    a' = w + 1 / lasts,  a = w / a'.
"""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.settings.part import Part
from plantar.common.settings.schema import share

MOST_OFFSET = 10.0
"""Derived: largest expected offset in m that is handed on: far beyond what any step makes up for, and small enough that
no product of it with what a pendulum grows by overflows."""


class WrenchFilterRules(Part, table="push_expected", needs={"control.push_estimate": ("soles", "skin")}):
    """How a push goes on.

    Attributes:
        time_constant: Low pass in s (K 19).
        lasts: Expected decay's time constant in s, also without push; 1e6 stays (K 18).
    """

    time_constant: float = share(4.04, "beat", 0, 10)  # nature: K Table 1: alpha = dt / 1 s
    lasts: float = share(1.8, "beat", 0.001, 1e6)  # chosen: 0.45 s on h1: a hand's push lasts from 0.1 to 1 s


class WrenchFilter:
    """Follows the VRP offset by a body wrench and expects its course.

    `omega`: pendulum's in rad/s; `period` of control in s.
    """

    def __init__(self, rules: WrenchFilterRules, omega: float, period: float) -> None:
        self._omega = omega
        # Exact for an offset that is constant over a tick; K 19's alpha is its first order.
        self._share = 1.0 if rules.time_constant == 0.0 else -math.expm1(-period / rules.time_constant)
        self._decay = 1.0 / rules.lasts
        self._ended = max(self._share, -math.expm1(-period / rules.lasts))
        self._x = 0.0
        self._y = 0.0

    @property
    def expected(self) -> NDArray[np.float64]:
        """Expected offset (2,) in m."""
        return np.array((self._x, self._y))

    @property
    def acts(self) -> bool:
        """Whether any push is expected."""
        return self._x != 0.0 or self._y != 0.0

    def update(self, offset: ArrayLike) -> NDArray[np.float64]:
        """Expected offset (2,) in m after a tick (K 19), by the VRP's measured u_w (2,), cut to `MOST_OFFSET`, zero
        where not finite.
        """
        x, y = np.asarray(offset, dtype=float).tolist()
        size = math.hypot(x, y)
        if not math.isfinite(size):
            x = 0.0
            y = 0.0
        elif size > MOST_OFFSET:
            x = x * (MOST_OFFSET / size)
            y = y * (MOST_OFFSET / size)
        share = self._share if x or y else self._ended
        self._x += share * (x - self._x)
        self._y += share * (y - self._y)
        # derived: A low pass never ends by itself. Below a nanometre nothing follows from it any more.
        if x == 0.0 and y == 0.0 and math.hypot(self._x, self._y) < 1e-9:
            self._x = 0.0
            self._y = 0.0
        return self.expected

    def mean(self, horizon: float) -> NDArray[np.float64]:
        """Constant offset (2,) in m that moves the DCM over `horizon` (s) as the expected one."""
        w = self._omega
        faster = self._omega + self._decay
        if horizon == 0.0:
            return self.expected
        kept = (w / faster) * math.expm1(-faster * horizon) / math.expm1(-w * horizon)
        return np.array((kept * self._x, kept * self._y))
