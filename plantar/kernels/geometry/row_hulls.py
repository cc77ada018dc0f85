"""Convex hulls of a grid's loaded cells, by the first and last one of each row: whole numbers, exact."""

import numpy as np

__all__ = ["hull_areas"]


def hull_areas(force, row, column, area):
    """Fill `area` (m,), in cells, of the convex hull of the cells with a force above 0 in each of m frames.

    `force` (m, k); `row` (k,), `column` (k,): places of the cells, from 0.
    """
    rows = 0
    for k in range(row.shape[0]):
        rows = max(rows, row[k] + 1)
    work = np.empty((4, rows + 1), dtype=np.intp)
    for m in range(force.shape[0]):
        for i in range(rows):
            work[0, i] = -1
        for k in range(row.shape[0]):
            if force[m, k] > 0.0:
                i = row[k]
                at = column[k]
                if work[0, i] < 0:
                    work[0, i] = at
                    work[1, i] = at
                elif at < work[0, i]:
                    work[0, i] = at
                elif at > work[1, i]:
                    work[1, i] = at
        area[m] = -0.5 * (_twice_below(work, rows, 0, 1) + _twice_below(work, rows, 1, -1))


def _twice_below(work, rows, side, sign):
    """Twice the area between column 0 and the hull's edge at the first (side 0, sign 1) or last cells (1, -1)."""
    size = 0
    twice = 0
    for line in range(rows + 1):
        # The lines between rows, at which the corners of both lie.
        before = line > 0 and work[0, line - 1] >= 0
        after = line < rows and work[0, line] >= 0
        if not (before or after):
            continue
        least = sign * (work[side, line] + side) if after else 0
        if before:
            other = sign * (work[side, line - 1] + side)
            least = min(least, other) if after else other
        while size >= 2 and (least - work[3, size - 2]) * (work[2, size - 1] - work[2, size - 2]) <= (
            work[3, size - 1] - work[3, size - 2]
        ) * (line - work[2, size - 2]):
            size -= 1
        work[2, size] = line
        work[3, size] = least
        size += 1
    for i in range(1, size):
        twice += (work[2, i] - work[2, i - 1]) * (work[3, i] + work[3, i - 1])
    return twice
