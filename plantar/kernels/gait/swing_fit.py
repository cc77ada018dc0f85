"""Kernel of `plantar.gait.feet.swing_fit` (K 13-16): ridge regression of three axes through both ends."""

import math

__all__ = ["fit"]


def fit(order, now, before, conditions, same, high, pull, way, work, out):
    """Path at one moment, with derivatives: y = y_i + s^n way + sum a_k (s^k - s^n), which keeps both ends.

    Conditions: position, first and second derivative at `before`.

    `conditions`: weight, and value less start, of each condition (3, 1 + 3); `same`: matrix (m, m) and, in column m,
    pull of way, of all axes, m = n - 1; `high`: additional terms of third axis (m, m + 2): a matrix, and pulls of
    height and way; `way`: end less start (3,); `work`: scratch (6 + 2 m, n + 1); `out`: receives path less its start,
    and its derivatives by share (3, 3).
    """
    n = order
    m = order - 1
    for i in range(2):
        s = now if i == 0 else before
        power = 1.0
        for k in range(n + 1):
            work[3 * i, k] = power
            power *= s
        work[3 * i + 1, 0] = 0.0
        work[3 * i + 2, 0] = 0.0
        work[3 * i + 2, 1] = 0.0
        for k in range(1, n + 1):
            work[3 * i + 1, k] = k * work[3 * i, k - 1]
        for k in range(2, n + 1):
            work[3 * i + 2, k] = k * (k - 1) * work[3 * i, k - 2]
    for i in range(6):
        for k in range(1, n):
            work[i, k] -= work[i, n]
    # Rows from 6 on hold the matrix and then its factor, the m behind them a right side and then the coefficients.
    for axes in range(2):
        for j in range(m):
            for k in range(j + 1):
                total = same[j, k]
                for i in range(3):
                    total += conditions[i, 0] * work[3 + i, j + 1] * work[3 + i, k + 1]
                work[6 + j, k] = total + high[j, k] if axes == 1 else total
        for j in range(m):  # Cholesky
            for k in range(j + 1):
                total = work[6 + j, k]
                for i in range(k):
                    total -= work[6 + j, i] * work[6 + k, i]
                work[6 + j, k] = math.sqrt(total) if j == k else total / work[6 + k, k]
        for axis in range(2 * axes, 2 + axes):
            for j in range(m):
                total = same[j, m] * way[axis]
                if axis == 2:
                    total += high[j, m] * pull + high[j, m + 1] * way[2]
                for i in range(3):
                    left = conditions[i, 1 + axis] - work[3 + i, n] * way[axis]
                    total += conditions[i, 0] * work[3 + i, j + 1] * left
                for i in range(j):
                    total -= work[6 + j, i] * work[6 + m + i, 0]
                work[6 + m + j, 0] = total / work[6 + j, j]
            for j in range(m - 1, -1, -1):
                total = work[6 + m + j, 0]
                for i in range(j + 1, m):
                    total -= work[6 + i, j] * work[6 + m + i, 0]
                work[6 + m + j, 0] = total / work[6 + j, j]
            for i in range(3):
                total = work[i, n] * way[axis]
                for j in range(m):
                    total += work[i, j + 1] * work[6 + m + j, 0]
                out[i, axis] = total
