"""Undo what clipping at zero does to the mean of a noisy sensor.

A taxel cannot read less than nothing. Where it carries little, noise is cut off below and kept above, so a running mean
of its readings comes out too high: by 0.4 sigma without load. Over a sole this adds up to some tens of newtons at
places without load. With white noise of a known sigma the mean of the clipped reading of a force f is

    g(f) = f P(f / sigma) + sigma p(f / sigma)

with P and p the normal distribution and its density; the inverse of g takes the mean back to the force.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.errors import InputError

__all__ = ["clipped_mean", "unclipped_mean"]

_NEGLIGIBLE = 1e-12  # N
_FORCE = np.linspace(0.0, 6.0, 601)  # in sigma; above it nothing is cut off
_MEAN = np.array(
    [0.5 * f * math.erfc(-f / math.sqrt(2.0)) + math.exp(-0.5 * f * f) / math.sqrt(2.0 * math.pi) for f in _FORCE]
)
# The inverse, with the tangent below the mean without load (slope 2) and itself far above.
_TABLE = (np.array([0.0, *_MEAN, 1e300]), np.array([-2.0 * _MEAN[0], *_FORCE, 1e300]))


def clipped_mean(force: ArrayLike, noise: float) -> NDArray[np.float64]:
    """Mean reading of a sensor whose noise is clipped at zero.

    Args:
        force: Forces (...) in N, 0 or more.
        noise: Standard deviation sigma of its white noise in N.

    Returns:
        Means (...) in N.

    Example:
        >>> clipped_mean([0.0, 10.0], 1.0).round(3).tolist()
        [0.399, 10.0]
    """
    given = np.asarray(force, dtype=float)
    if noise < _NEGLIGIBLE:
        return np.asarray(np.maximum(given, 0.0), dtype=np.float64)
    return np.asarray(np.where(given > 6.0 * noise, given, noise * np.interp(given / noise, _FORCE, _MEAN)))


def unclipped_mean(mean: ArrayLike, noise: float) -> NDArray[np.float64]:
    """Force behind the mean of a sensor's readings whose noise is clipped at zero: the inverse of `clipped_mean`.

    A mean below that of no load gives a force below zero, along the tangent: cut off again, the forces of many unloaded
    taxels would add up again.

    Args:
        mean: Running means (...) of the readings in N.
        noise: Standard deviation sigma of the white noise in N.

    Returns:
        Forces (...) in N.

    Raises:
        InputError: If the noise is not finite and 0 or more.

    Example:
        >>> unclipped_mean(clipped_mean([0.0, 1.0, 10.0], 1.5), 1.5).round(3).tolist()
        [0.0, 1.0, 10.0]
    """
    if not 0.0 <= noise < math.inf:
        raise InputError(f"noise of a sensor is {noise} N; allowed: finite, 0 or more")
    given = np.asarray(mean, dtype=float)
    if noise < _NEGLIGIBLE:
        return np.array(given)
    return np.asarray(np.interp(given, noise * _TABLE[0], noise * _TABLE[1]), dtype=np.float64)
