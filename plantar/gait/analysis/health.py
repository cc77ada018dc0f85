"""Doubts about a recording: silent cells, creeping gain, clocks, mirrored feet, impossible weight."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.common.gravity import GRAVITY
from plantar.common.sides import SIDES, Side, other_side
from plantar.gait.analysis.steps.baseline import resting_level
from plantar.gait.analysis.steps.foot_gait import FootGait
from plantar.gait.analysis.summary import spread
from plantar.layouts.layout import SoleLayout
from plantar.recordings.frame_table import let_go
from plantar.recordings.pressure_recording import FootRecording, PressureRecording

_BESIDE = 1.7  # Usual distances between cells up to which they are neighbours: the eight around a cell of a matrix
_CARRIES = 0.15  # Largest reading of a cell that carries load, as a share of the high ones
# Share of a cell's neighbours that carry, and largest angle in degrees without one, where an unloaded part of a sole
# would not lie: at its edge the angle is 180.
_AROUND = 0.6
_GAP = 170.0
# Share of cells that read 0 where the other foot's carry, from which all of these are silent: feet differ by less.
_MANY = 0.08
_MISSING = 0.01  # Share of the force that silent cells lack from which it is reported
# Cells from which neighbours are near enough to read alike, and the ratio of their difference to that of any two cells
# from which they do not: insoles of three makers have 0.1 to 0.26, exchanged rows and columns 0.8.
_MOSAIC = 32
_UNLIKE = 0.6
# Steps, change of a step's mean force from first to last, and standard errors of it, from which gain creeps.
_FEWEST = 8
_CREEP = 0.08
_CLEAR = 5.0
# Difference of the feet's strides, relative to their mean, which no walk has; strides that show it.
_UNEQUAL = 0.05
_STRIDES = 4


# Peak of a foot as a share of the other's, and a cell's part of its foot's load as a multiple of the other foot's,
# which no walk without crutches, and no foot, differs by.
_WEAK = 0.6
_OTHERWISE = 6.0


class SilentCells(NamedTuple):
    """Cells that read 0 among loaded cells.

    `cells`: indices (m,); `missing`: force they lack, as share of the foot's.
    """

    cells: NDArray[np.int64]
    missing: float


def silent_cells(foot: FootRecording, other: FootRecording | None = None) -> SilentCells:
    """Returns an insole foot's cells that read 0 among loaded ones, and the missing force.

    A silent cell lacks its loaded neighbours' mean pressure; the other foot's mirrored cells show load at the edge.
    Of a few cells without places, those of the same number show it.
    """
    layout = foot.layout
    none = SilentCells(np.zeros(0, dtype=np.int64), 0.0)
    if layout is None or len(layout) < 8:
        return none if other is None else _silent_beside(foot, other) or none
    top = foot.extremes[1] / layout.areas
    zero = top <= 0.0
    if not zero.any() or zero.all():
        return none
    beside = _neighbours(layout)
    carries = top > _CARRIES * float(np.percentile(top[~zero], 90.0))
    mirror = np.zeros(len(layout), dtype=bool)
    if other is not None and other.layout is not None:
        theirs = other.extremes[1] / other.layout.areas
        mirror = _at_mirrored(layout, other.layout, theirs > _CARRIES * float(np.percentile(theirs, 90.0)))
    silent = zero & mirror if (zero & mirror).sum() >= _MANY * len(layout) else np.zeros(len(layout), dtype=bool)
    for _ in range(3):  # silent cells next to silent ones are found by those that were found
        loaded = carries | silent
        dark = np.flatnonzero(zero & ~silent).tolist()
        found = [i for i in dark if _inside(layout, i, beside[i], loaded, bool(mirror[i]))]
        if not found:
            break
        silent[found] = True
    cells = np.flatnonzero(silent)
    if not len(cells):
        return none
    total = foot.vertical_force if foot.total is None else np.nansum(foot.force, axis=1)
    high = np.flatnonzero(total >= 0.5 * np.nanpercentile(total, 99.0))
    high = high[:: max(1, len(high) // 2000)]
    part = foot.force[high]
    pressure = np.nansum(part, axis=0) / np.maximum(np.isfinite(part).sum(axis=0), 1) / layout.areas
    let_go(foot.force)
    lacking = 0.0
    for i in cells:
        near = [k for k in beside[i] if not zero[k]]
        near = near or list(
            np.argsort(np.hypot(*(layout.positions[:, :2] - layout.positions[i, :2]).T) + 1e3 * zero)[:3]
        )
        lacking += float(pressure[near].mean() * layout.areas[i])
    whole = float((pressure * layout.areas).sum()) + lacking
    return SilentCells(cells, lacking / whole if whole > 0.0 else 0.0)


def _silent_beside(own: FootRecording, theirs: FootRecording) -> SilentCells | None:
    """Cells that read 0 where the other foot's carry load, if it has fewer of them: else their order may differ."""
    if own.force.shape[1] != theirs.force.shape[1] or own.force.shape[1] >= _MOSAIC:
        return None
    zero = own.extremes[1] <= 0.0
    top = theirs.extremes[1]
    silent = zero & (top > _CARRIES * float(np.percentile(top, 90.0)))
    if not silent.any() or zero.all() or zero.sum() <= (top <= 0.0).sum():
        return None
    load = np.nan_to_num(theirs.force).sum(axis=0)
    return SilentCells(np.flatnonzero(silent), float(load[silent].sum() / load.sum()))


def _neighbours(layout: SoleLayout) -> list[NDArray[np.int64]]:
    points = layout.positions[:, :2]
    away = np.hypot(*(points[:, None] - points[None]).transpose(2, 0, 1))
    np.fill_diagonal(away, np.inf)
    nearest = away.min(axis=1)
    return [
        np.flatnonzero(row < _BESIDE * max(own, float(np.median(nearest))))
        for row, own in zip(away, nearest, strict=True)
    ]


def _at_mirrored(layout: SoleLayout, other: SoleLayout, marked: NDArray[np.bool_]) -> NDArray[np.bool_]:
    away = np.abs(layout.positions[:, None, :2] * [1.0, -1.0] - other.positions[None, :, :2]).max(axis=2)
    alike = away.min(axis=1).max() < 0.5 * float(np.sqrt(layout.areas.mean()))
    return marked[away.argmin(axis=1)] if alike else np.zeros(len(layout), dtype=bool)


def _inside(layout: SoleLayout, cell: int, beside: NDArray[np.int64], loaded: NDArray[np.bool_], mirror: bool) -> bool:
    on = beside[loaded[beside]]
    if not len(beside) or len(on) < _AROUND * len(beside):
        return False
    way = layout.positions[on, :2] - layout.positions[cell, :2]
    angles = np.sort(np.degrees(np.arctan2(way[:, 1], way[:, 0])))
    return float(np.diff(np.append(angles, angles[0] + 360.0)).max()) < _GAP or (mirror and len(on) == len(beside))


def silent_cell_doubts(recording: PressureRecording) -> list[str]:
    """Warning of each insole with silent cells, with the missing force."""
    out = []
    for side, foot in recording.feet.items() if recording.kind == "insole" else ():
        found = silent_cells(foot, recording.feet.get(other_side(side)))
        if found.missing >= _MISSING:
            cells = found.cells
            count = foot.force.shape[1]
            names = ", ".join(str(i) for i in (cells + 1 if foot.layout is None else foot.layout.ids[cells])[:12])
            beside = "the same cells of the other foot" if count < 8 or foot.layout is None else "cells around them"
            out.append(
                f"{len(cells)} of {count} cells of the {side} foot read 0 throughout though {beside} carry load "
                f"({names}{', ...' if len(cells) > 12 else ''}): its forces are about {100.0 * found.missing:.2g} % "
                "too low, by the pressure there"
            )
    return out


def inverted_doubts(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> list[str]:
    """Returns a warning where `feet` of a `recording` have no steps, but their forces, upside down, are of a walk."""
    rate = recording.rate_hz
    forces = [foot.vertical_force for foot in recording.feet.values()]
    without_steps = recording.kind in ("insole", "plate") and not any(gait.steps for gait in feet.values())
    if not without_steps or any(resting_level(f, rate) or not resting_level(-f, rate) for f in forces):
        return []
    return [
        "values rest at their largest and dip again and again, as a walk upside down: the sensors may be inverted; "
        "allowed: values that grow with load"
    ]


def scrambled_doubts(recording: PressureRecording) -> list[str]:
    """Warning of insoles whose neighbouring cells read as differently as any two (Geary 1954)."""
    out = []
    for side, foot in recording.feet.items() if recording.kind == "insole" else ():
        if foot.layout is None or len(foot.layout) < _MOSAIC or not len(foot.force):
            continue
        load = np.nan_to_num(foot.vertical_force)
        high = np.flatnonzero(load > 0.5 * np.percentile(load, 99.0))
        value = np.nan_to_num(foot.force[high[:: max(1, len(high) // 50)]]) / foot.layout.areas
        near = foot.layout.neighbours
        one = np.repeat(np.arange(len(near)), [*map(len, near)])
        other = np.array([k for own in near for k in own], int)
        apart = ((value[:, one] - value[:, other]) ** 2).mean(axis=1)
        spread = 2.0 * value.var(axis=1)
        if (spread > 0.0).sum() > 10 and float(np.median(apart[spread > 0.0] / spread[spread > 0.0])) > _UNLIKE:
            out.append(
                f"neighbouring cells of the {side} foot read as differently as distant ones, which no foot's do: check "
                "the order of the cells (rows and columns exchanged?) and the layout; CoP and regions depend on them"
            )
    return out


def creep_doubts(feet: Mapping[Side, FootGait]) -> list[str]:
    """Warning where a foot's mean force changes steadily from first to last step: the gain creeps."""
    out = []
    for side, gait in feet.items():
        time = np.array([step.heel_strike_s for step in gait.used])
        force = np.array([step["impulse_Ns"] / step["stride_time_s"] for step in gait.used])
        known = np.isfinite(force)
        if known.sum() < _FEWEST:
            continue
        time = time[known] - time[known].mean()
        force = force[known]
        slope = float((time @ force) / (time @ time))
        rest = force - force.mean() - slope * time
        error = float(np.sqrt((rest @ rest) / (len(time) - 2) / (time @ time)))
        change = slope * float(np.ptp(time)) / float(force.mean())
        if abs(change) > _CREEP and abs(slope) > _CLEAR * error:
            out.append(
                f"the {side} foot's force a stride {'grows' if change > 0.0 else 'falls'} by "
                f"{100.0 * abs(change):.0f} % from first to last step, which body weight does not: the sensor's "
                f"gain creeps, and forces err by up to {50.0 * abs(change):.0f} % around their mean"
            )
    return out


def uneven_doubts(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> list[str]:
    """Warnings where a walk's feet, or the same cells of both, carry loads that differ more than feet do."""
    if recording.kind not in ("insole", "plate") or recording.raw or set(feet) != set(SIDES):
        return []
    steps = {side: [s["peak_force_N"] for s in gait.used] for side, gait in feet.items()}
    if min(map(len, steps.values())) < _STRIDES:
        return []
    out = []
    peaks = {side: float(np.nanmedian(own)) for side, own in steps.items()}
    weak = min(peaks, key=lambda side: peaks[side])
    share = peaks[weak] / peaks[other_side(weak)]
    if share < _WEAK:
        out.append(
            f"the {weak} foot carries no more than {100.0 * share:.0f} % of what the {other_side(weak)} one does, and "
            "in single support each carries the body: a sensor's gain or unit? Its forces may be too small by that"
        )
    cells = {recording.feet[side].force.shape[1] for side in SIDES}
    if recording.kind == "plate" or len(cells) > 1 or not 1 < min(cells) < _MOSAIC:
        return out
    left, right = (np.nansum(recording.feet[side].force, axis=0) for side in SIDES)
    if not (left.sum() > 0.0 and right.sum() > 0.0):
        return out
    ratio = (left / left.sum() + 1e-9) / (right / right.sum() + 1e-9)
    odd = np.flatnonzero((np.maximum(ratio, 1.0 / ratio) > _OTHERWISE) & (np.minimum(left, right) > 0.0))
    if 0 < len(odd) <= 0.3 * len(left):
        ids = recording.feet["left"].layout
        names = ", ".join(str(i) for i in (odd + 1 if ids is None else ids.ids[odd]))
        most = float(np.maximum(ratio, 1.0 / ratio)[odd].max())
        out.append(
            f"cell {names} carries {most:.2g} times as large a part of one "
            "foot's load as of the other's: a cell's gain? Forces and contact times may err by its part"
        )
    return out


def unequal_strides(feet: Mapping[Side, FootGait]) -> float | None:
    """Left strides less right ones, relative to their mean, where too large for a walk.

    It shows two clocks or two people; else None.
    """
    if len(feet) < 2:
        return None
    middles = []
    for side in SIDES:
        strides = np.array([step["stride_time_s"] for step in feet[side].steps])
        strides = strides[np.isfinite(strides)]
        if len(strides) < _STRIDES:
            return None
        middles.append(float(np.median(strides)))
    difference = 2.0 * (middles[0] - middles[1]) / (middles[0] + middles[1])
    return difference if abs(difference) > _UNEQUAL else None


# Masses in kg of people whose feet are measured; a wrong unit of pressure is wrong by 6.9 times or more.
MASSES = (20.0, 200.0)
# Largest force of a step in walking in body weights, for recordings of single steps (Perry & Burnfield 2010).
_STEPPING = 1.1
_FULL = 1.05  # Share of its range that a taxel may read before it is more than its maker rated


def implied_weight(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> float | None:
    """Returns implied weight in N of the body in a recording of these feet; None of raw counts or if unknown.

    Impulses of both feet (of one foot twice) over the stride time; without strides the largest force over 1.1; in
    standing the mean force of both feet.
    """
    if recording.raw:
        return None
    impulses, strides, peaks = (_medians(feet, key) for key in ("impulse_Ns", "stride_time_s", "peak_force_N"))
    if strides and impulses:
        return 2.0 * float(np.mean(impulses)) / float(np.mean(strides))
    if peaks or any(gait.steps for gait in feet.values()):
        return float(np.mean(peaks)) / _STEPPING if peaks else None
    measured = [foot.vertical_force[np.isfinite(foot.vertical_force)] for foot in recording.feet.values()]
    forces = [float(force.mean()) for force in measured if len(force)]
    return sum(forces) if len(forces) == 2 and min(forces) > 0.0 else None


def _medians(feet: Mapping[Side, FootGait], key: str) -> list[float]:
    spreads = (spread(gait.columns.get(key, ())) for gait in feet.values())
    return [one.median for one in spreads if one.median is not None]


def weight_doubts(recording: PressureRecording, weight: float | None) -> list[str]:
    """Returns warnings where a recording implies an impossible weight in N, or taxels exceed their range."""
    if recording.kind == "robot":
        return [line for foot in recording.feet.values() if (line := _overload(recording, foot.side))]
    if weight is None or MASSES[0] <= weight / GRAVITY <= MASSES[1]:
        return []
    return [
        f"the forces imply a person of {weight / GRAVITY:.3g} kg; people of {MASSES[0]:g} to {MASSES[1]:g} kg are "
        "usual: check the unit, the cell size and the insole's size (--unit, --layout, --insole-size override)"
    ]


def _overload(recording: PressureRecording, side: Side) -> str:
    foot = recording.feet[side]
    if foot.layout is None or recording.raw or "force" not in foot.layout.ranges or not len(foot.force):
        return ""
    highest = float(foot.extremes[1].max())
    rated = float(max(foot.layout.ranges["force"]))
    if not rated > 0.0 or highest <= _FULL * rated:
        return ""
    return f"a taxel of the {side} sole reads {highest:.4g} N, its layout rates it for {rated:.4g} N: check the unit"


# Parts of the sole's length from the heel on
_MIDFOOT = (0.30, 0.55)
_TOES = (0.78, 1.01)
# Mean of both feet, and of one alone, from which they look mirrored; in four vendors' recordings it is 0.08 to 0.98.
_MIRRORED = -0.1
_MIRRORED_ONE = -0.2


def mirrored_doubts(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> list[str]:
    """Returns warning where steps of feet show that a recording's insoles are mirrored."""
    if recording.kind != "insole" or not all(gait.steps for gait in feet.values()):
        return []
    inward = [inward_of_toes(gait) for gait in feet.values()]
    one = f"the {next(iter(feet))} foot carries" if len(feet) == 1 else ""
    if not all(value < 0.0 for value in inward) or np.mean(inward) > (_MIRRORED_ONE if one else _MIRRORED):
        return []
    return [
        f"{one or 'both feet carry'} more inside at the midfoot and outside at the toes, as mirrored feet do: check "
        "which insole is left and which right (--side), and from which side the columns of cells are counted"
    ]


def inward_of_toes(gait: FootGait) -> float:
    """Toes' load inside of the midfoot's, in half sole widths; NaN without load or geometry."""
    layout = gait.foot.layout
    picture = gait.picture
    if layout is None or picture is None:
        return float("nan")
    x = layout.positions[:, 0]
    y = layout.positions[:, 1] * (1.0 if gait.foot.side == "right" else -1.0)
    back, front = (float(v) for v in (layout.outline[:, 0].min(), layout.outline[:, 0].max()))
    along = (x - back) / (front - back)
    half = 0.5 * float(np.ptp(layout.outline[:, 1]))
    toes, midfoot = (_inward(y, layout.areas, picture, (along >= a) & (along < b)) for a, b in (_TOES, _MIDFOOT))
    return (toes - midfoot) / half


def _inward(
    y: NDArray[np.float64], areas: NDArray[np.float64], pressure: NDArray[np.float64], part: NDArray[np.bool_]
) -> float:
    load = pressure[part] * areas[part]
    if not load.sum() > 0.0:
        return float("nan")
    return float((y[part] * load).sum() / load.sum() - (y[part] * areas[part]).sum() / areas[part].sum())
