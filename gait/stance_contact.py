"""What a stance foot stands on: the support polygon that its taxels show, from touchdown to lift-off (T 4.4.2-4.4.3).

A single reading is no polygon: noise lights single taxels, and a cell goes dark when the ZMP moves away from it though
the ground under it is still there. So loads are gathered from touchdown on: a taxel that has carried in this stance
belongs to the foothold until lift-off. The foothold counts as settled once the foot has carried for a few readings,
and is refined while more load comes on.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.errors import InputError
from plantar.layout import SoleLayout
from plantar.partial_contact import PartialContact
from plantar.polygon import area, centroid, signed_margin
from plantar.reading import Reading

__all__ = ["ContactSettings", "StanceContact"]


@dataclass(frozen=True)
class ContactSettings:
    """How a foothold is found from the taxels.

    Attributes:
        minimum_load: Vertical force in N from which a foot's taxels tell what it stands on.
        settle_readings: Readings with that load before the foothold counts.
        taxel_noise: Standard deviation of a taxel's noise in N.
        smoothing: Share of a new reading in the running mean that decides whether a taxel has carried.
        forgetting: Share of the old in the running sum that edges are fitted to.
        least_expected: Force in N that the ground believed in would put on a taxel, from which its silence tells.
        least_share: Share of that force below which a taxel is silent.
        least_margin: Distance in m of the load from the believed polygon's edge, from which silence tells.
        least_wrong: Share of the load that silent taxels should carry, from which the belief is wrong.
        least_force: Running mean in N from which a taxel has carried.
        full_ratio: Share of the sole from which on the foothold counts as the whole sole.
        subcell: Whether edges are found finer than a cell; else the polygon of cell corners counts (T 4.24).
        fit_every: Readings between two fits.
        least_move: Distance in m by which the centroid has to differ from the plan's VRP before the plan is moved.
    """

    minimum_load: float = 90.0
    settle_readings: int = 3
    taxel_noise: float = 1.5
    smoothing: float = 0.3
    forgetting: float = 0.92
    least_expected: float = 5.0
    least_share: float = 0.3
    least_margin: float = 0.03
    least_wrong: float = 0.1
    least_force: float = 3.5
    full_ratio: float = 0.93
    subcell: bool = True
    fit_every: int = 2
    least_move: float = 0.003

    def __post_init__(self) -> None:
        for item in fields(self):
            value = getattr(self, item.name)
            if not (isinstance(value, int | float) and 0.0 <= value < 1e6):
                raise InputError(f"contact setting '{item.name}' is {value!r}; allowed: a finite number, 0 or more")

    @classmethod
    def from_table(cls, table: Mapping[str, Any]) -> ContactSettings:
        """Settings from a table's keys that name one; other keys are left alone."""
        names = {item.name for item in fields(cls)}
        return cls(**{k: v for k, v in table.items() if k in names})


class StanceContact:
    """Support of one foot over its stance.

    Args:
        layout: Its sole, n taxels.
        settings: Settings.
    """

    def __init__(self, layout: SoleLayout, settings: ContactSettings) -> None:
        self.layout = layout
        self.settings = settings
        self._fit = PartialContact(layout)
        self._whole_area = area(layout.outline)
        self.lift()

    def lift(self) -> None:
        """The foot leaves the ground: forget what it stood on."""
        n = len(self.layout)
        self.settled = False
        self.polygon_in_sole: NDArray[np.float64] = self.layout.outline
        self.area_ratio = 1.0
        self._mean = np.zeros(n)
        self._carried = np.zeros(n, dtype=bool)
        self._sum = np.zeros(n)
        self._weight = 0.0
        self._count = 0
        self._idle = np.zeros(n, dtype=bool)
        self._time = -1.0
        self._fit.reset()

    @property
    def whole(self) -> bool:
        """Whether, as far as known, the whole sole is supported."""
        return self.polygon_in_sole is self.layout.outline

    @property
    def center_in_sole(self) -> NDArray[np.float64]:
        """Centroid (2,) of the support polygon in the sole frame in m."""
        found = centroid(self.polygon_in_sole)
        assert found is not None
        return found

    def update(self, reading: Reading, load: float) -> bool:
        """Take the latest reading in.

        Args:
            reading: The sole's latest reading.
            load: Vertical force on the foot in N.

        Returns:
            Whether the foothold has just settled or become another.
        """
        s = self.settings
        if reading.time <= self._time or load < s.minimum_load:
            return False
        self._time = reading.time
        force = np.nan_to_num(reading.force, nan=0.0, posinf=0.0)
        self._count += 1
        self._sum = s.forgetting * self._sum + force
        self._weight = s.forgetting * self._weight + 1.0
        share = s.smoothing if self._count > 1 else 1.0
        self._mean += share * (force - self._mean)
        if self._count >= s.settle_readings:
            self._carried |= self._mean > s.least_force
        after = self._count - s.settle_readings
        if after < 0 or (after % s.fit_every and after > 2):
            return False
        return self._find()

    def _find(self) -> bool:
        """Compare what the taxels read with what they would on the ground that is believed in; change the belief."""
        s = self.settings
        mean = self._sum / self._weight
        load = float(mean.sum())
        cop = (mean @ self.layout.positions[:, :2]) / load
        edges = self._fit.edges
        lines = np.empty((0, 3)) if edges is None else edges.lines
        expected = self._fit.expected(load, cop, lines)
        noise = s.taxel_noise / self._weight**0.5
        # A load near the edge lifts the rest off, whether there is ground or not: only a load well inside tells.
        polygon = self.polygon_in_sole
        around = float(np.hypot(*(np.roll(polygon, -1, axis=0) - polygon).T).sum())
        telling = signed_margin(polygon, cop) > min(s.least_margin, 0.8 * area(polygon) / around)
        missing = (expected > s.least_expected) & (mean < s.least_share * expected) & ~self._carried
        outside = self._carried & (self._fit.cover(lines)[:, 0] < 0.1 * self.layout.areas)
        wrong = telling and float(expected[missing].sum()) > s.least_wrong * load and int(missing.sum()) >= 2
        first = not self.settled
        self.settled = True
        if not wrong and not (outside.any() and len(lines)) and not len(lines):
            return first
        self._idle = (self._idle | missing) & ~self._carried if wrong else self._idle & ~self._carried
        found = self._fit.update(mean, self._carried, noise, steps=4 if wrong or outside.any() else 1, idle=self._idle)
        polygon = found.polygon if s.subcell else self._fit.hull_of(self._carried)
        if len(polygon) < 3:
            return first
        ratio = area(polygon) / self._whole_area
        if ratio > s.full_ratio or not len(found.lines):
            polygon, ratio = self.layout.outline, 1.0
        changed = polygon is not self.polygon_in_sole
        self.area_ratio, self.polygon_in_sole = ratio, polygon
        return first or changed
