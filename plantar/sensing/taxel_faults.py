"""Errors of real taxels, one model for simulations, `plantar.mujoco.Skin` and recordings.

In this order: shear reads as normal force, crosstalk to neighbours, hysteresis, creep, delay, a curve, a gain and a
zero (offset) that drift with warmth, noise, a dead band, saturation, steps (resolution), dead taxels and lost rows.
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

CREEPING = 10.0
"""Time constant in s with which a reading creeps under a constant load."""

WARMING = 60.0
"""Time constant in s with which a sole becomes as warm as the foot in it."""

_GAIN_MOST = 0.9  # either way of a taxel's gain of 1: a taxel that reads nothing is dead, which is another fault
_SHARES = ("crosstalk", "hysteresis", "creep", "dead", "rows", "shear", "temperature")


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
        curve: Share of the gain that is lost per N, in 1/N: f reads as f / (1 + curve f).
        creep: Share by which a reading rises under a load that stays, within `CREEPING`.
        saturation: Largest reading in N.
        dead_band: In N, below which a taxel reads 0.
        temperature: Standard deviation of gains' relative change when the skin is warm, after `WARMING`.
        rows: Share of rows across the skin (taxels of one x) whose wire is broken: they read NaN.

    Raises:
        InputError: If a value is not allowed.

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
    curve: float = 0.0
    creep: float = 0.0
    saturation: float = 0.0
    dead_band: float = 0.0
    temperature: float = 0.0
    rows: float = 0.0

    def __post_init__(self) -> None:
        for field in fields(self):
            value = number(getattr(self, field.name), f"taxel fault '{field.name}'", finite=True)
            most = 0.9 if field.name in _SHARES else math.inf
            if not 0.0 <= value <= most:
                raise InputError(f"taxel fault '{field.name}' is {value:g}; allowed: 0 to {most:g}")

    def worn(self, layout: SoleLayout | SkinPatch, seed: int = 0, batch: tuple[int, ...] = ()) -> "WornFaults":
        """Draw the faults of one sole, or of many.

        `layout`: the sole's taxels, or a link's; `seed` of the draws; `batch`: dimensions of many soles, for arrays
        (*batch, n). Returns faults, with state of hysteresis, creep and delay.
        """
        rng = np.random.default_rng(seed)
        shape = (*batch, len(layout))
        gains = 1.0 + np.clip(self.gain * rng.standard_normal(shape), -_GAIN_MOST, _GAIN_MOST)
        offsets = self.offset * rng.standard_normal(shape)
        drifts = self.drift * rng.standard_normal(shape)
        dead = _drawn(rng, shape, self.dead)
        warm = np.zeros(shape)
        if self.temperature:
            warm = np.clip(self.temperature * rng.standard_normal(shape), -_GAIN_MOST, _GAIN_MOST)
        if self.rows:
            row = _rows(layout)
            dead = dead | _drawn(rng, (*batch, row.max() + 1), self.rows)[..., row]
        return WornFaults(layout, self, gains, offsets, drifts, dead, rng, warm)


class WornFaults:
    """Faults of a sole's taxels, with the state of hysteresis, creep and delay.

    `faults`: what is the same for all taxels; `gains`: gain (..., n) of each taxel; `offsets` its zero in N, `drifts`
    the final drift of that; `dead`: whether each taxel (..., n) is dead; `rng`: source of noise; None without noise
    (else InputError); `warm_gains`: relative change of each gain when warm.
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
        warm_gains: NDArray[np.float64] | float = 0.0,
    ) -> None:
        if faults.noise > 0.0 and rng is None:
            raise InputError("taxel noise needs a random generator; pass rng=numpy.random.default_rng(seed)")
        self.faults = faults
        self.gains = gains
        self.offsets = offsets
        self.drifts = drifts
        self.dead = dead
        self.warm_gains = warm_gains
        self.spread = crosstalk_matrix(layout, faults.crosstalk)
        self._rng = rng
        self.reset()

    def reset(self) -> None:
        """Clear the state; the noise continues."""
        self._held = np.zeros(self.gains.shape)
        self._crept = np.zeros(self.gains.shape)
        self._creeps_from: float | None = None
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
        if faults.creep:
            pressed = self._creeping(time, pressed)
        if faults.delay:
            pressed = self._delayed(time, pressed)
        if faults.curve:
            pressed = pressed / (1.0 + faults.curve * np.abs(pressed))
        warm = -math.expm1(-max(time, 0.0) / WARMING)
        read = self.gains * (1.0 + warm * self.warm_gains) * pressed + self.offsets + warm * self.drifts
        if faults.noise and self._rng is not None:
            read = read + self._rng.normal(0.0, faults.noise, read.shape)
        if faults.dead_band:
            read = np.where(np.abs(read) < faults.dead_band, 0.0, read)
        if faults.saturation:
            read = np.clip(read, -faults.saturation, faults.saturation)
        if faults.resolution:
            read = faults.resolution * np.round(read / faults.resolution)
        return np.asarray(read if self.dead is None else np.where(self.dead, np.nan, read))

    def rubbed(self, force: NDArray[np.float64]) -> NDArray[np.float64]:
        """Forces (..., n) in N after crosstalk and hysteresis: play between (1 - h) and (1 + h) times the force."""
        spread = self.spread.dot(force) if force.ndim == 1 else force @ self.spread.T
        h = self.faults.hysteresis
        self._held = np.minimum(np.maximum(self._held, (1.0 - h) * spread), (1.0 + h) * spread)
        return self._held

    def _creeping(self, time: float, force: NDArray[np.float64]) -> NDArray[np.float64]:
        """Forces plus what has crept: a first-order lag of them."""
        passed = 0.0 if self._creeps_from is None else max(time - self._creeps_from, 0.0)
        self._creeps_from = time
        self._crept = self._crept - math.expm1(-passed / CREEPING) * (force - self._crept)
        return np.asarray(force + self.faults.creep * self._crept)

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


def _drawn(rng: np.random.Generator, shape: tuple[int, ...], share: float) -> NDArray[np.bool_]:
    """Mask of a shape (..., n): of each n, a share that is drawn."""
    count = shape[-1]
    order = rng.permuted(np.broadcast_to(np.arange(count), shape), axis=-1)
    return np.asarray(order < round(share * count))


def _rows(layout: SoleLayout | SkinPatch) -> NDArray[np.int64]:
    """Number of each taxel's row: those whose x is the same, to a quarter of a cell."""
    width = math.sqrt(float(np.median(layout.areas)))
    x = layout.positions[:, 0]
    order = np.argsort(x, kind="stable")
    begins = np.diff(x[order], prepend=x[order[0]]) > 0.25 * width
    rows = np.empty(len(x), dtype=np.int64)
    rows[order] = np.cumsum(begins)
    return rows


def crosstalk_matrix(layout: SoleLayout | SkinPatch, crosstalk: float) -> NDArray[np.float64]:
    """Share (n, n) of each taxel's force in each reading; columns sum to 1."""
    spread = np.eye(len(layout))
    for i, near in enumerate(layout.neighbours):
        if near:
            spread[i, i] -= crosstalk
            spread[list(near), i] = crosstalk / len(near)
    return spread
