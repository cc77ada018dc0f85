# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
# cython: infer_types=True
"""Strict task hierarchies: directions of acceleration that levels of tasks own, and the rest.

In mass-weighted coordinates y = L^T q'', M = L L^T, a Jacobian row is L^-1 J^T. Householder reflections of what is left
bring each level's rows to triangular form and make the basis of y (`plantar.wholebody.fusion.hierarchy`).
"""

import math

import numpy as np

__all__ = ["TaskSpace"]


class TaskSpace:
    """Owned directions and y of n coordinates at a tick.

    `size`: number n of generalized coordinates. Attributes `y`: mass-weighted acceleration (n,) in basis of owned
    directions, these first; `columns`: rows of last level in that basis as columns (n, m), in owned order; `sizes`:
    size (m,) of each before any was owned; `full`: size (m,) of each with a Jacobian row as long as level's longest;
    `missing`: unmet part (m,) of wanted acceleration; 0 where met; `order`: index (m,) of each in level.
    """

    def __init__(self, size):
        self.size = size
        self.used = 0
        self.y = np.zeros(size)
        self.factor = np.zeros((size, size))
        self.vectors = np.zeros((size, size))
        self.scale = np.zeros(size)
        self.normal = np.zeros((size, size))
        self.room = 0
        self._make_room(size)

    def _make_room(self, count):
        self.columns = np.zeros((self.size, count))
        self.sizes = np.zeros(count)
        self.full = np.zeros(count)
        self.left = np.zeros(count)
        self.sums = np.zeros(count)
        self.missing = np.zeros(count)
        self.order = np.zeros(count, dtype=np.intp)
        self.room = count

    def begin(self, mass):
        """Clear what is owned, and factor a mass matrix (n, n)."""
        n = self.size
        factor = self.factor
        self.used = 0
        for i in range(n):
            self.y[i] = 0.0
            for j in range(i + 1):
                total = mass[i, j]
                for k in range(j):
                    total -= factor[i, k] * factor[j, k]
                if j < i:
                    factor[i, j] = total / factor[j, j]
                elif total > 0.0:
                    factor[i, i] = math.sqrt(total)
                else:
                    return False
        return True

    def push(self, torque):
        """Apply a generalized force (n,), overwritten, in what is left."""
        self._turn(torque)
        for i in range(self.used, self.size):
            self.y[i] += torque[i]

    def own(self, jacobian, wanted, meet, least):
        """Own the directions left of a level's rows, and meet the wanted accelerations there.

        `jacobian`: rows (m, n); `wanted`: acceleration (m,) along each, used to meet it; `least`: share of row's size
        below which its rest is no direction. Returns number of directions, and lower bound on these rows' singular
        values over full size. If small, or rows have no direction, caller uses `rows`, `missing`.
        """
        n = self.size
        count = jacobian.shape[0]
        first = self.used
        if count > self.room:
            self._make_room(count)
        columns = self.columns
        sizes = self.sizes
        left = self.left
        missing = self.missing
        order = self.order
        y = self.y
        full = self.full
        largest = 0.0
        longest = 0.0
        for j in range(count):
            order[j] = j
            total = 0.0
            for i in range(n):
                columns[i, j] = jacobian[j, i]
                total += jacobian[j, i] * jacobian[j, i]
            full[j] = math.sqrt(total)
            longest = max(longest, full[j])
        self._turn_all(count)
        self._norms(0, count, sizes)
        for j in range(count):
            largest = max(largest, sizes[j])
        self._norms(first, count, left)
        for j in range(count):
            full[j] = sizes[j] * longest / full[j] if full[j] > 0.0 else largest
            left[j] = left[j] / sizes[j] if sizes[j] > least * largest else 0.0
        rank = 0
        while first + rank < n and rank < count:
            best = rank
            for j in range(rank + 1, count):
                if left[j] > left[best]:
                    best = j
            if left[best] <= least:
                break
            if best != rank:
                self._swap(best, rank)
            self._reflect(rank, count, least * largest)
            rank += 1
        self.used = first + rank
        if meet:
            for j in range(count):
                missing[j] = wanted[order[j]]
            for i in range(self.used):
                total = y[i]
                for j in range(count):
                    missing[j] -= columns[i, j] * total
        return rank, self._bound(rank)

    def meet(self, rank):
        """Meet the missing accelerations of the last level's first `rank` rows."""
        first = self.used - rank
        columns = self.columns
        missing = self.missing
        y = self.y
        for i in range(rank):
            missing[i] /= columns[first + i, i]
            for j in range(i + 1, rank):
                missing[j] -= columns[first + i, j] * missing[i]
        for j in range(rank):
            y[first + j] += missing[j]

    def fit(self, rank, count, least):
        """Meet the last level's missing accelerations by least squares; overwrites its rows.

        With L the rows that have a direction and X L the others, w along the former solves (I + X^T X) w = missing_L +
        X^T missing_X. The longest rows are first, so X is small.

        `least`: share of largest row's size below which a row does not count.
        """
        first = self.used - rank
        columns = self.columns
        missing = self.missing
        normal = self.normal
        largest = 0.0
        for j in range(count):
            largest = max(largest, self.sizes[j])
        for j in range(rank, count):
            if self.sizes[j] <= least * largest:
                missing[j] = 0.0
                for i in range(rank):
                    columns[first + i, j] = 0.0
        for k in range(rank - 1, -1, -1):
            for j in range(rank, count):
                columns[first + k, j] /= columns[first + k, k]
            for i in range(k):
                share = columns[first + i, k]
                for j in range(rank, count):
                    columns[first + i, j] -= share * columns[first + k, j]
        for i in range(rank):
            for j in range(rank, count):
                missing[i] += columns[first + i, j] * missing[j]
            for k in range(i + 1):
                total = 1.0 if i == k else 0.0
                for j in range(rank, count):
                    total += columns[first + i, j] * columns[first + k, j]
                normal[i, k] = total
        for i in range(rank):
            for j in range(i + 1):
                total = normal[i, j]
                for k in range(j):
                    total -= normal[i, k] * normal[j, k]
                normal[i, j] = total / normal[j, j] if j < i else math.sqrt(total)
            for k in range(i):
                missing[i] -= normal[i, k] * missing[k]
            missing[i] /= normal[i, i]
        for i in range(rank - 1, -1, -1):
            missing[i] /= normal[i, i]
            for k in range(i):
                missing[k] -= normal[i, k] * missing[i]
        self.meet(rank)

    def acceleration(self, out):
        """Write the generalized acceleration of y to `out` (n,)."""
        n = self.size
        factor = self.factor
        vectors = self.vectors
        for i in range(n):
            out[i] = self.y[i]
        for k in range(self.used - 1, -1, -1):
            total = 0.0
            for i in range(k, n):
                total += vectors[k, i] * out[i]
            total *= self.scale[k]
            for i in range(k, n):
                out[i] -= total * vectors[k, i]
        for i in range(n - 1, -1, -1):
            out[i] /= factor[i, i]
            for k in range(i):
                out[k] -= factor[i, k] * out[i]

    def _turn(self, row):
        """Turn a Jacobian row (n,) into the mass-weighted basis, in place."""
        n = self.size
        factor = self.factor
        vectors = self.vectors
        begin = 0
        while begin < n and row[begin] == 0.0:
            begin += 1
        for i in range(begin, n):
            a = 0.0
            b = 0.0
            c = 0.0
            d = 0.0
            end = i - (i - begin) % 4
            for k in range(begin, end, 4):
                a += factor[i, k] * row[k]
                b += factor[i, k + 1] * row[k + 1]
                c += factor[i, k + 2] * row[k + 2]
                d += factor[i, k + 3] * row[k + 3]
            for k in range(end, i):
                a += factor[i, k] * row[k]
            row[i] = (row[i] - ((a + b) + (c + d))) / factor[i, i]
        for k in range(self.used):
            a = 0.0
            b = 0.0
            c = 0.0
            d = 0.0
            end = n - (n - k) % 4
            for i in range(k, end, 4):
                a += vectors[k, i] * row[i]
                b += vectors[k, i + 1] * row[i + 1]
                c += vectors[k, i + 2] * row[i + 2]
                d += vectors[k, i + 3] * row[i + 3]
            for i in range(end, n):
                a += vectors[k, i] * row[i]
            total = self.scale[k] * ((a + b) + (c + d))
            for i in range(k, n):
                row[i] -= total * vectors[k, i]

    def _turn_all(self, count):
        """`_turn` for all columns of the level."""
        n = self.size
        factor = self.factor
        vectors = self.vectors
        columns = self.columns
        sums = self.sums
        for i in range(n):
            for k in range(i):
                share = factor[i, k]
                for j in range(count):
                    columns[i, j] -= share * columns[k, j]
            share = 1.0 / factor[i, i]
            for j in range(count):
                columns[i, j] *= share
        for k in range(self.used):
            for j in range(count):
                sums[j] = 0.0
            for i in range(k, n):
                share = vectors[k, i]
                for j in range(count):
                    sums[j] += share * columns[i, j]
            for j in range(count):
                sums[j] *= self.scale[k]
            for i in range(k, n):
                share = vectors[k, i]
                for j in range(count):
                    columns[i, j] -= share * sums[j]

    def _norms(self, begin, count, out):
        columns = self.columns
        for j in range(count):
            out[j] = 0.0
        for i in range(begin, self.size):
            for j in range(count):
                out[j] += columns[i, j] * columns[i, j]
        for j in range(count):
            out[j] = math.sqrt(out[j])

    def _bound(self, rank):
        """Lower bound of the scaled triangle's singular values, by its inverse's Frobenius norm."""
        columns = self.columns
        full = self.full
        column = self.left
        first = self.used - rank
        squares = 0.0
        for k in range(rank):
            for j in range(k, rank):
                column[j] = 0.0
            column[k] = full[k]
            for j in range(k, rank):
                column[j] /= columns[first + j, j]
                total = column[j]
                squares += total * total
                for i in range(j + 1, rank):
                    column[i] -= columns[first + j, i] * total
        return 1.0 / math.sqrt(squares) if rank else 0.0

    def _swap(self, a, b):
        columns = self.columns
        sizes = self.sizes
        left = self.left
        order = self.order
        full = self.full
        for i in range(self.size):
            columns[i, a], columns[i, b] = columns[i, b], columns[i, a]
        sizes[a], sizes[b] = sizes[b], sizes[a]
        full[a], full[b] = full[b], full[a]
        left[a], left[b] = left[b], left[a]
        order[a], order[b] = order[b], order[a]

    def _reflect(self, place, count, smallest):
        """Turn the first free direction into the column at `place`."""
        n = self.size
        columns = self.columns
        sizes = self.sizes
        left = self.left
        y = self.y
        first = self.used + place
        vector = self.vectors[first]
        sums = self.sums
        total = 0.0
        for i in range(first, n):
            vector[i] = columns[i, place]
            total += vector[i] * vector[i]
        length = math.sqrt(total)
        head = vector[first]
        vector[first] = head + length if head >= 0.0 else head - length
        scale = 2.0 / (total - head * head + vector[first] * vector[first])
        self.scale[first] = scale
        for j in range(place, count):
            sums[j] = 0.0
            left[j] = 0.0
        for i in range(first, n):
            share = vector[i]
            for j in range(place, count):
                sums[j] += share * columns[i, j]
        for j in range(place, count):
            sums[j] *= scale
        share = vector[first]
        for j in range(place, count):
            columns[first, j] -= share * sums[j]
        for i in range(first + 1, n):
            share = vector[i]
            for j in range(place, count):
                columns[i, j] -= share * sums[j]
                left[j] += columns[i, j] * columns[i, j]
        for j in range(place, count):
            left[j] = math.sqrt(left[j]) / sizes[j] if sizes[j] > smallest else 0.0
        total = 0.0
        for i in range(first, n):
            total += vector[i] * y[i]
        total *= scale
        for i in range(first, n):
            y[i] -= total * vector[i]
