"""How what is measured follows what was expected: by how much, and how late."""

import numpy as np
from numpy.typing import NDArray


def response(expected: NDArray[np.float64], measured: NDArray[np.float64]) -> NDArray[np.float64]:
    """Matrix (m, k) from causes (n, k) to effects (n, m), but for constants, with least squares."""
    cause = expected - expected.mean(axis=0)
    solution, *_ = np.linalg.lstsq(cause, measured - measured.mean(axis=0), rcond=None)
    return np.asarray(solution.T)


def delayed_response(
    expected: NDArray[np.float64], measured: NDArray[np.float64], most: float, period: float
) -> tuple[NDArray[np.float64], int]:
    """Linear response with least squares at the delay that explains the largest share of the variance.

    Args:
        expected: Causes (n, k).
        measured: Effects (n, m).
        most: Largest delay in s that is tried.
        period: Time in s between two rows.

    Returns:
        Matrix (m, k) from causes to effects, and the delay in rows; zeros for causes that do not vary.
    """
    best = np.inf
    found = np.zeros((measured.shape[1], expected.shape[1])), 0
    for late in range(round(most / period) + 1):
        cause = expected[: len(expected) - late]
        effect = measured[late:]
        effect = effect - effect.mean(axis=0)
        matrix = response(cause, effect)
        left = effect - (cause - cause.mean(axis=0)) @ matrix.T
        rest = float(np.square(left).sum()) / max(float(np.square(effect).sum()), 1e-30)
        if rest < best - 1e-12:
            best = rest
            found = matrix, late
    return found
