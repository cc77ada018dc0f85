"""True taxels: crosstalk, hysteresis, gains, zeros, loose connectors."""

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side
from plantar.layouts.layout import SoleLayout
from plantar.sensing.taxel_faults import TaxelFaults, WornFaults
from plantar.sim.plant.draw import TruePlant, stream

CONNECTORS = 4
"""Connectors of a sole: its taxels hang on them from heel to toe, each on as many."""

SILENCE = 0.1
"""Mean time in s for which a connector has no contact once it has lost it."""


class TaxelErrors:
    """One sole's taxel errors (`plantar.sensing.taxel_faults`) and loose connectors."""

    def __init__(self, layout: SoleLayout, plant: TruePlant, side: Side) -> None:
        faults = TaxelFaults(hysteresis=plant.hysteresis, crosstalk=plant.crosstalk)
        self._faults = WornFaults(layout, faults, plant.taxel_gains[side], 0.0, plant.taxel_drifts[side])
        self._loses = plant.dropout / (1.0 - plant.dropout) / SILENCE  # 1/s
        self._chance = stream(plant.seed, f"dropout {side}")
        self._broken = self._chance.random(CONNECTORS) < plant.dropout
        order = np.argsort(np.argsort(layout.positions[:, 0], kind="stable"))  # of each taxel, from heel to toe
        self._bank = order * CONNECTORS // len(layout)
        self._looked: float | None = None

    def read(self, force: NDArray[np.float64], time: float) -> NDArray[np.float64]:
        """Returns the readings (n,) in N of `force` (n,) in N at `time` in s, never decreasing."""
        return self._faults.read(time, force)

    def silence(self, time: float, *readings: NDArray[np.float64] | None) -> None:
        """Set `readings` (n,) of taxels without contact at `time` in s, never decreasing, to NaN.

        Connectors lose and find contact at constant rates: 0.1 s without it, by the plant's share.
        """
        if not self._loses:
            return
        passed = 0.0 if self._looked is None else time - self._looked
        self._looked = time
        rate = np.where(self._broken, 1.0 / SILENCE, self._loses)
        self._broken = self._broken ^ (self._chance.random(CONNECTORS) < -np.expm1(-rate * passed))
        silent = self._broken[self._bank]
        for reading in readings:
            if reading is not None:
                reading[silent] = np.nan
