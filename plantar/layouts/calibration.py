"""What turns one sole's counts into newtons, with the covariance of its gains."""

import math
from collections.abc import Mapping
from dataclasses import MISSING, dataclass, fields
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import instance, number
from plantar.common.arrays import array, numbers, own
from plantar.errors import LayoutError


class Sole(Protocol):
    """What a calibration needs of a layout."""

    @property
    def neighbours(self) -> tuple[tuple[int, ...], ...]:
        """Taxels that share an edge with each."""

    @property
    def positions(self) -> NDArray[np.float64]:
        """Centers (n, 3) in m."""

    @property
    def rotations(self) -> NDArray[np.float64]:
        """Rotations (n, 3, 3) from taxels' frames to the sole's."""


_TURN = 0.05  # of a contact's peak by which counts change until they are on the other branch of the loop
_UNLOADED = 0.01  # of a taxel's largest counts below which a contact has ended
_CREEP = 1.0  # s within which creep follows; of the lags of 0.3 to 3 s any fits polymers' loops on feet
_FIRST_PEAK = 0.05  # of a taxel's largest counts that a new contact is taken to reach at least
_MOST_COUNTS = 2.0**53  # beyond, a float holds no whole numbers: no converter gives them, so they are not measured


@dataclass(frozen=True, eq=False)
class SoleCalibration:
    """Response of one sole's taxels; n taxels in the layout's order.

    With x = counts - offset, corrected for hysteresis, and z = gain x, a taxel reads z (1 + (c1 + d) y + c2 y^2) where
    y = z / reference - 1 and d is its own deviation; `crosstalk` is the share of a force that its neighbours read.

    Attributes:
        gain: N per count (n,) at the reference load.
        offset: Counts (n,) without load.
        covariance: Covariance (n, n) of the gains' relative errors.
        reference: Load of a taxel in N at which the curve is 1.
        curve: c1 and c2 (2,), of all taxels.
        curve_deviation: d (n,) of each taxel.
        hysteresis: Shares (2,) of a lens-shaped loop, and of creep: of what a force rose by within a second.
        top: Counts (n,) above the offset that each taxel reached.
        crosstalk: Share of a taxel's force that its neighbours read.
        shared_error: Standard errors (5,) of curve, crosstalk and hysteresis, in this order.
        date: Day of calibration, such as 2026-03-01.
        method: What was measured for it, in a line.
        unobserved: What the measurements did not determine, a sentence each.

    Raises:
        LayoutError: Invalid field, named in the message.

    Example:
        >>> import numpy as np
        >>> linear = SoleCalibration.linear([0.1, 0.2], [10.0, 20.0])
        >>> linear.forces([[110.0, 70.0]]).tolist()
        [[10.0, 10.0]]
    """

    gain: NDArray[np.float64]
    offset: NDArray[np.float64]
    covariance: NDArray[np.float64]
    reference: float
    curve: NDArray[np.float64]
    curve_deviation: NDArray[np.float64]
    hysteresis: NDArray[np.float64]
    top: NDArray[np.float64]
    crosstalk: float
    shared_error: NDArray[np.float64]
    date: str = ""
    method: str = ""
    unobserved: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        kept = self.__dict__  # past what keeps others from assigning
        n = len(np.atleast_1d(np.asarray(self.gain)))
        shapes: dict[str, tuple[int, ...]] = {
            "gain": (n,),
            "offset": (n,),
            "covariance": (n, n),
            "curve": (2,),
            "curve_deviation": (n,),
            "hysteresis": (2,),
            "top": (n,),
            "shared_error": (5,),
        }
        for name, shape in shapes.items():
            what = f"layout field 'calibrations.{name}'"
            kept[name] = own(array(getattr(self, name), what, shape, LayoutError))
            if not np.isfinite(kept[name]).all():
                raise LayoutError(f"{what} holds a value that is not finite")
        for name in ("reference", "crosstalk"):
            kept[name] = number(getattr(self, name), f"layout field 'calibrations.{name}'", LayoutError)
        kept["unobserved"] = tuple(self.unobserved)
        if not (self.gain > 0.0).all():
            raise LayoutError("layout field 'calibrations.gain' holds a gain that is not above 0 N per count")
        if not (self.top > 0.0).all():
            raise LayoutError("layout field 'calibrations.top' holds counts that are not above 0")
        if not self.reference > 0.0:
            raise LayoutError(f"layout field 'calibrations.reference' is {self.reference:g} N; allowed: above 0")
        if not 0.0 <= self.crosstalk < 0.5:
            raise LayoutError(f"layout field 'calibrations.crosstalk' is {self.crosstalk:g}; allowed: 0 up to 0.5")
        if not (np.diag(self.covariance) >= 0.0).all():
            raise LayoutError("layout field 'calibrations.covariance' holds a variance below 0")

    def __len__(self) -> int:
        return len(self.gain)

    @classmethod
    def linear(cls, gain: ArrayLike, offset: ArrayLike, error: float = 0.0) -> "SoleCalibration":
        """Calibration of straight responses.

        Args:
            gain: N per count (n,).
            offset: Counts (n,) without load.
            error: Relative standard error of each gain, independent.
        """
        gains = array(gain, "gain", ("n",), finite=True)
        n = len(gains)
        offsets = array(offset, "offset", (n,), finite=True)
        covariance = error**2 * np.eye(n)
        zeros = np.zeros(n)
        pair = np.zeros(2)
        return cls(gains, offsets, covariance, 1.0, pair, zeros, pair, np.ones(n), 0.0, np.zeros(5))

    @property
    def gain_error(self) -> NDArray[np.float64]:
        """Relative standard error (n,) of each gain."""
        return np.sqrt(np.diag(self.covariance))

    def forces(self, counts: ArrayLike, layout: Sole | None = None, rate: float = 100.0) -> NDArray[np.float64]:
        """Forces (k, n) in N of counts (k, n) in order of time, NaN where counts are; not below 0.

        Args:
            counts: Of k frames, from a time without load on where hysteresis counts.
            layout: The sole's, whose neighbours share crosstalk; None leaves that uncorrected.
            rate: Frames a second.
        """
        frames = array(counts, "counts", ("k", len(self)))
        stream = CountStream(self, layout, rate)
        return np.array([stream.force(row) for row in frames]).reshape(-1, len(self))

    def cop_deviation(self, layout: Sole, force: ArrayLike) -> NDArray[np.float64] | None:
        """Standard deviation (2,) in m of the center of pressure by the gains' errors; None without load.

        Args:
            layout: The sole's.
            force: Force (n,) of each taxel in N, NaN where unmeasured.
        """
        share = np.nan_to_num(array(force, "force", (len(self),))) * layout.rotations[:, 2, 2]
        total = share.sum()
        if not total > 0.0:
            return None
        share = share / total
        lever = layout.positions[:, :2] - share @ layout.positions[:, :2]
        weight = share[:, None] * lever
        return np.asarray(np.sqrt(np.maximum(np.einsum("ia,ij,ja->a", weight, self.covariance, weight), 0.0)))

    def load_deviation(self, force: ArrayLike) -> float:
        """Relative standard deviation of the summed force (n,) by the gains' errors; 0 without load."""
        share = np.nan_to_num(array(force, "force", (len(self),)))
        total = share.sum()
        if not total > 0.0:
            return 0.0
        share = share / total
        return float(np.sqrt(max(0.0, share @ self.covariance @ share)))

    def as_dict(self) -> dict[str, Any]:
        """Plain JSON values; the covariance as rows of its lower triangle."""
        rounded = np.round(self.covariance, 9).tolist()
        return {
            "date": self.date,
            "method": self.method,
            "unobserved": list(self.unobserved),
            "reference": self.reference,
            "gain": self.gain.tolist(),
            "offset": self.offset.tolist(),
            "curve": self.curve.tolist(),
            "curve_deviation": self.curve_deviation.tolist(),
            "hysteresis": self.hysteresis.tolist(),
            "top": self.top.tolist(),
            "crosstalk": self.crosstalk,
            "shared_error": self.shared_error.tolist(),
            "covariance": [row[: i + 1] for i, row in enumerate(rounded)],
        }

    @classmethod
    def from_mapping(cls, source: Any, where: str) -> "SoleCalibration":
        """Calibration from the values of `as_dict`.

        Raises:
            LayoutError: If a field is missing or invalid; `where` names the source.
        """
        if not isinstance(source, Mapping):
            raise LayoutError(f"{where}: field 'calibrations' holds no JSON object for a side")
        names = [one.name for one in fields(cls) if one.default is MISSING]
        missing = [name for name in names if name not in source]
        if missing:
            raise LayoutError(f"{where}: field 'calibrations.{missing[0]}' is missing")
        rows = source["covariance"]
        whole = isinstance(rows, list) and all(
            isinstance(row, list) and len(row) == i + 1 for i, row in enumerate(rows)
        )
        if not whole:
            raise LayoutError(f"{where}: field 'calibrations.covariance' is no list of 1, 2, ... numbers")
        lower = np.zeros((len(rows), len(rows)))
        for i, row in enumerate(rows):
            lower[i, : i + 1] = numbers(row, f"{where}: field 'calibrations.covariance'", LayoutError)
        values = {name: source[name] for name in names if name != "covariance"}
        texts = {
            name: instance(source.get(name, ""), str, f"{where}: '{name}'", LayoutError) for name in ("date", "method")
        }
        lines = source.get("unobserved", [])
        if not isinstance(lines, list) or not all(isinstance(line, str) for line in lines):
            raise LayoutError(f"{where}: field 'calibrations.unobserved' is no list of sentences")
        covariance = lower + np.tril(lower, -1).T
        return cls(**values, covariance=covariance, **texts, unobserved=tuple(lines))


class CountStream:
    """Forces of one sole's counts as they come; it remembers which branch of its loop each taxel is on.

    `layout`: the sole's, whose neighbours share crosstalk, or None; `rate`: frames a second.
    """

    def __init__(self, calibration: SoleCalibration, layout: Sole | None = None, rate: float = 100.0) -> None:
        self._known = calibration
        self._time: float | None = None
        self._loops = LoopState(calibration.top, 1.0 / rate)
        self._above = np.zeros(len(calibration))
        shared = None if layout is None or not calibration.crosstalk else leakage(layout)
        mixed = None if shared is None else np.eye(len(calibration)) + calibration.crosstalk * shared
        self._unmixed = None if mixed is None else np.linalg.inv(mixed)

    def force(self, counts: ArrayLike, time: float | None = None) -> NDArray[np.float64]:
        """Forces (n,) in N of one frame's counts (n,); its `time` in s, where frames come as they like."""
        known = self._known
        period = None
        if time is not None:
            period = None if self._time is None else max(0.0, time - self._time)
            self._time = time
        read = array(counts, "counts", (len(known),))
        given = np.where(np.abs(read) <= _MOST_COUNTS, read, np.nan) - known.offset
        self._above = np.where(np.isnan(given), self._above, given)  # a missing one lifts no foot
        loops = self._loops.advance(self._above, period)
        level = self._above + known.hysteresis[0] * loops[0] + known.hysteresis[1] * loops[1]
        force = response(level * known.gain, known.reference, known.curve, known.curve_deviation)
        if self._unmixed is not None:
            force = self._unmixed @ force
        return np.where(np.isnan(given), np.nan, np.maximum(force, 0.0))


class LoopState:
    """Loading branch or unloading branch of each taxel, by its counts above the offset so far, and how far it crept.

    `top`: counts (n,) that each taxel reaches; `period`: from frame to frame in s.
    """

    def __init__(self, top: NDArray[np.float64], period: float) -> None:
        self._top = top
        self._follow = -math.expm1(-period / _CREEP)
        self._crept = np.zeros(len(top))
        self._peak = _FIRST_PEAK * top
        self._branch = np.zeros(len(top))
        self._last: NDArray[np.float64] | None = None

    def advance(
        self, counts: NDArray[np.float64], period: float | None = None
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """What is added (n,) for each share of hysteresis and of creep, in counts, after a frame's `counts` (n,); its
        own `period` in s, if it has one.
        """
        follow = self._follow if period is None else -math.expm1(-period / _CREEP)
        if self._last is None:
            self._last = counts
            self._crept = counts
        ended = counts < _UNLOADED * self._top
        self._peak = np.where(ended, _FIRST_PEAK * self._top, np.maximum(self._peak, counts))
        self._branch = np.clip(self._branch + (counts - self._last) / (_TURN * self._peak), -1.0, 1.0)
        self._last = counts
        share = np.clip(counts / self._peak, 0.0, 1.0)
        self._crept = self._crept + follow * (counts - self._crept)
        return 4.0 * self._peak * share * (1.0 - share) * self._branch, counts - self._crept


def response(
    level: NDArray[np.float64], reference: float, curve: ArrayLike, deviation: ArrayLike
) -> NDArray[np.float64]:
    """Forces (..., n) in N of a straight response's `level` (..., n), as `SoleCalibration` states."""
    first, second = np.asarray(curve, dtype=np.float64)
    beyond = level / reference - 1.0
    return np.asarray(level * (1.0 + (first + np.asarray(deviation)) * beyond + second * beyond**2))


def leakage(layout: Sole) -> NDArray[np.float64]:
    """Change (n, n) of what taxels read for a crosstalk of 1: a force goes to the neighbours, in equal parts."""
    out = np.zeros((len(layout.neighbours), len(layout.neighbours)))
    for i, near in enumerate(layout.neighbours):
        if near:
            out[list(near), i] = 1.0 / len(near)
            out[i, i] = -1.0
    return out
