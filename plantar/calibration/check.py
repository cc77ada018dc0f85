"""Whether a calibration still holds: ten seconds off the ground and on it; and what hours did to it."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.calibration.calibrated import SURE
from plantar.calibration.take import Take
from plantar.common.arguments import instance
from plantar.common.sides import Side
from plantar.errors import InputError
from plantar.layouts.calibration import SoleCalibration
from plantar.layouts.layout import SoleLayout
from plantar.recordings.pressure_recording import layout_for, true_runs

_STILL = 0.02  # of the weight, by which a body that stands still is off it: gains that changed by less than 4 % pass
_LIFTED = 0.05  # of the weight, below which a sole is off the ground
# Of a taxel's share of the weight, by which an offset may move: with all of a sole's moved so far in one direction, its
# sum is off by as much as a body that stands still.
_MOVED = _STILL
_SHORTEST = 0.5  # s of a phase: half of the second for which each foot is lifted


@dataclass(frozen=True)
class CheckedCalibration:
    """Result of `check_calibration`.

    Attributes:
        weight: Of the body, in N.
        measured: Force in N on all soles while it stood.
        interval: 95 % interval in N of what the calibration may measure then.
        offset_moved: Of each side: largest change in N of a taxel's reading without load; NaN if it was not lifted.
        failures: What does not hold, a sentence each.
    """

    weight: float
    measured: float
    interval: tuple[float, float]
    offset_moved: Mapping[Side, float]
    failures: tuple[str, ...]

    @property
    def holds(self) -> bool:
        """Whether the calibration still holds."""
        return not self.failures

    def as_dict(self) -> dict[str, Any]:
        """Plain values for JSON."""
        moved = {side: None if np.isnan(value) else round(value, 3) for side, value in self.offset_moved.items()}
        low, high = self.interval
        return {
            "holds": self.holds,
            "weight_N": round(self.weight, 2),
            "measured_N": round(self.measured, 2),
            "interval_N": [round(low, 2), round(high, 2)],
            "offset_moved_N": moved,
            "failures": list(self.failures),
        }

    def text(self) -> str:
        """What was measured, in lines."""
        low, high = self.interval
        lines = [f"standing: {self.measured:.0f} N of {self.weight:.0f} N; allowed: {low:.0f} to {high:.0f} N"]
        for side, moved in self.offset_moved.items():
            shown = "not lifted" if np.isnan(moved) else f"zero moved by up to {moved:.2f} N"
            lines.append(f"{side}: {shown}")
        return "\n".join([*lines, "holds" if self.holds else "does not hold"])


def check_calibration(take: Take, layout: SoleLayout) -> CheckedCalibration:
    """Compare a body's weight with what calibrated soles measure while it stands, and their zero with that when lifted.

    Args:
        take: Of kind "motion", some ten seconds: it stands still on these soles, and lifts each one for a second.
        layout: With the calibration of each of its sides.

    Returns:
        What was measured, and what does not hold.

    Raises:
        InputError: If a side is not calibrated, or the body never stands.
    """
    instance(layout, SoleLayout, "layout")
    soles = _calibrated_soles(take, layout)
    weight = _weight(take)
    forces = {side: known.forces(take.counts[side], sole, take.rate) for side, (sole, known) in soles.items()}
    sums = {side: _sums(force) for side, force in forces.items()}
    total = np.sum(list(sums.values()), axis=0)
    standing = _still(total, take.rate)
    if not standing.any():
        raise InputError(
            f"{take.name}: the body never stands still for {_SHORTEST:g} s; allowed: one that stands, then lifts a foot"
        )
    measured = float(np.median(total[standing]))
    variance = 0.0
    for side, force in forces.items():
        mean = np.nanmean(force[standing], axis=0)
        variance += (soles[side][1].load_deviation(mean) * float(mean.sum())) ** 2
    half = SURE * np.hypot(np.sqrt(variance), _STILL * weight)
    failures = []
    if not abs(measured - weight) <= half:
        share = 100.0 * (measured / weight - 1.0)
        failures.append(
            f"a body of {weight:.0f} N reads {measured:.0f} N ({share:+.0f} %): the gains changed; calibrate again"
        )
    moved: dict[Side, float] = {}
    for side, counts in take.counts.items():
        lifted = _still_lifted(sums[side], total, weight, take.rate)
        if not lifted.any():
            moved[side] = math.nan
            continue
        known = soles[side][1]
        shift = np.abs((np.nanmean(counts[lifted], axis=0) - known.offset) * known.gain)
        moved[side] = float(shift.max())
        if moved[side] > _MOVED * weight / len(known):
            worst = int(layout.ids[int(shift.argmax())])
            failures.append(f"zero of taxel {worst} of the {side} sole moved by {moved[side]:.2f} N: take zero again")
    return CheckedCalibration(weight, measured, (weight - half, weight + half), moved, tuple(failures))


@dataclass(frozen=True)
class Drift:
    """What hours did to one sole's readings.

    Attributes:
        in_air: Change in N an hour of the summed reading without load, None with less than two phases of that.
        under_load: Change in percent an hour of the summed reading under the same load; None if it never was.
        creep: Change in percent of it for each tenfold time since the load came on; None if no load lasted.
    """

    in_air: float | None
    under_load: float | None
    creep: float | None


def drift(take: Take, layout: SoleLayout) -> dict[Side, Drift]:
    """Drift of the zero, of the gain, and creep under a static load, separated by when the soles are loaded.

    Without load a reading shows the zero alone. Under the same load, with the zero of the time around it taken off, it
    shows the gain, and within one phase of load, over the logarithm of time, creep.

    Args:
        take: Of kind "motion", over hours, its soles loaded by the same load now and then, and lifted.
        layout: With the calibration of each of its sides.

    Returns:
        Drift of each side.

    Raises:
        InputError: If a side is not calibrated.
    """
    soles = _calibrated_soles(take, layout)
    share = _weight(take) / len(soles)
    out: dict[Side, Drift] = {}
    for side, (_, known) in soles.items():
        # Of a straight response: creep, which the calibration takes off, is what is looked for.
        total = _sums((take.counts[side] - known.offset) * known.gain)
        phases = _phases(total > 0.5 * share, take)
        lifted = _phases(total < _LIFTED * share, take)
        air = np.array([[np.mean(take.time[a:b]), np.mean(total[a:b])] for a, b in lifted])
        zero = np.interp(take.time, air[:, 0], air[:, 1]) if len(air) else np.zeros(len(total))
        load = total - zero
        begun = [(a, a + max(1, (b - a) // 10)) for a, b in phases]
        rows = np.array([[np.mean(take.time[a:b]), np.mean(load[a:b])] for a, b in begun])
        rate = _slope(rows) / float(rows[:, 1].mean()) if len(rows) > 1 else None
        slopes = [_creep(take.time[a:b], load[a:b], take.rate, rate or 0.0) for a, b in phases]
        out[side] = Drift(
            in_air=_slope(air) if len(air) > 1 else None,
            under_load=None if rate is None else 100.0 * rate,
            creep=100.0 * float(np.mean(slopes)) if slopes else None,
        )
    return out


def _creep(time: NDArray[np.float64], load: NDArray[np.float64], rate: float, gain: float) -> float:
    """Relative rise of a `load` (k,) in N for each tenfold time, without a gain that rises by `gain` an hour."""
    since = time - time[0] + 1.0 / rate
    level = load / float(np.median(load)) - gain * since / 3600.0
    late = since > 0.1 * since[-1]
    return float(np.polyfit(np.log10(since[late]), level[late], 1)[0])


def _slope(rows: NDArray[np.float64]) -> float:
    return float(3600.0 * np.polyfit(rows[:, 0] - rows[0, 0], rows[:, 1], 1)[0])


def _calibrated_soles(take: Take, layout: SoleLayout) -> dict[Side, tuple[SoleLayout, SoleCalibration]]:
    """Layout and calibration of each sole of a motion; InputError for another take, or where they do not fit it."""
    if take.kind != "motion":
        raise InputError(f"{take.name} is of kind {take.kind}; allowed: motion, of a body that stands on its soles")
    soles = {}
    for side, counts in take.counts.items():
        sole = layout_for(side, layout)
        if sole is None or sole.calibration is None:
            raise InputError(f"layout '{layout.name}' holds no calibration of the {side} sole; see plantar calibrate")
        if counts.shape[1] != len(sole):
            raise InputError(f"{take.name}: {counts.shape[1]} counts of the {side} sole; allowed: {len(sole)}")
        soles[side] = (sole, sole.calibration)
    return soles


def _sums(force: NDArray[np.float64]) -> NDArray[np.float64]:
    """Sum (k,) of the taxels of each frame (k, n), NaN where none is known."""
    return np.where(np.isnan(force).all(axis=1), np.nan, np.nansum(force, axis=1))


def _weight(take: Take) -> float:
    assert isinstance(take.load, np.ndarray)  # of a motion
    return float(np.nanmedian(take.load))


def _phases(mask: NDArray[np.bool_], take: Take) -> list[tuple[int, int]]:
    return [(a, b) for a, b in true_runs(mask) if take.time[b - 1] - take.time[a] >= _SHORTEST]


def _still(total: NDArray[np.float64], rate: float) -> NDArray[np.bool_]:
    """Frames (k,) of the longest times in which the total is near its median and hardly changes."""
    width = max(1, round(_SHORTEST * rate))
    typical = float(np.nanmedian(total[total > 0.5 * np.nanquantile(total, 0.98)])) if (total > 0.0).any() else 0.0
    near = np.abs(total - typical) < 0.1 * typical
    out = np.zeros(len(total), dtype=bool)
    for a, b in true_runs(near):
        if b - a >= width:
            out[a:b] = True
    return out


def _still_lifted(
    own: NDArray[np.float64], total: NDArray[np.float64], weight: float, rate: float
) -> NDArray[np.bool_]:
    """Frames (k,) in which a sole is off the ground, without the tenth of a second beside touchdown and lift-off."""
    out = np.zeros(len(own), dtype=bool)
    for a, b in true_runs(own < _LIFTED * max(weight, float(np.nanmedian(total)))):
        margin = max(1, round(0.1 * rate))
        if b - a >= round(_SHORTEST * rate) // 2 + 2 * margin:
            out[a + margin : b - margin] = True
    return out
