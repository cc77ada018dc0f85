# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
# cython: infer_types=True
"""Work arrays of the kernels: arrays for the compiled form, lists for the interpreted one, which reads them faster."""

from __future__ import annotations

import numpy as np

__all__ = ["numbers", "places"]


def numbers(size, lists):
    """Room for so many numbers, all 0.

    Args:
        size: How many.
        lists: Make a list instead of an array.
    """
    return [0.0] * size if lists else np.zeros(size)


def places(size, lists):
    """Room for so many indices, all 0.

    Args:
        size: How many.
        lists: Make a list instead of an array.
    """
    return [0] * size if lists else np.zeros(size, dtype=np.intp)
