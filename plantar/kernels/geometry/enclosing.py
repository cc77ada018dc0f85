# cython: infer_types=True
"""Oriented box and parallelogram of least area around a clean ring of n vertices, 3 or more.

They write 4 corners to `out`, flat, counter-clockwise, and return the area.
"""

import math

__all__ = ["least_box", "least_parallelogram"]


def least_box(ring, n, out):
    """Rectangle of least area around a ring, by rotating calipers."""
    best = -1.0
    right = 0
    top = 0
    left = 0
    for i in range(n):
        j = i + 1 if i + 1 < n else 0
        ax = ring[2 * i]
        ay = ring[2 * i + 1]
        dx = ring[2 * j] - ax
        dy = ring[2 * j + 1] - ay
        length = math.sqrt(dx * dx + dy * dy)
        dx /= length
        dy /= length
        if i == 0:  # the calipers' first stand: farthest along the edge, across it, and against it
            for k in range(1, n):
                if ring[2 * k] * dx + ring[2 * k + 1] * dy > ring[2 * right] * dx + ring[2 * right + 1] * dy:
                    right = k
                if ring[2 * k + 1] * dx - ring[2 * k] * dy > ring[2 * top + 1] * dx - ring[2 * top] * dy:
                    top = k
                if ring[2 * k] * dx + ring[2 * k + 1] * dy < ring[2 * left] * dx + ring[2 * left + 1] * dy:
                    left = k
        else:
            right = _walk(ring, n, right, dx, dy)
            top = _walk(ring, n, top, -dy, dx)
            left = _walk(ring, n, left, -dx, -dy)
        low = (ring[2 * left] - ax) * dx + (ring[2 * left + 1] - ay) * dy
        high = (ring[2 * right] - ax) * dx + (ring[2 * right + 1] - ay) * dy
        height = (ring[2 * top + 1] - ay) * dx - (ring[2 * top] - ax) * dy
        size = (high - low) * height
        if best < 0.0 or size < best:
            best = size
            out[0] = ax + low * dx
            out[1] = ay + low * dy
            out[2] = ax + high * dx
            out[3] = ay + high * dy
            out[4] = ax + high * dx - height * dy
            out[5] = ay + high * dy + height * dx
            out[6] = ax + low * dx - height * dy
            out[7] = ay + low * dy + height * dx
    return best


def _walk(ring, n, k, dx, dy):
    """From vertex k on, the first farther along (dx, dy) than the next."""
    reach = ring[2 * k] * dx + ring[2 * k + 1] * dy
    for _ in range(n):
        j = k + 1 if k + 1 < n else 0
        after = ring[2 * j] * dx + ring[2 * j + 1] * dy
        if after < reach:
            break
        reach = after
        k = j
    return k


def least_parallelogram(ring, n, work, out):
    """Parallelogram of least area, along edges of a ring; `work` holds 4 n numbers."""
    # Of each edge: its direction, the level of its line along the inward normal, and how far the ring reaches from it.
    top = 0
    for i in range(n):
        j = i + 1 if i + 1 < n else 0
        dx = ring[2 * j] - ring[2 * i]
        dy = ring[2 * j + 1] - ring[2 * i + 1]
        length = math.sqrt(dx * dx + dy * dy)
        dx /= length
        dy /= length
        if i == 0:
            for k in range(1, n):
                if ring[2 * k + 1] * dx - ring[2 * k] * dy > ring[2 * top + 1] * dx - ring[2 * top] * dy:
                    top = k
        else:
            top = _walk(ring, n, top, -dy, dx)
        level = ring[2 * i + 1] * dx - ring[2 * i] * dy
        work[4 * i] = dx
        work[4 * i + 1] = dy
        work[4 * i + 2] = level
        work[4 * i + 3] = ring[2 * top + 1] * dx - ring[2 * top] * dy - level
    best = -1.0
    bi = 0
    bj = 1
    for i in range(n - 1):
        dx = work[4 * i]
        dy = work[4 * i + 1]
        wide = work[4 * i + 3]
        for j in range(i + 1, n):
            turn = abs(dx * work[4 * j + 1] - dy * work[4 * j])
            size = wide * work[4 * j + 3]
            if turn > 0.0 and (best < 0.0 or size < best * turn):
                best = size / turn
                bi = i
                bj = j
    px = work[4 * bi]
    py = work[4 * bi + 1]
    qx = work[4 * bj]
    qy = work[4 * bj + 1]
    turn = px * qy - py * qx
    # Corners where the four lines meet; the strips run from level to level + reach along their inward normals.
    for corner in range(4):
        s = work[4 * bi + 2]
        t = work[4 * bj + 2]
        if corner >= 2:
            s += work[4 * bi + 3]
        if (corner == 1 or corner == 2) == (turn < 0.0):
            t += work[4 * bj + 3]
        # p x z = s and q x z = t.
        out[2 * corner] = (qx * s - px * t) / turn
        out[2 * corner + 1] = (qy * s - py * t) / turn
    return best
