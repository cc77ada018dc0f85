"""Confidence of a share of runs."""

import math

_NORMAL_95 = 1.959963984540054  # 97.5 % of a standard normal variable are below


def wilson_interval(completed: int, runs: int) -> tuple[float, float]:
    """Returns Wilson's 95 % score interval of `completed` in `runs`; (0, 1) without a run.

    A ValueError unless `completed` is within 0 and `runs`. Wilson, Probable inference, the law of succession, and
    statistical inference (JASA 22, 1927).

    Example:
        >>> [round(end, 3) for end in wilson_interval(8, 10)]
        [0.49, 0.943]
    """
    if not 0 <= completed <= runs:
        raise ValueError(f"{completed} of {runs} runs cannot be completed")
    if runs == 0:
        return 0.0, 1.0
    share = completed / runs
    square = _NORMAL_95**2 / runs
    middle = (share + square / 2.0) / (1.0 + square)
    half = math.sqrt(square * (share * (1.0 - share) + square / 4.0)) / (1.0 + square)
    # Rounding would leave 1e-17 where the end is exact.
    return (0.0 if completed == 0 else middle - half), (1.0 if completed == runs else middle + half)
