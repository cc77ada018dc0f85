"""Soles calibrated by takes: offsets first, then responses, and what the takes did not determine in words."""

import datetime
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.calibration.fit import CROSSTALK, CURVE, LOOPS, SHARED_SPREAD, Fitted, ResponseFit
from plantar.calibration.take import Take
from plantar.calibration.windows import Windows, windows_of
from plantar.common.arguments import instance
from plantar.common.sides import SIDES, Side
from plantar.errors import InputError
from plantar.layouts.calibration import SoleCalibration
from plantar.layouts.layout import SoleLayout
from plantar.recordings.pressure_recording import layout_for

# Quantile of a taxel's counts that counts as its largest: below the highest, so that one spike does not count; gains'
# median error is within half a percent from 0.98 to 0.9999.
_TOP = 0.995
# Share of a sole's range of summed counts, below which it is in the air. What still presses becomes offset: in
# benchmarks/calibration.py 0.09 N of a taxel (median) to 0.21 N; 0.12 and 0.40 N with a share of 0.12.
_LIFTED = 0.03
# Share of a sole's range of summed counts by which it may lie below its zero: more than hysteresis and drift of any
# cell that is listed (0.15).
_CARRIED = 0.2
_FEWEST_LIFTED = 20  # frames: their mean has a quarter of a frame's noise
SURE = 1.96
"""Standard errors from the middle of a 95 % interval to its end."""

# Share of the deviation that was assumed before: with more of that left than 1 / sqrt(2), the measurement knows less
# of a number than was assumed, and it was not observed.
_UNSEEN = 0.7


@dataclass(frozen=True, eq=False)
class Calibrated:
    """Result of a calibration.

    Attributes:
        layout: The layout with the calibration of each calibrated side, for `write_layout`.
        calibrations: Of each side.
        gain_spread: Relative standard deviation of the gains in the batch, as estimated.
        unobserved: What the takes did not determine, a sentence each.
    """

    layout: SoleLayout
    calibrations: Mapping[Side, SoleCalibration]
    gain_spread: float
    unobserved: tuple[str, ...]

    def as_dict(self) -> dict[str, Any]:
        """Plain values for JSON: of each side the gains' errors, offsets and shared numbers; what was not observed."""
        return {
            "layout": self.layout.name,
            "gain_spread": round(self.gain_spread, 4),
            "soles": {
                side: {
                    "taxels": len(known),
                    "gain_error_median": round(float(np.median(known.gain_error)), 4),
                    "gain_error_max": round(float(known.gain_error.max()), 4),
                    "crosstalk": round(known.crosstalk, 4),
                    "hysteresis": [round(float(share), 4) for share in known.hysteresis],
                    "curve": [round(float(term), 4) for term in known.curve],
                    "date": known.date,
                    "method": known.method,
                }
                for side, known in self.calibrations.items()
            },
            "unobserved": list(self.unobserved),
        }

    def text(self) -> str:
        """What was found, in lines."""
        lines = []
        for side, known in self.calibrations.items():
            error = 100.0 * SURE * known.gain_error
            lines.append(
                f"{side}: {len(known)} gains within {np.median(error):.1f} % (median) to {error.max():.1f} % at 95 %, "
                f"crosstalk {100.0 * known.crosstalk:.0f} %"
            )
        return "\n".join([*lines, *(f"  not observed: {line}" for line in self.unobserved)])


def calibrate(takes: Sequence[Take], layout: SoleLayout, date: str | None = None) -> Calibrated:
    """Gain, offset, response curve, hysteresis and crosstalk of soles, each gain with its standard error.

    Args:
        takes: Recordings of counts: one of kind "zero", or a foot that is lifted in another, gives the offsets; "press"
            or "motion" the rest.
        layout: Of one of the soles, mirrored for the other.
        date: Day that is stored, as 2026-03-01; today's where None.

    Returns:
        Layout with calibrations, and what was not observed.

    Raises:
        InputError: If takes do not fit the layout, hold no load, or give no offset of a sole.

    Example:
        >>> import numpy as np
        >>> from plantar import grid_layout
        >>> sole = grid_layout([[0, 0], [0.08, 0], [0.08, 0.04], [0, 0.04]], pitch=(0.04, 0.04))
        >>> time = np.arange(400) / 50
        >>> force = 40.0 * np.clip(np.sin(time)[:, None] * [1.0, -1.0], 0.0, None)  # one taxel after the other
        >>> counts = 100.0 + force * [8.0, 12.0]
        >>> air = Take("zero", time[:50], {"left": np.full((50, 2), 100.0)})
        >>> found = calibrate([air, Take("press", time, {"left": counts}, load=force.sum(axis=1))], sole)
        >>> (1.0 / found.calibrations["left"].gain).round().tolist()
        [8.0, 12.0]
    """
    instance(layout, SoleLayout, "layout")
    given = [instance(take, Take, "take") for take in takes]
    loaded = [take for take in given if take.kind != "zero"]
    if not loaded:
        raise InputError("no take holds a load; allowed: press or motion, one at least")
    sides = [side for side in SIDES if any(side in take.counts for take in loaded)]
    soles = {side: found for side in sides if (found := layout_for(side, layout)) is not None}
    for take in given:
        for side, counts in take.counts.items():
            if side in soles and counts.shape[1] != len(layout):
                raise InputError(f"{take.name}: {counts.shape[1]} counts of the {side} sole; allowed: {len(layout)}")
    offset = {side: _offset(side, given) for side in soles}
    _check_zeros(soles, given, offset)
    top = {side: _top(side, loaded, offset[side]) for side in soles}
    windows = [windows_of(take, offset, top) for take in loaded]
    reference = _reference(windows)
    fitted = ResponseFit(soles, windows, reference).solve()
    unobserved = _unobserved(fitted, layout, given)
    method = _method(given)
    day = datetime.date.today().isoformat() if date is None else date
    calibrations = {
        side: SoleCalibration(
            gain=fitted.gain[side],
            offset=offset[side],
            covariance=fitted.covariance[side],
            reference=reference,
            curve=fitted.shared[CURVE],
            curve_deviation=fitted.deviation[side],
            hysteresis=fitted.shared[LOOPS],
            top=top[side],
            crosstalk=float(fitted.shared[CROSSTALK]),
            shared_error=fitted.shared_error,
            date=day,
            method=method,
            unobserved=unobserved,
        )
        for side in soles
    }
    kept = {**layout.calibrations, **calibrations}
    return Calibrated(replace(layout, calibrations=kept), calibrations, fitted.gain_spread, unobserved)


def _offset(side: Side, takes: Sequence[Take]) -> NDArray[np.float64]:
    """Counts (n,) of a sole without load: of its zero takes, else of the frames in which it is lifted."""
    zeros = [take.counts[side] for take in takes if take.kind == "zero" and side in take.counts]
    if zeros:
        return _mean(np.concatenate(zeros), side)
    lifted = []
    for take in takes:
        if side in take.counts and take.kind == "motion":
            summed = np.nansum(take.counts[side], axis=1)
            low, high = np.quantile(summed, [0.002, 0.98])
            lifted.append(take.counts[side][summed < low + _LIFTED * (high - low)])
    found = np.concatenate(lifted) if lifted else np.zeros((0, 1))
    if len(found) < _FEWEST_LIFTED:
        raise InputError(f"nothing shows the {side} sole without load; allowed: a zero take, or a motion that lifts it")
    return _mean(found, side)


def _check_zeros(sides: Iterable[Side], takes: Sequence[Take], offset: Mapping[Side, NDArray[np.float64]]) -> None:
    """Refuse zero takes of soles that carried: counts under load would then lie below those without."""
    for side in sides:
        zeros = [take.name for take in takes if take.kind == "zero" and side in take.counts]
        for take in takes:
            if take.kind == "zero" or side not in take.counts or not zeros:
                continue
            low, high = np.nanquantile(np.nansum(take.counts[side] - offset[side], axis=1), [0.002, 0.98])
            if high > low and low < -_CARRIED * (high - low):
                raise InputError(
                    f"{zeros[0]}: without load the {side} sole gives more than in {take.name} at its least, by "
                    f"{-100.0 * low / (high - low):.0f} % of the range there; allowed: {100.0 * _CARRIED:.0f} % or "
                    "less, so a zero take of soles in the air"
                )


def _mean(counts: NDArray[np.float64], side: Side) -> NDArray[np.float64]:
    missing = np.isnan(counts).all(axis=0)
    if missing.any():
        raise InputError(f"taxel {int(np.argmax(missing))} of the {side} sole gave no count without load")
    return np.asarray(np.nanmean(counts, axis=0))


def _top(side: Side, takes: Sequence[Take], offset: NDArray[np.float64]) -> NDArray[np.float64]:
    """Counts (n,) above the offset that each taxel reaches; at least a hundredth of the sole's largest."""
    above = np.concatenate([take.counts[side] for take in takes if side in take.counts]) - offset
    top = np.nanquantile(above, _TOP, axis=0)
    return np.maximum(top, max(1e-9, 0.01 * float(np.nanmax(top))))


def _reference(windows: Sequence[Windows]) -> float:
    """Load in N that the average newton of a take lies on: that of a taxel, by one gain for all."""
    if not any(take.usable.any() for take in windows):
        raise InputError(
            "no take holds a load that is known: by weight alone a body stands or leans for over 3 s without lifting a "
            "foot, and no count is at its converter's end; allowed: such a take, one with --reference, or --press"
        )
    square = 0.0
    simple = 0.0
    for take in windows:
        counts = np.concatenate([sole.above for sole in take.soles.values()], axis=1)[take.usable]
        summed = counts.sum(axis=1)
        used = summed > 0.1 * summed.max(initial=0.0)
        gain = float(np.median(take.load[take.usable][used] / summed[used])) if used.any() else 0.0
        square += float((gain * counts**2).sum()) * gain
        simple += float((gain * np.abs(counts)).sum())
    if not simple > 0.0:
        raise InputError("the takes hold no counts above those without load; allowed: soles that carry")
    return square / simple


def _method(takes: Sequence[Take]) -> str:
    parts = []
    for kind, words in (
        ("zero", "without load"),
        ("press", "pressed by known forces"),
        ("motion", "standing and stepping"),
    ):
        chosen = [take for take in takes if take.kind == kind]
        if chosen:
            seconds = sum(float(take.time[-1] - take.time[0]) for take in chosen)
            by_cop = " with centers of pressure" if any(take.cop for take in chosen) else ""
            by_load = " by weight" if kind == "motion" and not by_cop else ""
            parts.append(f"{seconds:.0f} s {words}{by_load}{by_cop}")
    return ", ".join(parts)


def _unobserved(fitted: Fitted, layout: SoleLayout, takes: Sequence[Take]) -> tuple[str, ...]:
    lines = []
    for side, covariance in fitted.covariance.items():
        weak = np.sqrt(np.diag(covariance)) > _UNSEEN * fitted.gain_spread
        if weak.any():
            ids = ", ".join(str(layout.ids[i]) for i in np.flatnonzero(weak)[:12])
            more = f" and {int(weak.sum()) - 12} more" if weak.sum() > 12 else ""
            lines.append(
                f"gains of {int(weak.sum())} taxels of the {side} sole, which are little more than the batch's mean: "
                f"{ids}{more}; press them one by one"
            )
    seen = fitted.shared_error < _UNSEEN * SHARED_SPREAD
    if not seen[CURVE][0]:
        lines.append("the response's curve: loads hardly varied; press harder and more lightly")
    if not seen[CROSSTALK]:
        lines.append("crosstalk: no load lay on few taxels while its center of pressure was known")
    if not seen[LOOPS].any():
        lines.append("hysteresis: loads rose and fell too little")
    if not any(take.kind == "zero" for take in takes):
        lines.append("offsets were taken while the soles were lifted; a zero take shows them longer")
    return tuple(lines)
