"""How what is measured follows what was expected: by how much, and how late."""

import numpy as np
from numpy.typing import NDArray


def delayed_response(
    expected: NDArray[np.float64], measured: NDArray[np.float64], most: float, period: float, step: float = 0.0
) -> tuple[NDArray[np.float64], int]:
    """Linear response with least squares at the delay that explains the largest share of the variance.

    Args:
        expected: Causes (n, k).
        measured: Effects (n, m).
        most: Largest delay in s that is tried.
        period: Time in s between two rows.
        step: Between two delays that are tried in s; 0: a row.

    Returns:
        Matrix (m, k) from causes to effects, and the delay in rows; zeros for causes that do not vary.
    """
    best = np.inf
    found = np.zeros((measured.shape[1], expected.shape[1])), 0
    for late in range(0, round(most / period) + 1, max(1, round(step / period))):
        cause = expected[: len(expected) - late]
        cause = cause - cause.mean(axis=0)
        effect = measured[late:]
        effect = effect - effect.mean(axis=0)
        solution, *_ = np.linalg.lstsq(cause, effect, rcond=None)
        rest = float(np.square(effect - cause @ solution).sum()) / max(float(np.square(effect).sum()), 1e-30)
        if rest < best - 1e-12:
            best = rest
            found = solution.T, late
    return found
