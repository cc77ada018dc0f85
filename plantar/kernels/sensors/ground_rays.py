"""Rays against simple solids, equal to MuJoCo's `mj_ray` to the last bit."""

import math

__all__ = ["cast_rays"]

_TINY = 1e-15  # mjMINVAL


def cast_rays(starts, ways, reach, ids, kinds, sizes, bounds, positions, frames, lengths):
    """Length of rays to the first solid; those out of reach are left out once.

    Args:
        starts: Where rays begin (n, 3) in world in m, along unit vectors `ways` (n, 3); at least one.
        reach: Length in m beyond which a hit need not be found.
        ids: Rows (k,) of solids in `positions` and `frames`.
        kinds: MuJoCo kind (k,) of each: 0 plane, 2 sphere, 4 ellipsoid, 5 cylinder, 6 box.
        sizes: Half sizes (k, 3) in m as in MuJoCo.
        bounds: Radius (k,) in m of bounding sphere; not read for a plane.
        positions: Middles (m, 3) in world in m; `frames` (m, 9) their rotations, row by row.
        lengths: Receives lengths (n,) in m; -1 without a hit.
    """
    n = starts.shape[0]
    x = 0.0
    y = 0.0
    z = 0.0
    for i in range(n):
        x += starts[i, 0]
        y += starts[i, 1]
        z += starts[i, 2]
        lengths[i] = -1.0
    x = x / n
    y = y / n
    z = z / n
    spread = 0.0
    for i in range(n):
        dx = starts[i, 0] - x
        dy = starts[i, 1] - y
        dz = starts[i, 2] - z
        spread = max(spread, dx * dx + dy * dy + dz * dz)
    spread = 1.000001 * (math.sqrt(spread) + reach)
    for k in range(ids.shape[0]):
        g = ids[k]
        if kinds[k] != 0:
            dx = positions[g, 0] - x
            dy = positions[g, 1] - y
            dz = positions[g, 2] - z
            far = spread + bounds[k]
            if dx * dx + dy * dy + dz * dz > far * far:
                continue
        for i in range(n):
            length = _ray(k, g, i, starts, ways, kinds, sizes, positions, frames)
            if length >= 0.0 and (lengths[i] < 0.0 or length < lengths[i]):
                lengths[i] = length


def _ray(k, g, i, starts, ways, kinds, sizes, positions, frames):
    """Length in m of one ray to one solid; -1 without a hit."""
    kind = kinds[k]
    x = starts[i, 0] - positions[g, 0]
    y = starts[i, 1] - positions[g, 1]
    z = starts[i, 2] - positions[g, 2]
    u = ways[i, 0]
    v = ways[i, 1]
    w = ways[i, 2]
    a = sizes[k, 0]
    b = sizes[k, 1]
    c = sizes[k, 2]
    if kind == 2:
        return _nearer(u * u + v * v + w * w, u * x + v * y + w * z, x * x + y * y + z * z - a * a)
    # Whole solids first, by the sphere about them.
    if kind == 6 or kind == 5:
        square = a * a + b * b + c * c if kind == 6 else a * a + b * b
        if _nearer(u * u + v * v + w * w, u * x + v * y + w * z, x * x + y * y + z * z - square) < 0.0:
            return -1.0
    px = frames[g, 0] * x + frames[g, 3] * y + frames[g, 6] * z
    py = frames[g, 1] * x + frames[g, 4] * y + frames[g, 7] * z
    pz = frames[g, 2] * x + frames[g, 5] * y + frames[g, 8] * z
    wx = frames[g, 0] * u + frames[g, 3] * v + frames[g, 6] * w
    wy = frames[g, 1] * u + frames[g, 4] * v + frames[g, 7] * w
    wz = frames[g, 2] * u + frames[g, 5] * v + frames[g, 8] * w
    if kind == 0:
        return _plane(a, b, px, py, pz, wx, wy, wz)
    if kind == 4:
        a = 1.0 / (a * a)
        b = 1.0 / (b * b)
        c = 1.0 / (c * c)
        return _nearer(
            a * wx * wx + b * wy * wy + c * wz * wz,
            a * wx * px + b * wy * py + c * wz * pz,
            a * px * px + b * py * py + c * pz * pz - 1.0,
        )
    if kind == 5:
        return _cylinder(a, b, px, py, pz, wx, wy, wz)
    best = _face(px, py, pz, wx, wy, wz, a, b, c, -1.0)
    best = _face(py, px, pz, wy, wx, wz, b, a, c, best)
    return _face(pz, px, py, wz, wx, wy, c, a, b, best)


def _nearer(a, b, c):
    """Smaller root of a t^2 + 2 b t + c that is not negative; -1 without one."""
    root = b * b - a * c
    if root < _TINY:
        return -1.0
    root = math.sqrt(root)
    t = (-b - root) / a
    if t >= 0.0:
        return t
    t = (-b + root) / a
    return t if t >= 0.0 else -1.0


def _plane(a, b, px, py, pz, wx, wy, wz):
    """Length to a plane z = 0 seen from above, of half sizes a and b if above 0."""
    if wz > -_TINY:
        return -1.0
    t = -pz / wz
    if t < 0.0:
        return -1.0
    inside = (a <= 0.0 or abs(px + t * wx) <= a) and (b <= 0.0 or abs(py + t * wy) <= b)
    return t if inside else -1.0


def _cylinder(radius, half, px, py, pz, wx, wy, wz):
    best = -1.0
    if abs(wz) > _TINY:
        for side in range(-1, 2, 2):
            t = (side * half - pz) / wz
            if t >= 0.0:
                x = px + t * wx
                y = py + t * wy
                if x * x + y * y <= radius * radius and (best < 0.0 or t < best):
                    best = t
    t = _nearer(wx * wx + wy * wy, wx * px + wy * py, px * px + py * py - radius * radius)
    if t >= 0.0 and abs(pz + t * wz) <= half and (best < 0.0 or t < best):
        best = t
    return best


def _face(p, q, r, wp, wq, wr, half_p, half_q, half_r, best):
    """Lesser of the length so far and that to a box's faces across axis p."""
    if abs(wp) > _TINY:
        for side in range(-1, 2, 2):
            t = (side * half_p - p) / wp
            if t >= 0.0 and abs(q + t * wq) <= half_q and abs(r + t * wr) <= half_r and (best < 0.0 or t < best):
                best = t
    return best
