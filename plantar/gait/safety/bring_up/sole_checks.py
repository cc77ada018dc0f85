"""Sides, scale and order of the soles' taxels, by the weight and how it moves."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.gait.safety.bring_up.delay_checks import MOST_LATE, period_of
from plantar.gait.safety.bring_up.finding import Finding
from plantar.gait.safety.bring_up.motion import FORWARD, SIDEWAYS, STOOD
from plantar.gait.safety.bring_up.response import delayed_response

_WEIGHT = (0.65, 1.5)  # of the model's weight on the soles; drawn plants have 0.8 to 1.2
_SILENT = 0.03  # weight on a sole that reports nothing
_ORDER = 0.2  # of the lean forward that the center of pressure makes; drawn plants have 0.6 to 1.3, soles on an edge 0
# share of a center of pressure's variance that the lean does not explain, in reversed order over as wired; of a sound
# sole ten times as much, of a reversed one a tenth, on four robots at levels 0 and 3. +-20 % refuses none of 123 drawn
# plants of ten robots; of 246 with one sole reversed 25 pass, with 20 % less 28, with 20 % more 22
_REVERSED = 0.3
# of the lean forward that both centers of pressure, weighted by load, make: the lean itself. Drawn plants of level 3 of
# ten robots were off it by 0.49 at most, with one sole reversed by 0.2 to 1.7; and by how much with that sole put
# right. Of those plants the first with 20 % less lets pass 5 fewer, the second with 20 % more refuses one that is sound
_LEAN_OFF = 0.6
_LEAN_NEAR = 0.35
# of the lean forward: by so much nearer to it both centers move with a sole in reversed order than as wired, where that
# sole's own moves against the lean, as yaw moves those of a soft robot apart by twice the lean. Measured: less on the
# two of 35 drawn h1_2 that were refused falsely; 20 % more lets pass one of those reversed soles more, 20 % less none
_NEARER = 0.1
_MIRRORED = -0.08  # likewise to the left, mean of both soles; drawn plants have 0.05 to 0.7
_APART = 2.5  # times the other sole's load at rest; drawn plants have 2.1
_GAIN = (0.5, 2.0)  # of a sole beside what its foot carries of the weight
_UNITS = (
    (10.0, "taxels ten times too large"),
    (0.1, "taxels ten times too small, or in kilograms"),
    (100.0, "taxels a hundred times too large, or in grams"),
    (0.01, "taxels a hundred times too small"),
    (1000.0, "taxels a thousand times too large, or in millinewtons"),
    (0.001, "taxels a thousand times too small, or in kilonewtons"),
    (0.2248, "taxels in pounds"),
)

Trace = Mapping[str, NDArray[np.float64]]


def check_standing_soles(trace: Trace, weight: float) -> list[Finding]:
    """Findings by the weight on both soles of a robot that stands, `weight` in N."""
    rest = trace["time"] < STOOD
    loads = {side: float(trace[f"load_{side}"][rest].mean()) / weight for side in SIDES}
    total = sum(loads.values())
    measured = f"{loads['left']:.3g} of the weight on the left sole, {loads['right']:.3g} on the right one"
    allowed = f"{_WEIGHT[0]} to {_WEIGHT[1]} on both"
    silent = [side for side in SIDES if abs(loads[side]) < _SILENT * max(1.0, abs(total))]
    if len(silent) == 2 and abs(total) < 5e-4:
        return [Finding("both soles silent, or not on the ground", measured, allowed)]
    if len(silent) == 1:
        return [Finding(f"{silent[0]} sole silent", measured, "a load on each")]
    if min(loads.values()) < 0.0:
        return [Finding("taxels' sign turned", measured, allowed)]
    if _WEIGHT[0] <= total <= _WEIGHT[1]:
        return []
    factor, cause = min(_UNITS, key=lambda unit: abs(np.log(total / unit[0])))
    ratio = max(loads.values()) / min(loads.values())
    if ratio > _APART:
        more = max(SIDES, key=lambda side: loads[side])
        cause = f"{more} sole reads {ratio:.1f} times as much as the other"
    elif abs(np.log(total / factor)) > np.log(1.35):
        cause = "mass of the robot's file, or scale of the taxels"
    return [Finding(cause, measured, allowed)]


def check_leaning_soles(trace: Trace) -> list[Finding]:
    """Findings by how loads and centers of pressure move as the robot leans."""
    found: list[Finding] = []
    left = trace["load_left"]
    right = trace["load_right"]
    share = left / np.maximum(np.abs(left + right), 1e-9)
    sideways = _during(trace, SIDEWAYS)
    moved = trace["vrp"][:, 1]
    width = _slope(moved[sideways], share[sideways], period_of(trace))
    if width < 0.0:
        text = f"the left sole's share changes by {width:.2f} per metre to the left"
        return [Finding("soles exchanged", text, "more on the left sole as the body leans left")]
    forward = _during(trace, FORWARD)
    lean = trace["vrp"][forward, 0]
    both = _slope(lean, _center(trace)[forward], period_of(trace))
    put_right = {side: _slope(lean, _center(trace, side)[forward], period_of(trace)) for side in SIDES}
    allowed = f"more than {_ORDER} times the lean forward"
    for side in SIDES:
        slope, rest = _response(lean, trace[f"center_{side}"][forward, 0], period_of(trace))
        turned, other = _response(lean, trace[f"reversed_{side}"][forward, 0], period_of(trace))
        # Where a list of taxels goes to and fro, its reverse mixes both axes, and may move forward, late and among much
        # else.
        against = slope < -_ORDER and abs(both - 1.0) - abs(put_right[side] - 1.0) > _NEARER
        if against or (turned > _ORDER and other < _REVERSED * rest):
            text = f"the {side} sole's center of pressure moves by {slope:.2f} times the lean forward"
            if not against:
                text += f", which explains {1.0 - rest:.2f} of it; in reversed order {turned:.2f} and {1.0 - other:.2f}"
            found.append(Finding(f"taxel order of the {side} sole reversed", text, allowed))
    if not found and abs(both - 1.0) > _LEAN_OFF:
        found += _nearer_reversed(both, put_right)
    if not found and both < _ORDER:
        text = f"the center of pressure moves by {both:.2f} times the lean forward"
        found.append(Finding("taxel order wrong", text, allowed))
    if not found:
        slopes = [_slope(moved[sideways], trace[f"center_{side}"][sideways, 1], period_of(trace)) for side in SIDES]
        if 0.5 * sum(slopes) < _MIRRORED:
            text = f"centers of pressure move by {slopes[0]:.2f} and {slopes[1]:.2f} times the lean to the left"
            found.append(Finding("taxels mirrored left to right", text, f"more than {_MIRRORED} on average"))
    return found


def _center(trace: Trace, turned: Side | None = None) -> NDArray[np.float64]:
    """Center of pressure (n,) in m forward of both soles by their loads, with one of them in reversed order or none."""
    total = np.zeros(len(trace["time"]))
    for side in SIDES:
        total += trace[f"load_{side}"] * trace[f"{'reversed' if side == turned else 'center'}_{side}"][:, 0]
    return np.asarray(total / (trace["load_left"] + trace["load_right"]))


def _nearer_reversed(both: float, slopes: Mapping[Side, float]) -> list[Finding]:
    """The sole in whose reversed order both centers move as the body leans, by `slopes` times the lean, which as wired
    move by `both` times the lean.
    """
    side = min(SIDES, key=lambda s: abs(slopes[s] - 1.0))
    if abs(slopes[side] - 1.0) > _LEAN_NEAR:
        return []
    text = (
        f"the center of pressure moves by {both:.2f} times the lean forward, with that sole reversed {slopes[side]:.2f}"
    )
    allowed = f"within {_LEAN_OFF} of the lean"
    return [Finding(f"taxel order of the {side} sole reversed", text, allowed)]


def check_unloaded_soles(trace: Trace, weight: float, width: float) -> list[Finding]:
    """Findings by each foot's unloading: `trace` of the shifts of `weight` in N between feet `width` in m apart."""
    period = period_of(trace)
    share = trace["vrp"][:, 1] / width
    gains: dict[Side, float] = {
        "left": _slope(share, trace["load_left"] / weight, period),
        "right": _slope(-share, trace["load_right"] / weight, period),
    }
    text = f"{gains['left']:.2f} of the moved weight comes to the left sole, {gains['right']:.2f} to the right one"
    allowed = f"{_GAIN[0]} to {_GAIN[1]} of both, and of one by the other"
    ratio = gains["left"] / max(gains["right"], 1e-9)
    if min(gains.values()) < 0.5 * _GAIN[0]:
        side = "left" if gains["left"] < gains["right"] else "right"
        return [Finding(f"{side} sole does not take the weight", text, allowed)]
    if not _GAIN[0] < ratio < _GAIN[1]:
        side, times = ("left", ratio) if ratio > 1.0 else ("right", 1.0 / ratio)
        return [Finding(f"{side} sole reads {times:.1f} times as much as the other", text, allowed)]
    return []


def _during(trace: Trace, span: tuple[float, float]) -> NDArray[np.bool_]:
    """Rows of a span in s."""
    return (trace["time"] > span[0]) & (trace["time"] < span[1])


def _slope(x: NDArray[np.float64], y: NDArray[np.float64], period: float) -> float:
    """Of the line through points (n,), at the delay of y that fits best."""
    return _response(x, y, period)[0]


def _response(x: NDArray[np.float64], y: NDArray[np.float64], period: float) -> tuple[float, float]:
    """Slope of that line, and the share of the variance of y that it leaves."""
    response, late = delayed_response(x[:, None], y[:, None], MOST_LATE, period, 0.02)
    slope = float(response[0, 0])
    rest = np.var(y[late:] - slope * x[: len(x) - late]) / max(float(np.var(y[late:])), 1e-30)
    return slope, float(rest)
