"""Kernel of the convex hull of a few points given as tuples, for which making arrays costs more than the hull."""

from __future__ import annotations

__all__ = ["small_hull"]


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
