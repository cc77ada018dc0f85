# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
# cython: infer_types=True
"""Work arrays: arrays for compiled kernels, lists for interpreted ones, for speed."""

import numpy as np

__all__ = ["numbers", "places"]


def numbers(size, lists):
    """So many zeros, in a list if `lists`, else an array."""
    return [0.0] * size if lists else np.zeros(size)


def places(size, lists):
    """So many indices, all 0; `lists` likewise."""
    return [0] * size if lists else np.zeros(size, dtype=np.intp)
