# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
# cython: infer_types=True
"""Work arrays: arrays for compiled kernels, lists for interpreted ones, which read them faster."""

import numpy as np

__all__ = ["numbers", "places"]


def numbers(size, lists):
    """So many zeros, in a list instead of an array if `lists`."""
    return [0.0] * size if lists else np.zeros(size)


def places(size, lists):
    """So many indices, all 0, in a list instead of an array if `lists`."""
    return [0] * size if lists else np.zeros(size, dtype=np.intp)
