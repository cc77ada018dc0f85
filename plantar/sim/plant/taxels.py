"""True taxels: crosstalk, hysteresis, gains, zeros and loose connectors."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from plantar.layouts.layout import SoleLayout
from plantar.sides import Side
from plantar.sim.plant.draw import TruePlant, stream

__all__ = ["CONNECTORS", "SILENCE", "WARMING", "TaxelErrors"]

CONNECTORS = 4
"""Connectors of a sole: its taxels hang on them from heel to toe, each on as many."""

SILENCE = 0.1
"""Mean time in s for which a connector has no contact once it has lost it."""

WARMING = 60.0
"""Time constant in s with which a sole becomes as warm as the foot in it."""


class TaxelErrors:
    """Errors of one sole's taxels in physical order: the cover spreads a force (crosstalk), the elastic layer rubs
    (hysteresis), and the electronics have a gain, a zero and a connector.

    Hysteresis is play: the reading stays between (1 - h) and (1 + h) times the force until either bound moves it;
    independent of the rate, as that of rubber is at the rates of steps.

    Args:
        layout: The sole.
        plant: The true plant.
        side: Which sole it is.
    """

    def __init__(self, layout: SoleLayout, plant: TruePlant, side: Side) -> None:
        self._spread = _spread(layout, plant.crosstalk)
        self._low, self._high = 1.0 - plant.hysteresis, 1.0 + plant.hysteresis
        self._read = np.zeros(len(layout))
        self._gains, self._drifts = plant.taxel_gains[side], plant.taxel_drifts[side]
        self._loses = plant.dropout / (1.0 - plant.dropout) / SILENCE  # 1/s
        self._chance = stream(plant.seed, f"dropout {side}")
        self._broken = self._chance.random(CONNECTORS) < plant.dropout
        order = np.argsort(np.argsort(layout.positions[:, 0], kind="stable"))  # of each taxel, from heel to toe
        self._bank = order * CONNECTORS // len(layout)
        self._looked: float | None = None

    def felt(self, force: NDArray[np.float64], time: float) -> NDArray[np.float64]:
        """Readings of the taxels.

        Args:
            force: Force (n,) on each taxel in N.
            time: Time in s, never decreasing.

        Returns:
            Reading of each (n,) in N.
        """
        spread = self._spread.dot(force)
        self._read = np.minimum(np.maximum(self._read, self._low * spread), self._high * spread)
        warm = -math.expm1(-max(time, 0.0) / WARMING)
        return np.asarray(self._gains * self._read + warm * self._drifts)

    def silence(self, time: float, *readings: NDArray[np.float64] | None) -> None:
        """Set readings of taxels without contact to NaN.

        A connector loses and finds contact at constant rates, so both states last for exponentially distributed times:
        0.1 s without contact, and with it as long as gives the plant's share.

        Args:
            time: Time in s, never decreasing.
            readings: Readings (n,), changed in place; None for none.
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


def _spread(layout: SoleLayout, crosstalk: float) -> NDArray[np.float64]:
    """Weight (n, n) of each taxel's force in each reading; a taxel without neighbours keeps its own."""
    spread = np.eye(len(layout))
    for i, near in enumerate(layout.neighbours):
        if near:
            spread[i, i] -= crosstalk
            spread[list(near), i] = crosstalk / len(near)
    return spread
