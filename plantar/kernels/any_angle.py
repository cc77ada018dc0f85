# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
# cython: infer_types=True
"""Kernel that turns the largest rectangle of a convex ring or of an outline to its best angle.

Plain Python that also compiles ahead of time (`any_angle.pxd` gives the C types). `plantar.inscribed` is the public
face.
"""

from __future__ import annotations

import math

from . import concave, rectangle

__all__ = ["largest_rectangle_at_any_angle"]

_QUARTER = 0.5 * math.pi
_NEAR = 0.5  # a local maximum that starts below this share of the best is not followed in any case
_GOLDEN = 0.3819660112501051
_SECTIONS = 40
_BETWEEN = 7


def largest_rectangle_at_any_angle(ring, n, starts, samples, work, out):
    """Largest rectangle at any angle: samples and the directions of the edges, then golden sections round the best.

    Args:
        ring: Clean convex ring, or the rings of an outline one after another, near the origin; flat.
        n: Number of vertices, 3 or more.
        starts: Offsets (r + 1,) of the outline's rings; empty for a convex ring.
        samples: Number of evenly spaced angles in a quarter turn, 8 or more.
        work: Room for 22 n + 14 + 16 samples numbers.
        out: Receives the 4 corners, flat, counter-clockwise.

    Returns:
        Its area.
    """
    quarter = _QUARTER
    at = 6 * n + 12  # samples stand at work[at:], an angle and an area each, by angle
    for i in range(samples):
        work[at + 2 * i] = i * quarter / samples
    count = samples
    convex = len(starts) == 0
    for i in range(n):
        j = i + 1 if i + 1 < n else 0
        if not convex and ring[2 * j] == ring[2 * i] and ring[2 * j + 1] == ring[2 * i + 1]:
            continue
        angle = (math.atan2(ring[2 * j + 1] - ring[2 * i + 1], ring[2 * j] - ring[2 * i]) + 4.0 * quarter) % quarter
        k = count
        while k > 0 and work[at + 2 * k - 2] > angle:
            k -= 1
        if k > 0 and angle - work[at + 2 * k - 2] < 1e-9:
            work[at + 2 * k - 2] = angle
            continue
        for j in range(count, k, -1):
            work[at + 2 * j] = work[at + 2 * j - 2]
        work[at + 2 * k] = angle
        count += 1
    best = 0.0
    best_angle = 0.0
    for i in range(count):
        area = _largest(ring, n, starts, work[at + 2 * i], _NEAR * best, work, out)
        work[at + 2 * i + 1] = area
        if area > best:
            best = area
            best_angle = work[at + 2 * i]
    # Off its best angle a rectangle loses about (a + 1 / a) of its area a radian, a its sides' ratio: the slenderer
    # the shape, the lower may a sample near the best angle lie.
    _largest(ring, n, starts, best_angle, 0.0, work, out)
    long = math.sqrt((out[2] - out[0]) ** 2 + (out[3] - out[1]) ** 2)
    high = math.sqrt((out[4] - out[2]) ** 2 + (out[5] - out[3]) ** 2)
    loss = long / high + high / long if long > 0.0 and high > 0.0 else 0.0
    # Where a summit may stand between two samples, more of them: a finer list behind the first.
    fine = at + 2 * count
    more = 0
    for i in range(count):
        q = i + 1 if i + 1 < count else 0
        low = work[at + 2 * i]
        high = work[at + 2 * q] if i + 1 < count else work[at] + quarter
        work[fine + 2 * more] = low
        work[fine + 2 * more + 1] = work[at + 2 * i + 1]
        more += 1
        top = max(work[at + 2 * i + 1], work[at + 2 * q + 1])
        if high - low < 1e-6 or top <= best * max(_NEAR, 1.0 - loss * (high - low)):
            continue
        for k in range(1, _BETWEEN):
            angle = low + k * (high - low) / _BETWEEN
            work[fine + 2 * more] = angle
            work[fine + 2 * more + 1] = _largest(ring, n, starts, angle, _NEAR * best, work, out)
            more += 1
    at = fine
    count = more
    for i in range(count):
        best = max(best, work[at + 2 * i + 1])
    near = best * max(_NEAR, 1.0 - 0.5 * loss * quarter / samples / _BETWEEN - 1e-3)
    result = 0.0
    for i in range(count):
        area = work[at + 2 * i + 1]
        p = i - 1 if i > 0 else count - 1
        q = i + 1 if i + 1 < count else 0
        if area < near or area < work[at + 2 * p + 1] or area <= work[at + 2 * q + 1]:
            continue
        middle = work[at + 2 * i]
        low = work[at + 2 * p] if i > 0 else work[at + 2 * p] - quarter
        high = work[at + 2 * q] if i + 1 < count else work[at + 2 * q] + quarter
        for _ in range(_SECTIONS):
            if high - low < 1e-7:
                break
            if high - middle > middle - low:
                angle = middle + _GOLDEN * (high - middle)
            else:
                angle = middle - _GOLDEN * (middle - low)
            trial = _largest(ring, n, starts, angle, area, work, out)
            if trial > area:
                if angle > middle:
                    low = middle
                else:
                    high = middle
                middle = angle
                area = trial
            elif angle > middle:
                high = angle
            else:
                low = angle
        if area > result:
            result = area
            best_angle = middle
    return _largest(ring, n, starts, best_angle, 0.0, work, out)


def _largest(ring, n, starts, angle, floor, work, out):
    """Largest rectangle at one angle, of a convex ring or of an outline."""
    if len(starts) == 0:
        return rectangle.largest_rectangle(ring, n, angle, floor, work, out)
    return concave.largest_rectangle_in_outline(ring, starts, angle, floor, out)
