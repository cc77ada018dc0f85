"""Plane through the highest ground under a swinging sole."""

import math

__all__ = ["highest_plane"]

_INFINITE = float("inf")
# standard deviations of a reading that a point may lie off the plane that is the ground; chosen: bounded by a taxel's
# noise and by the lowest step that counts
_TOLERANCE = 1.0
# the same in those of the mean of the readings behind it: what few of them show is noise; nature: one normal value in
# 16,000 is farther off
_TOLERANCE_OF_MEAN = 4.0
_CUTS = 8  # times at most that the plane is fitted to what of the ground is left; chosen: a bound on a tick's time
_POLISHES = 3  # times at most that it is fitted again to all points on it; chosen: a bound on a tick's time
_LEAST_POINTS = 6  # derived: twice the three points that span a plane
# of the variance of all taxels across the sole: the least of points that carry a plane; derived: a strip of a third of
# the sole has 1/9
_LEAST_SPREAD = 0.115
# share of the product of the variances below which the points are in a row; chosen: one row of taxels has 0
_IN_A_ROW = 0.02


def highest_plane(x, y, distance, readings, noise, least, used, plane):
    """Fit the plane z = -level + sx x + sy y through the highest ground under a sole.

    Weighted least squares, repeated while ground is above the noise: with points above, then without those far below;
    at last with all within the noise, unless one lies above.

    `x`: taxels (n,) in sole frame in m; y likewise; `distance`: distances (n,) of ground in m; inf or NaN without;
    `readings`: number of readings (n,) behind each, 1 or more; `noise`: standard deviation of reading in m; `used`:
    receives 1 for points (n,) on plane or, without one, remaining points; else 0; `plane`: receives level in m, sx and
    sy (3,). Returns whether there is a plane: six points or more, not in a row.
    """
    n = x.shape[0]
    for i in range(n):
        used[i] = abs(distance[i]) < _INFINITE
    for _ in range(_CUTS):
        if not _fit(x, y, distance, readings, used, plane):
            return False
        higher = False
        lower = False
        for i in range(n):
            if used[i]:
                above = _above(x, y, distance, plane, i)
                off = _explained(noise, readings[i])
                higher = higher or above > off
                lower = lower or above < -off
        if not higher and not lower:
            break
        for i in range(n):
            if used[i] and _above(x, y, distance, plane, i) <= (0.0 if higher else -_explained(noise, readings[i])):
                used[i] = 0
    on = 0
    for i in range(n):
        on += used[i]
    for _ in range(_POLISHES if on >= least else 0):
        level = plane[0]
        sx = plane[1]
        sy = plane[2]
        changed = False
        for i in range(n):
            near = abs(_above(x, y, distance, plane, i)) < _explained(noise, readings[i])
            if near != used[i]:
                changed = True
            used[i] = near + 2 * used[i]  # and what it was
        fits = changed and _fit(x, y, distance, readings, used, plane)
        for i in range(n):
            if fits and _above(x, y, distance, plane, i) > _explained(noise, readings[i]):
                fits = False  # all points on it have drawn it down from what is higher
        for i in range(n):
            used[i] = used[i] & 1 if fits else used[i] >> 1
        if not fits:
            plane[0] = level
            plane[1] = sx
            plane[2] = sy
            break
    return True


def _above(x, y, distance, plane, i):
    """Height in m of a taxel's ground above the plane."""
    return plane[0] - plane[1] * x[i] - plane[2] * y[i] - distance[i]


def _explained(noise, readings):
    return noise * max(_TOLERANCE, _TOLERANCE_OF_MEAN / math.sqrt(readings))


def _fit(x, y, distance, readings, used, plane):
    """Weighted least squares; False, with the plane unchanged, without one."""
    count = 0
    whole = 0.0
    mx = 0.0
    my = 0.0
    md = 0.0
    ax = 0.0
    ay = 0.0
    axx = 0.0
    ayy = 0.0
    n = x.shape[0]
    for i in range(n):
        ax += x[i]
        ay += y[i]
        axx += x[i] * x[i]
        ayy += y[i] * y[i]
        if used[i] & 1:
            w = readings[i]
            count += 1
            whole += w
            mx += w * x[i]
            my += w * y[i]
            md += w * distance[i]
    if count < _LEAST_POINTS:
        return False
    mx = mx / whole
    my = my / whole
    md = md / whole
    xx = 0.0
    xy = 0.0
    yy = 0.0
    xd = 0.0
    yd = 0.0
    for i in range(x.shape[0]):
        if used[i] & 1:
            w = readings[i]
            u = x[i] - mx
            v = y[i] - my
            d = distance[i] - md
            xx += w * u * u
            xy += w * u * v
            yy += w * v * v
            xd += w * u * d
            yd += w * v * d
    determinant = xx * yy - xy * xy
    least = _LEAST_SPREAD * min(axx / n - ax * ax / n / n, ayy / n - ay * ay / n / n)
    if determinant < _IN_A_ROW * xx * yy or min(xx, yy) < whole * least:
        return False
    sx = (xy * yd - yy * xd) / determinant
    sy = (xy * xd - xx * yd) / determinant
    plane[0] = md + sx * mx + sy * my
    plane[1] = sx
    plane[2] = sy
    return True
