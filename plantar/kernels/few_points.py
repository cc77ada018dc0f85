"""Kernels of a few points given as tuples, for which making arrays costs more than their convex hull."""

from __future__ import annotations

import math

__all__ = ["small_hull", "small_margin"]

_INFINITE = float("inf")


def small_hull(points, tolerance=1e-9):
    """Convex hull of a few points given as tuples: the array function costs ten times as much on eight points.

    Args:
        points: Points (x, y) in m.
        tolerance: Twice the area in m^2 of a triangle that still counts as a straight line.

    Returns:
        Hull as a list of points, counter-clockwise from the lowest x.
    """
    cloud = sorted(set(points))
    if len(cloud) < 3:
        return cloud
    ring = []
    for _ in range(2):
        part = []
        for p in cloud:
            px, py = p
            while len(part) >= 2:
                ax, ay = part[len(part) - 2]
                bx, by = part[len(part) - 1]
                if (bx - ax) * (py - ay) - (by - ay) * (px - ax) > tolerance:
                    break
                part.pop()
            part.append(p)
        part.pop()
        ring += part
        cloud.reverse()
    return ring


def small_margin(ring, x, y):
    """Signed distance in m of a point to the edge of a small hull: `plantar.polygon.signed_margin` on plain floats.

    Args:
        ring: Hull as `small_hull` gives it.
        x: Point in m.
        y: Point in m.

    Returns:
        The distance, positive inside; -inf for an empty hull.
    """
    if not ring:
        return -_INFINITE
    inner = outer = _INFINITE
    ax, ay = ring[len(ring) - 1]
    if len(ring) == 1:
        return -math.sqrt((x - ax) * (x - ax) + (y - ay) * (y - ay))
    for bx, by in ring:
        lx, ly, dx, dy = bx - ax, by - ay, x - ax, y - ay
        length = math.sqrt(lx * lx + ly * ly)
        depth = (lx * dy - ly * dx) / length
        inner = min(inner, depth)
        if depth <= 0.0 or len(ring) == 2:
            t = min(1.0, max(0.0, (dx * lx + dy * ly) / (length * length)))
            px, py = dx - t * lx, dy - t * ly
            outer = min(outer, math.sqrt(px * px + py * py))
        ax, ay = bx, by
    return inner if inner > 0.0 and len(ring) > 2 else -outer
