"""Which taxels are in contact."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["active_taxels"]


def active_taxels(force: NDArray[np.float64], threshold: float) -> NDArray[np.bool_]:
    """Taxels whose force exceeds the activation threshold (T 4.22: |f_iz| > epsilon_f).

    A taxel that reads NaN or inf is dead: it is never active. Force pulls do not exist at a sole, so a negative
    reading is noise or drift and is not active either.

    Args:
        force: Normal forces (..., n) in N.
        threshold: Activation threshold epsilon_f in N.

    Returns:
        Mask (..., n).

    Example:
        >>> active_taxels(np.array([0.0, 2.0, np.nan]), 1.47).tolist()
        [False, True, False]
    """
    return np.asarray((force > threshold) & (force < np.inf))
