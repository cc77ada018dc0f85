"""Strides of a foot by the inertial sensor of its insole: integrated from one stance to the next, at rest in both."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.common.gravity import GRAVITY
from plantar.gait.analysis.steps.events import Contact
from plantar.recordings.pressure_recording import true_runs

# Measured: on two recordings with a maker's report (28 strides, `test_inertial_strides`), each of these 20 % smaller or
# larger alone (`_FEWEST_RESTS` by one) moves the median stride by 0.23 % (`_REST`) or not at all (others), and loses
# none: no gap or drift there is within 20 % of its bound.
SLOWEST_RATE = 50.0
"""Rate in Hz below which a swing of half a second has too few samples to be integrated."""

_REST = 0.05  # s before and after the moment of rest over which gravity and the gyroscope's offset are averaged
_STANCE = (0.15, 0.75)  # Shares of the stance in which the foot lies flat: it rolls on before and after
_LONGEST_GAP = 0.03  # s without samples that are bridged; beyond, a stride is not known
_MOST_DRIFT = 1.0  # m/s of velocity left at the next rest: the sensor was struck, or is not on this foot
_FEWEST_RESTS = 3  # from which the gyroscope's offset is known


def inertial_strides(
    time: NDArray[np.float64], motion: NDArray[np.float64], contacts: Sequence[Contact]
) -> list[float]:
    """Returns length in m of each complete contact's stride, to the next contact of the same foot; NaN where unknown.

    From the quietest moment of each stance the angular rate gives the sensor's direction, gravity at rest its tilt, and
    acceleration without gravity the velocity, whose rest at the next stance takes off what has drifted, evenly over
    the stride (Skog et al. 2010, IEEE Trans. Biomed. Eng. 57:2657).

    Args:
        time: Times (n,) in s.
        motion: Acceleration in m/s^2 and angular rate in rad/s (n, 6) in the sensor's own axes; NaN if unmeasured.
        contacts: All contacts of the foot.
    """
    known: NDArray[np.bool_] = np.asarray(np.isfinite(motion).all(axis=1))
    out = [math.nan] * sum(contact.complete for contact in contacts)
    if len(time) < 2 or known.sum() < 2:
        return out
    period = float(np.median(np.diff(time)))
    if period <= 0.0 or 1.0 / period < SLOWEST_RATE:
        return out
    half = max(1, round(_REST / period))
    rests = [_rest(motion, known, contact, half) for contact in contacts]
    still = [motion[at - half : at + half + 1, 3:].mean(axis=0) for at in rests if at is not None]
    if len(still) < _FEWEST_RESTS:
        return out
    offset = np.median(still, axis=0)
    bridged = _bridged(time, motion, known)
    number = 0
    for i, contact in enumerate(contacts):
        if not contact.complete:
            continue
        after = contacts[i + 1] if i + 1 < len(contacts) else None
        begin = rests[i]
        end = rests[i + 1] if after is not None else None
        follows = after is not None and after.complete and after.walk == contact.walk
        if follows and begin is not None and end is not None and not _gap(known[begin:end], _LONGEST_GAP / period):
            out[number] = _length(time[begin : end + 1], bridged, begin, end, half, offset)
        number += 1
    return out


def _rest(motion: NDArray[np.float64], known: NDArray[np.bool_], contact: Contact, half: int) -> int | None:
    """Frame of the quietest moment of a stance: that of the least mean change of the angular rate's direction."""
    if not contact.complete:
        return None
    count = contact.end - contact.begin
    first = max(half, contact.begin + math.ceil(_STANCE[0] * count))
    last = min(len(motion) - half - 1, contact.begin + math.floor(_STANCE[1] * count))
    best: tuple[float, int] | None = None
    for at in range(first, last + 1):
        span = slice(at - half, at + half + 1)
        if known[span].all():
            spread = float(motion[span, 3:].var(axis=0).sum() + motion[span, :3].var(axis=0).sum() / GRAVITY**2)
            best = (spread, at) if best is None or spread < best[0] else best
    return None if best is None else best[1]


def _bridged(time: NDArray[np.float64], motion: NDArray[np.float64], known: NDArray[np.bool_]) -> NDArray[np.float64]:
    out = motion.copy()
    for column in range(motion.shape[1]):
        out[~known, column] = np.interp(time[~known], time[known], motion[known, column])
    return out


def _gap(known: NDArray[np.bool_], most: float) -> bool:
    """Whether more frames in sequence than `most` are not known."""
    return any(b - a > most for a, b in true_runs(~known))


def _length(
    time: NDArray[np.float64],
    motion: NDArray[np.float64],
    begin: int,
    end: int,
    half: int,
    offset: NDArray[np.float64],
) -> float:
    gravity = [motion[at - half : at + half + 1, :3].mean(axis=0) for at in (begin, end)]
    step = np.diff(time)[:, None]
    rate = motion[begin : end + 1, 3:] - offset
    turns = _turns(0.5 * (rate[1:] + rate[:-1]) * step)
    level = [_upright(gravity[0])]
    for turn in turns:
        level.append(level[-1] @ turn)
    directions = np.array(level)
    # What the tilt is wrong by at the next rest is taken off evenly.
    shares = np.linspace(0.0, 1.0, len(directions))[:, None]
    up = directions[-1] @ gravity[1]
    across = np.cross(up, [0.0, 0.0, 1.0])
    size = float(np.hypot(*across[:2]))
    angle = math.atan2(size, float(up[2]))
    correction = _turns(shares * (across / max(size, 1e-300) * angle))
    force = np.einsum("nij,njk,nk->ni", correction, directions, motion[begin : end + 1, :3])
    acceleration = force - np.array([0.0, 0.0, 0.5 * sum(float(np.linalg.norm(g)) for g in gravity)])
    velocity = _integral(acceleration, step)
    if float(np.linalg.norm(velocity[-1])) > _MOST_DRIFT:
        return math.nan
    elapsed = ((time - time[0]) / (time[-1] - time[0]))[:, None]
    way = _integral(velocity - elapsed * velocity[-1], step)[-1]
    return float(np.hypot(way[0], way[1]))


def _integral(values: NDArray[np.float64], step: NDArray[np.float64]) -> NDArray[np.float64]:
    """Integral (n, 3) from the first of values (n, 3) by trapezoids."""
    pieces = 0.5 * (values[1:] + values[:-1]) * step
    return np.concatenate([np.zeros((1, 3)), np.cumsum(pieces, axis=0)])


def _turns(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotation matrices (n, 3, 3) of rotation vectors (n, 3) in rad."""
    from scipy.spatial.transform import Rotation

    return np.asarray(Rotation.from_rotvec(vectors).as_matrix())


def _upright(gravity: NDArray[np.float64]) -> NDArray[np.float64]:
    """Matrix (3, 3) that turns the measured gravity, which points up at rest, to the z axis."""
    z = gravity / max(float(np.linalg.norm(gravity)), 1e-300)
    least = np.eye(3)[int(np.argmin(np.abs(z)))]
    x = np.cross(least, z)
    x /= np.linalg.norm(x)
    return np.array([x, np.cross(z, x), z])
