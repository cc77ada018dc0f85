"""Kernel of the part of a polygon on one side of a line."""

from ..base import memory

__all__ = ["part_below"]


def part_below(polygon, nx, ny, h):
    """Corners (j, 2) of the part of a convex polygon where n . x <= h; keeps near-duplicates of a corner on the line.

    Args:
        polygon: Convex polygon (k, 2) in m, contiguous.
        nx: The line's normal n, along x; ny along y.
        h: Distance in m of the line from the origin, along the normal.
    """
    size = memory.rows(polygon, 2)
    given, room = memory.values(polygon), memory.new_matrix(2 * max(size, 1), 2)
    kept = memory.room(room)
    count = 0
    for k in range(size):
        n = k + 1 if k + 1 < size else 0
        ax, ay, bx, by = given[2 * k], given[2 * k + 1], given[2 * n], given[2 * n + 1]
        a, b = nx * ax + ny * ay - h, nx * bx + ny * by - h
        if a <= 0.0:
            kept[2 * count], kept[2 * count + 1] = ax, ay
            count += 1
        if (a < 0.0 < b) or (b < 0.0 < a):
            share = a / (a - b)
            kept[2 * count], kept[2 * count + 1] = ax + share * (bx - ax), ay + share * (by - ay)
            count += 1
    left = memory.new_matrix(count, 2)
    out = memory.room(left)
    for k in range(2 * count):
        out[k] = kept[k]
    return left
