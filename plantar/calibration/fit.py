"""Responses of taxels by least squares: loads that are known in sum, and what a batch of taxels has in common.

Windows of all takes give rows: the forces of the soles in a take add up to its load, and their moments to load and
center of pressure where one sole carries alone. Unknown are logarithm of gain and curve deviation of each taxel, normal
about the batch's mean with a spread that is estimated with them, and curve, crosstalk and loops of all. Rows' noise is
estimated for each take, kind of row and quarter of speed, with the correlation from window to window, as a first-order
process.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.calibration.windows import Windows
from plantar.common.sides import Side
from plantar.errors import InputError
from plantar.layouts.calibration import leakage, response
from plantar.layouts.layout import SoleLayout

Array = NDArray[np.float64]

SHARED = ("curve", "curve_2", "crosstalk", "hysteresis", "creep")
"""Unknowns that all taxels share."""

CURVE = slice(0, 2)
CROSSTALK = 2
LOOPS = slice(3, 5)
"""Places of the curve's two terms, of crosstalk, and of hysteresis and creep among them."""

SHARED_MEAN = np.array([0.0, 0.0, 0.05, 0.02, 0.03])
"""What they are taken for before anything is measured."""

SHARED_SPREAD = np.array([0.3, 0.1, 0.05, 0.03, 0.05])
"""Standard deviation of that: curves of a batch bend by 30 % in a reference load, skins leak up to 15 %, loops are open
by up to 8 % of their peak."""

# How much these count, in two draws of benchmarks/calibration.py by a robot's joints, and by weight alone: with half or
# double of one, gains have a median error of 10.8 to 11.4 %, and 16.2 to 17.9 %, and the center of pressure is off by
# 0.63 to 0.70 mm, and 1.09 to 1.37 mm. Only the gains' own spread counts for more: by weight alone 86 % of them are
# inside their intervals, with half of it 62 %, with double of it 98 %.
_ITERATIONS = 15  # then gains are within 0.2 % of those after 40 by a robot's joints, within 0.9 % by weight alone
_FREE = 3  # iterations after which spreads and noise are estimated; after 1 or 6 gains' errors are the same
_GAIN_SPREAD = 0.25  # relative, of gains in a batch before anything is measured
_DEVIATION_SPREAD = 0.05  # of curve deviations
_BATCH = 10.0  # taxels whose spread that is worth
_MOST_FREE = 0.8  # of the independent windows that unknowns may use up
_FLOOR = 5e-4  # of the largest load: least noise of a measured row, and by 1 m of moment arm
_UNSTEADY = 0.01  # of a weight, by which a body that stands or leans accelerates: least noise of a constant load
# Of the hysteresis' share: somewhat less than a quarter of a loop's half width, which its lens leaves.
_LEFT_OVER = 0.45
_LARGEST_STEP = 0.5  # of a gain's logarithm
_STEP = 1e-5  # of shared unknowns, for their derivatives
_STOPPED = 1e-5  # relative change of gains


class Fitted(NamedTuple):
    """What a fit found. `gain`, `deviation` (n,) of each side; `shared` (5,) in the order of `SHARED`, with
    `shared_error`; `covariance`: of each side's relative gains (n, n); `gain_spread`: relative, of the batch; `noise`:
    of the load in N by take and quarter of speed.
    """

    gain: Mapping[Side, Array]
    deviation: Mapping[Side, Array]
    covariance: Mapping[Side, Array]
    shared: Array
    shared_error: Array
    gain_spread: float
    noise: list[list[float]]


class _Unknowns:
    """Gains and deviations (m,) of all soles' taxels one after another, and the shared ones."""

    def __init__(self, gain: Array) -> None:
        self.gain = gain
        self.deviation = np.zeros(len(gain))
        self.shared = SHARED_MEAN.copy()


class ResponseFit:
    """Fit of the soles of `layouts` to `takes` in windows; `reference` in N: where the curve is 1."""

    def __init__(self, layouts: Mapping[Side, SoleLayout], takes: Sequence[Windows], reference: float) -> None:
        self._layouts = layouts
        self._takes = takes
        self._reference = reference
        self._places: dict[Side, slice] = {}
        begin = 0
        for side, layout in layouts.items():
            self._places[side] = slice(begin, begin + len(layout))
            begin += len(layout)
        self._count = begin
        self._leak = {side: leakage(layout) for side, layout in layouts.items()}
        self._rise = {side: layout.rotations[:, 2, 2] for side, layout in layouts.items()}
        self._arms = {side: _moment_arms(layout) for side, layout in layouts.items()}
        self._largest = max(float(take.load[take.usable].max()) for take in takes if take.usable.any())

    def solve(self) -> Fitted:
        """Gauss-Newton steps, with spreads and noise estimated on the way.

        InputError if no window is usable.
        """
        known = _Unknowns(np.full(self._count, self._mean_gain()))
        rows = [row for take in self._takes for row in self._rows(take)]
        noise = [np.full(len(row.target), row.scale * 10.0) for row in rows]
        follow = np.zeros(len(rows))
        gain_spread = _GAIN_SPREAD
        deviation_spread = _DEVIATION_SPREAD
        loss = 1.0
        m = self._count
        for step in range(_ITERATIONS):
            matrix = np.zeros((2 * m + 5, 2 * m + 5))
            slope = np.zeros(2 * m + 5)
            for number, row in enumerate(rows):
                found, jacobian = self._predicted(row, known)
                left = row.target - found
                if step >= _FREE:
                    noise[number], follow[number] = _noise_of(left, row)
                    noise[number] *= loss
                whitened, rest = _whitened(jacobian, left, noise[number], follow[number], row.breaks)
                matrix += whitened.T @ whitened
                slope += whitened.T @ rest
            spread = np.concatenate([np.full(m, gain_spread), np.full(m, deviation_spread), SHARED_SPREAD])
            logarithm = np.log(known.gain)
            centre = np.concatenate([np.full(m, logarithm.mean()), np.zeros(m), SHARED_MEAN])
            now = np.concatenate([logarithm, known.deviation, known.shared])
            slope -= (now - centre) / spread**2
            matrix[np.diag_indices_from(matrix)] += spread**-2.0
            covariance = np.linalg.inv(matrix)
            change = covariance @ slope
            moved = float(np.abs(change[:m]).max())
            known.gain = known.gain * np.exp(np.clip(change[:m], -_LARGEST_STEP, _LARGEST_STEP))
            known.deviation = known.deviation + change[m : 2 * m]
            known.shared = known.shared + change[2 * m :]
            known.shared[CROSSTALK] = np.clip(known.shared[CROSSTALK], 0.0, 0.45)
            if step >= _FREE:
                variance = np.diag(covariance)
                used = float((1.0 - variance / spread**2).sum())
                independent = sum(len(n) * (1.0 - f) / (1.0 + f) for n, f in zip(noise, follow, strict=True))
                loss = float(1.0 / np.sqrt(1.0 - min(_MOST_FREE, used / independent)))
                logarithm = np.log(known.gain)
                gain_spread = _spread(logarithm - logarithm.mean(), variance[:m], _GAIN_SPREAD)
                deviation_spread = _spread(known.deviation, variance[m : 2 * m], _DEVIATION_SPREAD)
                if moved < _STOPPED and step > _FREE:
                    break
        relative = covariance[:m, :m] + (_LEFT_OVER * known.shared[3]) ** 2 * (np.eye(m) + 1.0)
        return Fitted(
            {side: known.gain[at] for side, at in self._places.items()},
            {side: known.deviation[at] for side, at in self._places.items()},
            {side: relative[at, at] for side, at in self._places.items()},
            known.shared,
            np.sqrt(np.diag(covariance)[2 * m :]),
            gain_spread,
            [
                [float(n[row.speed == q].mean()) for q in range(4) if (row.speed == q).any()]
                for n, row in zip(noise, rows, strict=True)
                if row.axis is None
            ],
        )

    def _mean_gain(self) -> float:
        ratios = []
        for take in self._takes:
            summed = np.sum([sole.above.sum(axis=1) for sole in take.soles.values()], axis=0)
            used = take.usable & (take.load > 0.1 * self._largest) & (summed > 0.0)
            ratios.append(take.load[used] / summed[used])
        every = np.concatenate(ratios)
        if not len(every):
            raise InputError("no frame holds counts under a known load; allowed: soles that carry, within their range")
        return float(np.median(every))

    def _rows(self, take: Windows) -> list["_Row"]:
        constant = float(np.ptp(take.load[take.usable])) == 0.0
        least = _UNSTEADY if constant else _FLOOR
        found = [_row_of(take, take.load, take.usable, None, None, least * self._largest)]
        for side, places in take.cop.items():
            usable = take.usable & np.isfinite(places).all(axis=1) & (take.load > 0.02 * self._largest)
            if usable.any():
                for axis in (0, 1):
                    target = take.load * places[:, axis]
                    found.append(_row_of(take, target, usable, side, axis, _FLOOR * self._largest))
        return [row for row in found if len(row.target) > 1]

    def _predicted(self, row: "_Row", known: _Unknowns) -> tuple[Array, Array]:
        """Sums or moments (k,) of a row's windows, and their derivatives (k, 2 m + 5) by the unknowns in order."""
        m = self._count
        jacobian = np.zeros((len(row.target), 2 * m + 5))
        total, per_gain, per_deviation = self._sums(row, known.gain, known.deviation, known.shared)
        jacobian[:, :m] = per_gain
        jacobian[:, m : 2 * m] = per_deviation
        for j in range(5):
            moved = known.shared.copy()
            moved[j] += _STEP
            jacobian[:, 2 * m + j] = (self._sums(row, known.gain, known.deviation, moved)[0] - total) / _STEP
        return total, jacobian

    def _sums(self, row: "_Row", gain: Array, deviation: Array, shared: Array) -> tuple[Array, Array, Array]:
        m = self._count
        total = np.zeros(len(row.target))
        per_gain = np.zeros((len(total), m))
        per_deviation = np.zeros((len(total), m))
        for side, sole in row.soles.items():
            if row.side not in (None, side):
                continue
            at = self._places[side]
            weight = self._rise[side] if row.axis is None else self._arms[side][row.axis]
            weight = weight @ np.linalg.inv(np.eye(len(weight)) + shared[CROSSTALK] * self._leak[side])
            level = (sole.above + np.tensordot(shared[LOOPS], sole.loops, 1)) * gain[at]
            force = response(level, self._reference, shared[CURVE], deviation[at])
            beyond = level / self._reference - 1.0
            bend = (shared[0] + deviation[at] + 2.0 * shared[1] * beyond) / self._reference
            total += force @ weight
            per_gain[:, at] = (force + level**2 * bend) * weight
            per_deviation[:, at] = level * beyond * weight
        return total, per_gain, per_deviation


class _Row(NamedTuple):
    """Windows of a take that have one target: its load, or a moment about an axis of a side. `breaks`: whether the
    window before is another than the one before in time.
    """

    soles: Mapping[Side, "_Levels"]
    target: Array
    side: Side | None
    axis: int | None
    speed: NDArray[np.int64]
    breaks: NDArray[np.bool_]
    scale: float


class _Levels(NamedTuple):
    above: Array
    loops: Array


def _row_of(
    take: Windows, target: Array, usable: NDArray[np.bool_], side: Side | None, axis: int | None, scale: float
) -> _Row:
    used = np.flatnonzero(usable)
    soles = {one: _Levels(sole.above[used], sole.loops[:, used]) for one, sole in take.soles.items()}
    breaks = np.concatenate([[True], np.diff(used) > 1])[: len(used)]
    return _Row(soles, target[used], side, axis, take.speed[used], breaks, scale)


def _noise_of(left: Array, row: _Row) -> tuple[Array, float]:
    """Standard deviation (k,) of what is left over, by quarter of speed, and its correlation from window to window."""
    noise = np.empty(len(left))
    for quarter in np.unique(row.speed):
        at = row.speed == quarter
        noise[at] = max(float(np.sqrt(np.mean(left[at] ** 2))), row.scale)
    scaled = left / noise
    after = ~row.breaks
    after[0] = False
    power = float((scaled**2).sum())
    follow = float((scaled[1:] * scaled[:-1])[after[1:]].sum()) / power if power > 0.0 else 0.0
    return noise, float(np.clip(follow, 0.0, 0.95))


def _whitened(
    jacobian: Array, left: Array, noise: Array, follow: float, breaks: NDArray[np.bool_]
) -> tuple[Array, Array]:
    matrix = jacobian / noise[:, None]
    rest = left / noise
    before = np.where(breaks, 0.0, follow)
    before[0] = 0.0
    scale = np.where(before > 0.0, 1.0 / np.sqrt(1.0 - follow**2), 1.0)
    earlier = np.roll(matrix, 1, axis=0)
    return (matrix - before[:, None] * earlier) * scale[:, None], (rest - before * np.roll(rest, 1)) * scale


def _spread(values: Array, variance: Array, before: float) -> float:
    """Standard deviation of a batch whose `values` (n,) are known up to a `variance` (n,); a step of its estimate, in
    which the one `before` counts as some taxels.
    """
    return float(np.sqrt((np.sum(values**2 + variance) + _BATCH * before**2) / (len(values) + _BATCH)))


def _moment_arms(layout: SoleLayout) -> Array:
    """Moments (2, n) in m that 1 N on each taxel adds: its place, and how a load that changes from neighbour to
    neighbour is distributed within a cell, to first order.
    """
    places = layout.positions[:, :2]
    arms = places.T.copy()
    for i, near in enumerate(layout.neighbours):
        if len(near) < 2:
            continue
        index = list(near)
        slope = np.linalg.pinv(places[index] - places[i])  # (2, k): gradient by the neighbours' differences
        inertia = _second_moment(layout.cell_polygon(i))
        arms[:, index] += inertia * slope / layout.areas[index]
        arms[:, i] -= inertia * slope.sum(axis=1) / layout.areas[i]
    return arms * layout.rotations[:, 2, 2]


def _second_moment(corners: Array) -> float:
    """Second moment in m^4 of a cell with `corners` (c, 2) about its middle, the mean of those along x and y."""
    first = corners - corners.mean(axis=0)
    after = np.roll(first, -1, axis=0)
    cross = first[:, 0] * after[:, 1] - first[:, 1] * after[:, 0]
    squares = (first * first + first * after + after * after).sum(axis=1)
    return float((cross * squares).sum() / 24.0)
