"""Least squares in some directions within limits on all: a hierarchy's level (Escande et al. 2014)."""

from typing import NamedTuple, Self

import daqp
import numpy as np
from numpy.typing import NDArray
from scipy.linalg import null_space

_KEPT = 1e-9  # share of a limit's row by which it may be missed
_ROUNDS = 4  # of limits that are found to act only once others do
_LEAST = 1e-6  # weight of motion that a level does not care for, while its limits are looked for
_SOFT = 8  # daqp's word for a limit that may give way


class Box(NamedTuple):
    """Limits low <= rows y <= high; if they conflict, the first `hard` yield last.

    `rows`: rows (m, n), each of size 1; `low`: lower ends (m,); -inf for none; `high`: upper ends (m,); inf for none.
    """

    rows: NDArray[np.float64]
    low: NDArray[np.float64]
    high: NDArray[np.float64]
    hard: int

    @classmethod
    def of(
        cls,
        hard: NDArray[np.float64],
        least: NDArray[np.float64],
        most: NDArray[np.float64],
        soft: NDArray[np.float64],
        low: NDArray[np.float64],
        high: NDArray[np.float64],
    ) -> Self:
        """Both sets of rows, each scaled to size 1.

        `hard`: rows (h, n) of hard limits; `least`: their lower ends (h,); `most`: their upper ends (h,); `soft`: rows
        (s, n) of soft limits; `low`: their lower ends (s,); `high`: their upper ends (s,).
        """
        rows = np.vstack([hard, soft])
        sizes = np.maximum(np.sqrt(np.einsum("ij,ij->i", rows, rows)), np.finfo(float).tiny)
        return cls(rows / sizes[:, None], np.hstack([least, low]) / sizes, np.hstack([most, high]) / sizes, len(hard))


def nearest_within(
    box: Box,
    y: NDArray[np.float64],
    left: NDArray[np.float64],
    own: NDArray[np.float64],
    target: NDArray[np.float64],
    weights: NDArray[np.float64],
) -> tuple[Box, NDArray[np.float64]]:
    """Nearest point to the target in the directions `own`, such that some of the rest keeps the limits.

    `y`: settled part (n,); `left`: orthonormal basis (n, k) of what may still be added to it; `own`: orthonormal
    directions (r, k) in this basis; `target`: wanted along them (r,); `weights`: weight (r,) of squared miss along
    each. Returns limits, widened as little as needed, and result (r,) along `own`.
    """
    reached = box.rows @ y
    rows = box.rows @ left
    low = box.low - reached
    high = box.high - reached
    z = target @ own
    if _miss(rows, low, high, z).max(initial=0.0) <= 0.0:
        return box, target
    seen = np.einsum("ij,ij->i", rows, rows) > _KEPT**2  # others are decided by the levels above
    rows = rows[seen]
    low = low[seen]
    high = high[seen]
    scale = weights / weights.max()
    hessian = (own.T * scale) @ own + _LEAST * np.eye(left.shape[1])
    gradient = -(scale * target) @ own
    z, _, flag, info = daqp.solve(hessian, gradient, rows, high, low, primal_tol=_KEPT)
    if flag < 0:
        box = _widened(box, y, left)
        low = (box.low - reached)[seen]
        high = (box.high - reached)[seen]
        z, _, flag, info = daqp.solve(hessian, gradient, rows, high, low)
    acting = np.abs(info["lam"]) > 0.0
    root = np.sqrt(scale)
    for _ in range(_ROUNDS):
        held = np.where(rows[acting] @ z > (low + high)[acting] / 2.0, high[acting], low[acting])
        fixed = np.linalg.lstsq(rows[acting], held, rcond=_KEPT)[0]
        free = null_space(rows[acting], rcond=_KEPT)
        exact = fixed + free @ np.linalg.lstsq((root[:, None] * own) @ free, root * (target - own @ fixed), _KEPT)[0]
        missed = _miss(rows, low, high, exact) > _KEPT * (1.0 + np.abs(exact).max())
        if not missed.any():
            return box, own @ exact
        acting |= missed
    return box, own @ z


def _widened(box: Box, y: NDArray[np.float64], left: NDArray[np.float64]) -> Box:
    """Feasible limits: accelerations' yield first, then torques'."""
    reached = box.rows @ y
    least = _LEAST * np.eye(left.shape[1])
    for hard in (box.hard, 0):
        soft = np.where(np.arange(len(box.rows)) < hard, 0, _SOFT).astype(np.int32)
        rows = box.rows @ left
        nothing = np.zeros(left.shape[1])
        z, _, flag, _ = daqp.solve(least, nothing, rows, box.high - reached, box.low - reached, soft)
        if flag > 0:
            break
    at = reached + rows @ z
    slack = 1e-6 * (1.0 + np.abs(at))
    return box._replace(low=np.minimum(box.low, at - slack), high=np.maximum(box.high, at + slack))


def _miss(
    rows: NDArray[np.float64], low: NDArray[np.float64], high: NDArray[np.float64], z: NDArray[np.float64]
) -> NDArray[np.float64]:
    """By how much each row misses its limits; negative within."""
    at = rows @ z
    return np.asarray(np.maximum(low - at, at - high))
