"""Units, signs, order and zeros of the encoders, by the angles that were commanded and the soles' planes."""

import itertools
from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES
from plantar.gait.estimate.estimator import Posture
from plantar.gait.safety.bring_up.finding import Finding
from plantar.gait.safety.bring_up.motion import STOOD

_OFF = 0.12  # rad from the commanded angle at rest; drawn plants have 0.03
# rad: standard deviation of a joint's commanded motion that shows what it does, where it is more than that of what the
# joint moves by besides: ankles of a soft robot sway by more. Where noise counts a fifth less, 1 of 183 sound robots is
# refused, a fifth more none
_EXCITED = 2e-3
_SLOPE = (0.4, 1.8)  # of the measured over the commanded motion; drawn plants have 0.8 to 1.1
_FITS = 0.3  # share of the squared error that another order leaves, to be the cause
_NOISE = 3e-4  # rad of an encoder that is not worth another order
_PLANE = 0.12  # rad between a sole and level; drawn plants have 0.03
_DEGREES = 180.0 / np.pi

Trace = Mapping[str, NDArray[np.float64]]


def check_joints(trace: Trace, names: Sequence[str], late: int) -> list[Finding]:
    """Findings of encoders that are `late` ticks, with the joints' `names`, by the rows of standing and leaning."""
    rest = trace["time"] < STOOD
    expected = trace["expected"]
    measured = trace["joints"]
    mean_e = expected[rest].mean(axis=0)
    mean_m = measured[rest].mean(axis=0)
    moved_e = expected[: len(expected) - late] - mean_e
    moved_m = measured[late:] - mean_m
    off = mean_m - mean_e
    cause = moved_e - moved_e.mean(axis=0)
    effect = moved_m - moved_m.mean(axis=0)
    slope = (cause * effect).sum(axis=0) / np.maximum(np.square(cause).sum(axis=0), 1e-12)
    excited = cause.std(axis=0) > np.maximum(_EXCITED, (effect - slope * cause).std(axis=0))
    wrong = (np.abs(off) > _OFF) | (excited & ~((slope > _SLOPE[0]) & (slope < _SLOPE[1])))
    other = _other_order(mean_e, mean_m, moved_e, moved_m, names, bool(wrong.any()))
    if other is not None:
        return [other]
    return [
        _single(names[i], float(mean_e[i]), float(mean_m[i]), float(slope[i]), bool(excited[i]))
        for i in np.flatnonzero(wrong).tolist()
    ]


def check_planes(trace: Trace, posture: Callable[[NDArray[np.float64]], Posture], level: bool) -> list[Finding]:
    """Findings by the soles' planes at rest, `level` where the accelerometer shows what is up."""
    rest = trace["time"] < STOOD
    posed = posture(trace["joints"][rest].mean(axis=0))
    pull = trace["accelerometer"][rest].mean(axis=0)
    up = pull / max(float(np.linalg.norm(pull)), 1e-9)
    between = _angle(posed.rotations["left"][:, 2], posed.rotations["right"][:, 2])
    tilts = {side: _angle(posed.rotations[side][:, 2], up) for side in SIDES}
    allowed = f"within {_PLANE} rad"
    if between > _PLANE:
        worse = max(SIDES, key=lambda side: tilts[side])
        cause = f"an encoder of the {worse} leg off" if level else "an encoder off"
        return [Finding(cause, f"the soles' planes differ by {between:.2f} rad", allowed)]
    if level and min(tilts.values()) > _PLANE:
        text = f"the soles are tilted by {min(tilts.values()):.2f} rad by encoders and accelerometer"
        return [Finding("IMU mounted aslant, or ground that slopes", text, allowed)]
    return []


def _single(name: str, expected: float, measured: float, slope: float, excited: bool) -> Finding:
    text = f"it reads {measured:.3f} rad at rest where {expected:.3f} is commanded"
    moves = f", and moves by {slope:.2f} times the command" if excited else ""
    allowed = f"within {_OFF} rad, and {_SLOPE[0]} to {_SLOPE[1]} times"
    if abs(measured + expected) < 0.5 * _OFF and (not excited or slope < -_SLOPE[0]):
        return Finding(f"sign of the encoder of {name} turned", text + moves, allowed)
    if excited and abs(slope) < _SLOPE[0]:
        return Finding(f"encoder of {name} stuck", text + moves, allowed)
    return Finding(f"encoder of {name} off by {measured - expected:.2f} rad", text + moves, allowed)


def _other_order(
    mean_e: NDArray[np.float64],
    mean_m: NDArray[np.float64],
    moved_e: NDArray[np.float64],
    moved_m: NDArray[np.float64],
    names: Sequence[str],
    wrong: bool,
) -> Finding | None:
    """Another unit, sign or order of all or two encoders that explains what is measured far better."""
    count = len(names)

    def error(at: NDArray[np.float64], moves: NDArray[np.float64]) -> NDArray[np.float64]:
        off = np.maximum(np.abs(mean_m - at) - 0.25 * _OFF, 0.0)
        noise = np.square(_NOISE) * len(moves)
        return np.asarray(len(moves) * np.square(off) + np.maximum(np.square(moved_m - moves).sum(axis=0) - noise, 0.0))

    own = error(mean_e, moved_e)
    allowed = "angles of the joints as commanded"
    text = f"they miss the commanded angles by up to {np.abs(mean_m - mean_e).max():.2f} rad"
    if wrong:
        whole = {
            "joint angles in degrees": (_DEGREES * mean_e, _DEGREES * moved_e),
            "signs of all joint angles turned": (-mean_e, -moved_e),
        }
        for cause, (at, moves) in whole.items():
            if error(at, moves).sum() < _FITS * own.sum():
                return Finding(cause, text, allowed)
    legs = np.roll(np.arange(count), count // 2)
    floor = np.square(_NOISE) * len(moved_e)
    if own.sum() > count * floor and error(mean_e[legs], moved_e[:, legs]).sum() < _FITS * own.sum():
        return Finding("encoders of the legs exchanged", text, allowed)
    best: tuple[float, Finding | None] = (_FITS, None)
    for i, j in itertools.combinations(range(count), 2):
        pair = [i, j]
        if own[pair].sum() <= 2.0 * floor:
            continue
        order = np.arange(count)
        order[pair] = j, i
        share = float(error(mean_e[order], moved_e[:, order])[pair].sum() / own[pair].sum())
        if share < best[0]:
            words = f"each follows the other's command, {1.0 / max(share, 1e-3):.0f} times as well"
            best = share, Finding(f"encoders of {names[i]} and {names[j]} exchanged", words, allowed)
    return best[1]


def _angle(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    return float(np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b))
