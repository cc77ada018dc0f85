"""Strip of ground along successive partial footholds, such as a beam."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.body_scale import REFERENCE_BODY, BodyScale
from plantar.layouts.layout import Side

# of a sole's length: 6 and 40 mm of one of 250 mm
_SPREAD = 0.024  # chosen: two of an edge's spread: a strip is seen by two edges of each foothold
_AGREEMENT = 0.16  # chosen: seven spreads


@dataclass
class SupportStrip:
    """Ground's middle line by centroids of partial footholds.

    `origin`: point (2,) on the walk's line in m; `along`: its unit direction (2,); `spread`: standard deviation of a
    foothold's centroid in m; `slope`: standard deviation of the strip's slope to the walk; `agreement`: largest
    distance in m across the walk of footholds on one strip.
    """

    origin: NDArray[np.float64]
    along: NDArray[np.float64]
    spread: float = _SPREAD * REFERENCE_BODY.sole
    slope: float = 0.1  # chosen: 6 degrees, what a strip may turn by against the walk in a step
    agreement: float = _AGREEMENT * REFERENCE_BODY.sole
    memory: int = 6  # chosen: three steps of each foot
    _footholds: list[tuple[int, Side, float, float]] = field(default_factory=list)

    @classmethod
    def for_body(cls, body: BodyScale, origin: NDArray[np.float64], along: NDArray[np.float64]) -> "SupportStrip":
        """Returns a robot's strip, with distances as shares of its soles: its dimensions `body`, a point `origin` (2,)
        on the walk's line in m and its unit direction `along` (2,).
        """
        return cls(origin, along, spread=_SPREAD * body.sole, agreement=_AGREEMENT * body.sole)

    @property
    def across(self) -> NDArray[np.float64]:
        """Unit vector (2,) to the walk's left."""
        return np.array([-self.along[1], self.along[0]])

    @property
    def known(self) -> bool:
        """Whether both feet's footholds lie on a strip."""
        return len(self._footholds) >= 2

    def coordinates(self, point: NDArray[np.float64]) -> tuple[float, float]:
        """A `point` (2,) of the world along the walk and to its left in m."""
        offset = point - self.origin
        return float(offset @ self.along), float(offset @ self.across)

    def clear(self) -> None:
        """Clear the strip: whole or unknown ground."""
        self._footholds.clear()

    def update(self, step: int, side: Side, centroid: NDArray[np.float64]) -> None:
        """Add a partial foothold of a `side` in a `step`, replacing a stored one: `centroid` (2,) of what carries,
        world frame, in m.
        """
        place, lateral = self.coordinates(centroid)
        if self._footholds and self._footholds[-1][0] == step:
            # Found again, and better, in the same stance.
            self._footholds.pop()
        if self._footholds:
            last_step, last_side, _, _ = self._footholds[-1]
            # One foothold has no direction yet: the strip is taken to run along the walk.
            expected = self.lateral(place) if self.known else self._footholds[-1][3]
            if step != last_step + 1 or side == last_side or abs(lateral - expected) > self.agreement:
                self.clear()
        self._footholds.append((step, side, place, lateral))
        del self._footholds[: -self.memory]

    def lateral(self, place: float) -> float:
        """Strip's middle in m left of the walk's line, at a `place` in m along it."""
        places = np.array([f[2] for f in self._footholds])
        laterals = np.array([f[3] for f in self._footholds])
        middle = float(places.mean())
        lever = places - middle
        # Least squares with the slope held by what it is likely to be.
        tilt = float(lever @ laterals) / (float(lever @ lever) + (self.spread / self.slope) ** 2)
        return float(laterals.mean()) + tilt * (place - middle)
