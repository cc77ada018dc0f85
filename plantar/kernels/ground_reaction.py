"""Kernel of what the ground does to all feet together: wrench, zero moment point, support, and its margin."""

from __future__ import annotations

import numpy as np

from . import few_points

__all__ = ["ground_reaction"]


def ground_reaction(feet, height, least, reach):
    """Sum up the contacts of all feet.

    Args:
        feet: The `FootContacts` of each foot.
        height: Height in m of the plane of the ZMP; NaN takes the mean height of the contacts weighted by force.
        least: Vertical force in N below which there is no ZMP.
        reach: Largest gap in m of a contact that could carry.

    Returns:
        Wrench (6,) about the world's origin; the ZMP (x, y) in m or None; the convex hull of the points of support as
        a list, counter-clockwise; the signed distance of the ZMP to its edge in m, positive inside, or None; and the
        points of support of each foot.
    """
    sums = np.zeros(7)
    points = []
    together = []
    for foot in feet:
        own = []
        foot.add_to_ground(reach, sums, own)
        points.append(own)
        together += own
    ring = few_points.small_hull(together)
    return _reaction(sums, height, least, ring, tuple(points))


def _reaction(sums, height, least, ring, points):
    """The same from the sums: force, torque, and the contacts' height times vertical force."""
    force = sums[2]
    if not force >= least:
        return np.asarray(sums)[:6], None, ring, None, points
    if height != height:
        height = sums[6] / force
    x = (height * sums[0] - sums[4]) / force
    y = (height * sums[1] + sums[3]) / force
    return np.asarray(sums)[:6], np.array((x, y)), ring, few_points.small_margin(ring, x, y), points
