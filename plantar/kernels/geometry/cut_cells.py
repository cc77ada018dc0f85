"""Cells cut by straight lines: what is left of each, and the cuts' chords."""

from ..base import memory

__all__ = ["cut_cells", "part_below"]


def cut_cells(points, start, lines, scratch, tags, measure, chords):
    """Clip every cell by half-planes n . x <= h (Sutherland and Hodgman 1974); areas exact to 1e-12 of the cell's.

    `points`: corners (c, 2) of cells in m, in turn, counter-clockwise; offsets `start` (n + 1,); `lines`: half-planes
    (m, 3): n of length 1, and h in m; `scratch`: room (2, r, 2) for a cell's corners; if convex, r = its corners + m +
    1; `tags`: room (2, r) for lines that edges lie on; `measure`: receives (n, 3): area in m^2 left, and its first
    moments about origin in m^3; `chords`: receives (n, m, 3): length in m of each line's edge, and its middle in m.
    Returns whether room was enough; if not, results are not complete.
    """
    count = lines.shape[0]
    room = scratch.shape[1]
    for i in range(start.shape[0] - 1):
        size = start[i + 1] - start[i]
        if size > room:
            return False
        for k in range(size):
            scratch[0, k, 0] = points[start[i] + k, 0]
            scratch[0, k, 1] = points[start[i] + k, 1]
            tags[0, k] = -1
        now = 0
        for j in range(count):
            chords[i, j, 0] = 0.0
            chords[i, j, 1] = 0.0
            chords[i, j, 2] = 0.0
            nx = lines[j, 0]
            ny = lines[j, 1]
            h = lines[j, 2]
            new = 1 - now
            left = 0
            for k in range(size):
                if left + 2 > room:
                    return False
                following = k + 1 if k + 1 < size else 0
                ax = scratch[now, k, 0]
                ay = scratch[now, k, 1]
                bx = scratch[now, following, 0]
                by = scratch[now, following, 1]
                a = nx * ax + ny * ay - h
                b = nx * bx + ny * by - h
                if a <= 0.0:
                    scratch[new, left, 0] = ax
                    scratch[new, left, 1] = ay
                    tags[new, left] = tags[now, k]
                    left += 1
                    if b > 0.0:
                        share = a / (a - b)
                        scratch[new, left, 0] = ax + share * (bx - ax)
                        scratch[new, left, 1] = ay + share * (by - ay)
                        tags[new, left] = j
                        left += 1
                elif b <= 0.0:
                    share = a / (a - b)
                    scratch[new, left, 0] = ax + share * (bx - ax)
                    scratch[new, left, 1] = ay + share * (by - ay)
                    tags[new, left] = tags[now, k]
                    left += 1
            now = new
            size = left
        area = 0.0
        mx = 0.0
        my = 0.0
        if size >= 3:
            ox = scratch[now, 0, 0]
            oy = scratch[now, 0, 1]
            for k in range(1, size - 1):
                ax = scratch[now, k, 0] - ox
                ay = scratch[now, k, 1] - oy
                bx = scratch[now, k + 1, 0] - ox
                by = scratch[now, k + 1, 1] - oy
                part = 0.5 * (ax * by - ay * bx)
                area += part
                mx += part * (ax + bx)
                my += part * (ay + by)
            mx = area * ox + mx / 3.0  # nature: 3.0, a triangle's centroid is a third of its corners
            my = area * oy + my / 3.0  # nature: a triangle's centroid is a third of its corners
            for k in range(size):
                j = tags[now, k]
                if j >= 0:
                    following = k + 1 if k + 1 < size else 0
                    ax = scratch[now, k, 0]
                    ay = scratch[now, k, 1]
                    bx = scratch[now, following, 0]
                    by = scratch[now, following, 1]
                    chords[i, j, 0] = ((bx - ax) * (bx - ax) + (by - ay) * (by - ay)) ** 0.5
                    chords[i, j, 1] = 0.5 * (ax + bx)
                    chords[i, j, 2] = 0.5 * (ay + by)
        measure[i, 0] = area
        measure[i, 1] = mx
        measure[i, 2] = my
    return True


def part_below(polygon, nx, ny, h):
    """Corners (j, 2) of a convex polygon's part where n . x <= h; keeps near-duplicates on the line.

    `polygon`: convex polygon (k, 2) in m, contiguous; `h`: distance in m of line from origin, along normal.
    """
    size = memory.rows(polygon, 2)
    given = memory.values(polygon)
    room = memory.new_matrix(2 * max(size, 1), 2)
    kept = memory.room(room)
    count = 0
    for k in range(size):
        n = k + 1 if k + 1 < size else 0
        ax = given[2 * k]
        ay = given[2 * k + 1]
        bx = given[2 * n]
        by = given[2 * n + 1]
        a = nx * ax + ny * ay - h
        b = nx * bx + ny * by - h
        if a <= 0.0:
            kept[2 * count] = ax
            kept[2 * count + 1] = ay
            count += 1
        if (a < 0.0 < b) or (b < 0.0 < a):
            share = a / (a - b)
            kept[2 * count] = ax + share * (bx - ax)
            kept[2 * count + 1] = ay + share * (by - ay)
            count += 1
    left = memory.new_matrix(count, 2)
    out = memory.room(left)
    for k in range(2 * count):
        out[k] = kept[k]
    return left
