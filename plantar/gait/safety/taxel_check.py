"""Leaves out single taxels that report what no taxel of a sole can carry."""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.common.gravity import GRAVITY
from plantar.common.sides import SIDES, Side
from plantar.gait.plan.phases import UP, Phase
from plantar.kernels.safety.plausible import SoleCheck
from plantar.kernels.safety.taxel_watch import TaxelWatch
from plantar.layouts.layout import SoleLayout
from plantar.sensing.reading import Reading

# measured: weight, and share of what the accelerometer shows, that both soles report of a robot that walks; by the
# gains of their taxels, those of drawn plants of level 3 reach 1.54 on two corners
_HEAVY = 1.7
# measured: weight that they report without the taxel; one corner of a real foothold carries up to 0.8 alone
_REST = 0.75
_MOST = 0.15  # chosen: weight on a taxel that is not looked at; a flat sole of 42 has 0.024 each
_ALONE = 4.0  # chosen: times its neighbours' forces, as none of a flat or tilted sole has
_CONFIRMED = 0.04  # chosen: s; impacts are shorter
AIR = 0.02  # derived: weight on a taxel in the air, or that pulls: ten times the noise of an H1's
_AIR_FOR = 0.06  # measured: s; a swing whose foot touches something early ends within 0.03 s
_FEW = 0.1  # chosen: share of a sole's taxels; more of them that report in the air touch something
# of the weight on the other foot while one is up; chosen: bounded by a half, which two feet carry each; +-20 % changes
# none of 20 faults of taxels
_CARRIED = 0.7

Readings = Mapping[Side, Reading]


class TaxelCheck:
    """Finds taxels to leave out, and takes them out of readings.

    Args:
        layouts: Of each side.
        weight: Robot's in N.
        period: Of control in s.

    Attributes:
        found: What was left out at the last tick and not before, in words.
        count: Taxels that are left out.
        ids: Of each side's taxels.
    """

    def __init__(self, layouts: Mapping[Side, SoleLayout], weight: float, period: float) -> None:
        self.ids = {side: layouts[side].ids for side in SIDES}
        self._watches = {side: _watch(layouts[side], weight, period) for side in SIDES}
        self._weight = weight
        self._named: dict[Side, set[int]] = {side: set() for side in SIDES}
        self.found = ""
        self.count = 0
        self._looked = False

    def checked(
        self,
        readings: Readings,
        soles: SoleCheck,
        accelerometer: NDArray[np.float64],
        phase: Phase,
        time: float,
    ) -> Readings:
        """Readings without the taxels that are left out: the same object where none is.

        `soles`: what they reported a tick ago; `accelerometer` (3,) in m/s^2; `phase` of the walk; `time` of the plan
        in s.
        """
        weight = self._weight
        swing = phase.swing
        if swing is not None:
            share = (time - phase.start) / (phase.end - phase.start)
            carried = soles.left if swing == "right" else soles.right
            if not UP[0] < share < UP[1] or carried < _CARRIED * weight:
                swing = None
        load = soles.left + soles.right
        looks = swing is not None or load > _HEAVY * weight or soles.left_pulls >= 0 or soles.right_pulls >= 0
        if not looks and not self._looked and not self.count:  # there is nothing to look at, nor to end
            return readings
        self._looked = looks
        spare = 0.0
        if load > _HEAVY * weight and load > _HEAVY * weight / GRAVITY * math.hypot(*accelerometer.tolist()):
            spare = load - _REST * weight
        left = self._watches["left"]
        right = self._watches["right"]
        changed = left.update(readings["left"].force, spare, swing == "left", soles.left_pulls)
        changed |= right.update(readings["right"].force, spare, swing == "right", soles.right_pulls)
        if changed:
            self.count = left.count + right.count
            self._name(readings)
        if not left.count and not right.count:
            return readings
        return {"left": _without(readings["left"], left), "right": _without(readings["right"], right)}

    def _name(self, readings: Readings) -> None:
        """Put what is left out for the first time in words."""
        words = []
        for side in SIDES:
            for i in np.flatnonzero(self._watches[side].out):
                if i not in self._named[side]:
                    self._named[side].add(int(i))
                    force = readings[side].force[i]
                    words.append(f"taxel {self.ids[side][i]} of the {side} sole left out: it reads {force:.0f} N")
        self.found = "; ".join(words)


def _watch(layout: SoleLayout, weight: float, period: float) -> TaxelWatch:
    starts = np.cumsum([0, *map(len, layout.neighbours)])
    others = [j for row in layout.neighbours for j in row]
    return TaxelWatch(
        starts,
        others,
        _MOST * weight,
        _ALONE,
        max(1, round(_CONFIRMED / period)),
        AIR * weight,
        max(1, round(_AIR_FOR / period)),
        max(1, round(_FEW * len(layout))),
    )


def _without(reading: Reading, watch: TaxelWatch) -> Reading:
    """A reading whose left-out taxels read NaN, as dead ones do."""
    if not watch.count or len(reading.force) != len(watch.out):
        return reading
    force = np.where(watch.out > 0.0, np.nan, reading.force)
    return Reading(reading.time, force, reading.proximity, reading.temperature, reading.acceleration)
