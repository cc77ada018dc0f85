"""Sides, scale and order of the soles' taxels, by the weight and how it moves."""

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.gait.safety.bring_up.body_motion import SPAN, BodyMotion, smoothed
from plantar.gait.safety.bring_up.delay_checks import period_of
from plantar.gait.safety.bring_up.finding import Finding
from plantar.gait.safety.bring_up.motion import PITCHES, ROLLED, STOOD
from plantar.gait.safety.bring_up.response import response

_WEIGHT = (0.65, 1.5)  # of the model's weight on the soles; drawn plants have 0.8 to 1.2
_SILENT = 0.03  # weight on a sole that reports nothing
# derived: of the CoM's height, 1 sigma along an axis of a CoM that lies within 1/20 leg of its model's: level 3. Half
# or twice as much refuses none of 185 drawn plants of ten robots, and passes none of their 555 reversed orders; so do
# half as many independent values, or half more
_PLACE = 1 / 60
# chosen: twice the logarithm of 20, by which another order has to be likelier to count. A sound HRP-2 Kai has 2.1, the
# least of those 555 reversed orders 7.3: 20 % more or less changes neither
_LIKELIER = 6.0
# derived: of the ZMP that encoders show, half of what both centers, weighted by load, move by where they follow it.
# Those 185 plants have 0.74 to 1.2; of 60 pairs of soles in an order drawn at random 59 are named, with
# 20 % less or more, too
_FOLLOWS = 0.5
# derived: of that ZMP to the left, by which the centers move in the mean. It is m = 0.36 with a standard deviation of
# s = 0.20 on 100 drawn plants, and -m where taxels are mirrored: 20 times as likely from -log(20) s^2 / (2 m)
_MIRRORED = -0.16
_APART = 2.5  # times the other sole's load at rest; drawn plants have 2.1
# derived: times the other sole's share of the weight that each takes: 3.9 standard deviations of that ratio's logarithm
# over drawn plants of JVRC-1, whose it varies most of ten robots (0.24), 5.6 of all 200 (0.16); they have up to 2.0
_UNEVEN = 2.5
# chosen: of the weight that moves onto a foot, which its sole takes at least; those plants have 0.36 or more
_TAKEN = 0.25
_UNITS = (
    (10.0, "taxels ten times too large"),
    (0.1, "taxels ten times too small, or in kilograms"),
    (100.0, "taxels a hundred times too large, or in grams"),
    (0.01, "taxels a hundred times too small"),
    (1000.0, "taxels a thousand times too large, or in millinewtons"),
    (0.001, "taxels a thousand times too small, or in kilonewtons"),
    (0.2248, "taxels in pounds"),
)

# Soles whose taxels may come in reversed order
_ORDERS: tuple[tuple[Side, ...], ...] = ((), ("left",), ("right",), ("left", "right"))

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


def check_leaning_soles(trace: Trace, motion: BodyMotion) -> list[Finding]:
    """Findings by how loads and centers of pressure move as the body does."""
    period = period_of(trace)
    time = smoothed(trace["time"], period)
    sideways = time > ROLLED + SPAN
    left = trace["load_left"]
    share = left / np.maximum(np.abs(left + trace["load_right"]), 1e-9)
    width = _slope(motion.zmp[sideways, 1], smoothed(share, period)[sideways])
    if width < 0.0:
        text = f"the left sole's share changes by {width:.2f} per metre to the left"
        return [Finding("soles exchanged", text, "more on the left sole as the body leans left")]
    forward = time < PITCHES - SPAN
    zmp = motion.zmp[forward, 0]
    off = {order: smoothed(_center(trace, order), period)[forward] - zmp for order in _ORDERS}
    count = float(np.ptp(time[forward])) / (2.0 * SPAN)
    unlikely = {order: _unlikely(off[order], count, _PLACE * motion.height) for order in _ORDERS}
    best = min(_ORDERS, key=lambda order: unlikely[order])
    text = f"both centers of pressure are off the ZMP that encoders show by {_spread(off[()])}"
    if unlikely[()] - unlikely[best] > _LIKELIER:
        text += f", and with that order reversed by {_spread(off[best])}"
        return [
            Finding(f"taxel order of the {side} sole reversed", text, "not 20 times likelier reversed") for side in best
        ]
    both = _slope(zmp, off[()] + zmp)
    if both < _FOLLOWS:
        text += f", and move by {both:.2f} times that ZMP"
        return [Finding("taxel order wrong", text, f"more than {_FOLLOWS} times")]
    slopes = [
        _slope(motion.zmp[sideways, 1], smoothed(trace[f"center_{side}"][:, 1], period)[sideways]) for side in SIDES
    ]
    if 0.5 * sum(slopes) < _MIRRORED:
        text = f"centers of pressure move by {slopes[0]:.2f} and {slopes[1]:.2f} times the ZMP to the left"
        return [Finding("taxels mirrored left to right", text, f"more than {_MIRRORED} on average")]
    return []


def _unlikely(off: NDArray[np.float64], count: float, place: float) -> float:
    """Minus twice the logarithm of the likelihood of what centers are `off` (n,) in m, but for a constant.

    It holds `count` independent values of one unknown variance, about a mean that is of a `place` in m, 1 sigma.
    """
    return count * math.log(max(float(np.var(off)), 1e-30)) + (float(np.mean(off)) / place) ** 2


def _spread(off: NDArray[np.float64]) -> str:
    """In words: mean and standard deviation of `off` (n,) in m."""
    return f"{1e3 * float(np.mean(off)):.1f} +- {1e3 * float(np.std(off)):.1f} mm"


def _center(trace: Trace, turned: Sequence[Side]) -> NDArray[np.float64]:
    """Center of pressure (n,) in m forward of both soles by their loads, with those of some in reversed order."""
    total = np.zeros(len(trace["time"]))
    for side in SIDES:
        total += trace[f"load_{side}"] * trace[f"{'reversed' if side in turned else 'center'}_{side}"][:, 0]
    return np.asarray(total / (trace["load_left"] + trace["load_right"]))


def check_unloaded_soles(trace: Trace, motion: BodyMotion, weight: float, width: float) -> list[Finding]:
    """Findings by each foot's unloading: `trace` of the shifts of `weight` in N between feet `width` in m apart."""
    period = period_of(trace)
    share = motion.zmp[:, 1] / width
    loads = {side: smoothed(trace[f"load_{side}"], period) / weight for side in SIDES}
    gains: dict[Side, float] = {"left": _slope(share, loads["left"]), "right": _slope(-share, loads["right"])}
    text = f"{gains['left']:.2f} of the moved weight comes to the left sole, {gains['right']:.2f} to the right one"
    allowed = f"{_TAKEN} or more on each, and up to {_UNEVEN} times as much as on the other"
    ratio = gains["left"] / max(gains["right"], 1e-9)
    if min(gains.values()) < _TAKEN:
        side = "left" if gains["left"] < gains["right"] else "right"
        return [Finding(f"{side} sole does not take the weight", text, allowed)]
    if not 1.0 / _UNEVEN < ratio < _UNEVEN:
        side, times = ("left", ratio) if ratio > 1.0 else ("right", 1.0 / ratio)
        return [Finding(f"{side} sole reads {times:.1f} times as much as the other", text, allowed)]
    return []


def _slope(x: NDArray[np.float64], y: NDArray[np.float64]) -> float:
    """Of the line through points (n,)."""
    return float(response(x[:, None], y[:, None])[0, 0])
