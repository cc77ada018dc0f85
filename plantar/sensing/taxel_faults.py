"""Errors of real taxels, one model for simulations, `plantar.mujoco.Skin` and recordings.

In this order: shear reads as normal force, crosstalk to neighbours, hysteresis, delay, gain, a zero (offset) that
drifts with warmth, noise, steps (resolution), dead taxels.
"""

import math
from collections import deque
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import number
from plantar.common.arrays import array
from plantar.errors import InputError, ReadingError
from plantar.layouts.layout import SoleLayout
from plantar.mechanics.same_time import SAME_TIME
from plantar.sensing.link_skin import SkinPatch

WARMING = 60.0
"""Time constant in s with which a sole becomes as warm as the foot in it."""

_GAIN_MOST = 0.9  # either way of a taxel's gain of 1: a taxel that reads nothing is dead, which is another fault
_SHARES = ("crosstalk", "hysteresis", "dead", "shear")


@dataclass(frozen=True)
class TaxelFaults:
    """Error sizes of a kind of skin, from which taxels' faults are drawn; 0 is none.

    Attributes:
        gain: Standard deviation of gains about 1.
        offset: Standard deviation in N of zeros.
        drift: Standard deviation in N of zeros' drift within minutes.
        hysteresis: Share by which it reads too little under rising load, too much under falling.
        crosstalk: Share of each taxel's force that its neighbours read instead, in equal parts.
        dead: Share of dead taxels, which read NaN.
        shear: Share of tangential force that a taxel reads as normal force.
        noise: Standard deviation in N of white noise.
        resolution: Step in N of readings.
        delay: Time in s from a force to its reading.

    Example:
        >>> from plantar import hex_layout
        >>> layout = hex_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]])
        >>> worn = TaxelFaults(gain=0.1, resolution=0.5).worn(layout, seed=1)
        >>> read = worn.read(0.0, np.full(len(layout), 10.0))
        >>> bool((read % 0.5 == 0.0).all()), bool(0.5 < read.std() < 2.0)
        (True, True)
    """

    gain: float = 0.0
    offset: float = 0.0
    drift: float = 0.0
    hysteresis: float = 0.0
    crosstalk: float = 0.0
    dead: float = 0.0
    shear: float = 0.0
    noise: float = 0.0
    resolution: float = 0.0
    delay: float = 0.0

    def __post_init__(self) -> None:
        for field in fields(self):
            value = number(getattr(self, field.name), f"taxel fault '{field.name}'", finite=True)
            most = 0.9 if field.name in _SHARES else math.inf
            if not 0.0 <= value <= most:
                raise InputError(f"taxel fault '{field.name}' is {value:g}; allowed: 0 to {most:g}")

    def worn(self, layout: SoleLayout | SkinPatch, seed: int = 0, batch: tuple[int, ...] = ()) -> "WornFaults":
        """Draw the faults of one sole, or of many.

        `layout`: its taxels; `seed`: of what is drawn; `batch`: dimensions of many soles, for arrays (*batch, n).
        Returns faults, with state of hysteresis and delay.
        """
        rng = np.random.default_rng(seed)
        shape = (*batch, len(layout))
        gains = 1.0 + np.clip(self.gain * rng.standard_normal(shape), -_GAIN_MOST, _GAIN_MOST)
        offsets = self.offset * rng.standard_normal(shape)
        drifts = self.drift * rng.standard_normal(shape)
        dead = rng.permuted(np.broadcast_to(np.arange(len(layout)), shape), axis=-1) < round(self.dead * len(layout))
        return WornFaults(layout, self, gains, offsets, drifts, dead, rng)


class WornFaults:
    """Faults of a sole's taxels, with the state of hysteresis and delay.

    `faults`: hysteresis, crosstalk, shear, noise, resolution and delay of all taxels; `gains`: gain (..., n) of each
    taxel; `offsets` its zero in N, `drifts` the final drift of that; `dead`: whether each taxel (..., n) is dead;
    `rng`: source of noise; None without noise (else InputError).
    """

    def __init__(
        self,
        layout: SoleLayout | SkinPatch,
        faults: TaxelFaults,
        gains: NDArray[np.float64],
        offsets: NDArray[np.float64] | float = 0.0,
        drifts: NDArray[np.float64] | float = 0.0,
        dead: NDArray[np.bool_] | None = None,
        rng: np.random.Generator | None = None,
    ) -> None:
        if faults.noise > 0.0 and rng is None:
            raise InputError("taxel noise needs a random generator; pass rng=numpy.random.default_rng(seed)")
        self.faults = faults
        self.gains = gains
        self.offsets = offsets
        self.drifts = drifts
        self.dead = dead
        self.spread = crosstalk_matrix(layout, faults.crosstalk)
        self._rng = rng
        self.reset()

    def reset(self) -> None:
        """Clear the state; the noise continues."""
        self._held = np.zeros(self.gains.shape)
        self._late: deque[tuple[float, NDArray[np.float64]]] = deque()

    def read(self, time: float, force: ArrayLike, vectors: ArrayLike | None = None) -> NDArray[np.float64]:
        """Readings of the taxels.

        `time`: time in s, never decreasing; `force`: normal force (..., n) on each taxel in N; `vectors`: force (...,
        n, 3) in N with tangential part, for shear.

        Returns readings (..., n) in N; NaN for dead taxels; ReadingError: forces do not fit.
        """
        faults = self.faults
        pressed = array(force, "forces", self.gains.shape, ReadingError, finite=True)
        if faults.shear:
            if vectors is None:
                raise ReadingError("taxels that read shear need the force vectors (..., n, 3)")
            pulled = array(vectors, "force vectors", (*pressed.shape, 3), ReadingError, finite=True)
            pressed = pressed + faults.shear * np.linalg.norm(pulled[..., :2], axis=-1)
        pressed = self.rubbed(pressed)
        if faults.delay:
            pressed = self._delayed(time, pressed)
        warm = -math.expm1(-max(time, 0.0) / WARMING)
        read = self.gains * pressed + self.offsets + warm * self.drifts
        if faults.noise and self._rng is not None:
            read = read + self._rng.normal(0.0, faults.noise, read.shape)
        if faults.resolution:
            read = faults.resolution * np.round(read / faults.resolution)
        return np.asarray(read if self.dead is None else np.where(self.dead, np.nan, read))

    def rubbed(self, force: NDArray[np.float64]) -> NDArray[np.float64]:
        """Forces (..., n) in N after crosstalk and hysteresis: play between (1 - h) and (1 + h) times the force."""
        spread = self.spread.dot(force) if force.ndim == 1 else force @ self.spread.T
        h = self.faults.hysteresis
        self._held = np.minimum(np.maximum(self._held, (1.0 - h) * spread), (1.0 + h) * spread)
        return self._held

    def _delayed(self, time: float, force: NDArray[np.float64]) -> NDArray[np.float64]:
        """Force one delay ago, interpolated; at first the first."""
        late = self._late
        late.append((time, force))
        due = time - self.faults.delay
        while len(late) > 1 and late[1][0] <= due + SAME_TIME:
            late.popleft()
        before, first = late[0]
        after, second = late[min(1, len(late) - 1)]
        if due <= before or after <= before:
            return first
        share = (due - before) / (after - before)
        return np.asarray(first + share * (second - first))


def crosstalk_matrix(layout: SoleLayout | SkinPatch, crosstalk: float) -> NDArray[np.float64]:
    """Share (n, n) of each taxel's force in each reading; columns sum to 1."""
    spread = np.eye(len(layout))
    for i, near in enumerate(layout.neighbours):
        if near:
            spread[i, i] -= crosstalk
            spread[list(near), i] = crosstalk / len(near)
    return spread
