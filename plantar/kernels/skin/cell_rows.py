"""Rows of cells of a sole that are copies along one line; only a row's first and last active cell make its hull."""

import numpy as np

__all__ = ["ordered_rows"]


def ordered_rows(vertices, rings, starts, tolerance):
    """Find rows of copies and put each cell's corners in the order that its row needs.

    Corners that count only where their cell is the first of its row come first, those that count only where it is the
    last come last.

    `vertices`: corner points (v, 2) in m; `rings`: vertex indices (k,) of each of n cells; put in order; `starts`:
    offsets (n + 1) of each cell's corners; `tolerance`: how far in m a copy may be off. Returns indices of each row's
    cells, and by cell where its last corners begin and where its first ones end.
    """
    rows = _rows_of_copies([vertices[ring] for ring in rings], tolerance)
    first_end = starts[1:]
    last_begin = starts[: len(starts) - 1]
    for row in rows:
        if len(row) > 1:
            along = vertices[rings[row[len(row) - 1]][0]] - vertices[rings[row[0]][0]]
            behind = _is_behind(vertices[rings[row[0]]], along)
            ahead = _is_behind(vertices[rings[row[0]]], -along)
            order = np.concatenate([np.flatnonzero(ahead), np.flatnonzero(~ahead & ~behind), np.flatnonzero(behind)])
            for i in row:
                rings[i] = rings[i][order]
                first_end[i] -= int(behind.sum())
                last_begin[i] += int(ahead.sum())
    return rows, first_end, last_begin


def _rows_of_copies(cells, tolerance):
    """Rows of cells that are copies along one line: a row's first and last active cell make its hull.

    `cells` are corners (k, 2) in m, off by `tolerance` in m at most; a row's indices go from one end to the other.
    """
    kinds = {}  # cells of one kind, the first of which stands for them
    for i, cell in enumerate(cells):
        shape = cell - cell[0]
        # nature: micrometres, to which files state corners
        kind = kinds.setdefault((np.rint(shape * 1e6) + 0.0).tobytes(), [i])
        first = cells[kind[0]]
        if kind[0] == i:
            continue
        if np.abs(shape - (first - first[0])).max() <= 2.0 * tolerance:
            kind.append(i)
        else:
            kinds[f"{i}".encode()] = [i]
    rows = []
    for kind in kinds.values():
        where = np.array([cells[i][0] for i in kind])
        steps = where[1:] - where[0]
        best = [[i] for i in kind]
        for j in np.argsort((steps * steps).sum(axis=1))[:6].tolist():  # the directions of the nearest copies
            length = float(np.hypot(steps[j, 0], steps[j, 1]))
            if length <= tolerance:
                continue
            ux, uy = (steps[j] / length).tolist()
            across = where[:, 1] * ux - where[:, 0] * uy
            along = where[:, 0] * ux + where[:, 1] * uy
            order = np.argsort(across, kind="stable")
            # derived: twice the two tolerances by which two neighbours may be off their rows
            ends = np.flatnonzero(np.diff(across[order]) > 4.0 * tolerance) + 1
            found = [part[np.argsort(along[part], kind="stable")] for part in np.split(order, ends)]
            # derived: twice the gap above
            if len(found) < len(best) and all(np.ptp(across[part]) <= 8.0 * tolerance for part in found):
                best = [[kind[i] for i in part.tolist()] for part in found]
        rows += best
    return rows


def _is_behind(cell, along):
    """Which corners (k,) of a convex cell lie within it and its copies along a direction.

    `cell`: corners (k, 2) in m; none if not convex; `along`: direction (2,) to copies.
    """
    edge = np.roll(cell, -1, axis=0) - cell
    length = np.hypot(edge[:, 0], edge[:, 1])
    after = np.roll(edge, -1, axis=0)
    turns = edge[:, 0] * after[:, 1] - edge[:, 1] * after[:, 0]
    size = float(length.sum())
    if not (turns > 1e-6 * size * size / len(cell) ** 2).all():  # nature: floating point of single precision
        return np.zeros(len(cell), dtype=bool)
    # derived: a point just behind the corner; any small share shows the same side
    away = cell[:, None] - 1e-3 * size * along / float(np.hypot(*along)) - cell
    depth = (edge[:, 0] * away[..., 1] - edge[:, 1] * away[..., 0]) / length
    return depth.min(axis=1) > 1e-6 * size  # nature: floating point of single precision
