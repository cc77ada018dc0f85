"""Mean of a noisy sensor clipped at zero, corrected.

Without load it is too high by 0.4 sigma. With white noise of known sigma the mean of the clipped reading of a force f
is

    g(f) = f P(f / sigma) + sigma p(f / sigma)
"""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import LARGEST, number
from plantar.common.arrays import is_finite, numbers
from plantar.errors import InputError

# N
_NEGLIGIBLE = 1e-12  # nature: far below any sensor's noise
_LOUDEST = 1e6  # nature: far above any sensor's noise
# in sigma; above it nothing is cut off; nature: the normal distribution beyond 6 sigma is 1e-9
_FORCE = np.linspace(0.0, 6.0, 601)
_MEAN = np.array(  # nature: the mean of max(f + noise, 0) of a normal noise: f Phi(f) + phi(f)
    [0.5 * f * math.erfc(-f / math.sqrt(2.0)) + math.exp(-0.5 * f * f) / math.sqrt(2.0 * math.pi) for f in _FORCE]
)
# nature: The inverse, with the tangent below the mean without load (slope 2) and itself far above.
_TABLE = (np.array([0.0, *_MEAN, 1e300]), np.array([-2.0 * _MEAN[0], *_FORCE, 1e300]))


def clipped_mean(force: ArrayLike, noise: float) -> NDArray[np.float64]:
    """Mean reading of a sensor whose noise is clipped at zero.

    `force`: forces (...) in N, 0 or more; `noise`: standard deviation sigma of its white noise in N.

    Returns means (...) in N; InputError: noise negative.
    """
    given = numbers(force, "forces")
    sigma = _sigma(noise)
    if sigma < _NEGLIGIBLE:
        return np.asarray(np.maximum(given, 0.0), dtype=np.float64)
    within = np.minimum(given, 6.0 * sigma)  # derived: the table's end
    # derived: the table's end
    return np.asarray(np.where(given > 6.0 * sigma, given, sigma * np.interp(within / sigma, _FORCE, _MEAN)))


def unclipped_mean(mean: ArrayLike, noise: float) -> NDArray[np.float64]:
    """Force behind the mean of clipped readings: the inverse of `clipped_mean`.

    A mean below that of no load gives a force below zero, along the tangent.

    `mean`: running means (...) of readings in N; `noise`: standard deviation sigma of white noise in N.

    Returns forces (...) in N; InputError: noise negative.

    Example:
        >>> unclipped_mean(clipped_mean([0.0, 1.0, 10.0], 1.5), 1.5).round(3).tolist()
        [0.0, 1.0, 10.0]
    """
    given = numbers(mean, "means")
    sigma = _sigma(noise)
    if sigma < _NEGLIGIBLE:
        return np.array(given)
    force = np.asarray(np.interp(given, sigma * _TABLE[0], sigma * _TABLE[1]), dtype=np.float64)
    return force if is_finite(given) else np.where(np.abs(given) <= LARGEST, force, given)


def _sigma(noise: float) -> float:
    sigma = number(noise, "noise of a sensor", nan=True)
    if not 0.0 <= sigma <= _LOUDEST:
        raise InputError(f"noise of a sensor is {noise} N; allowed: 0 to {_LOUDEST:g} N")
    return sigma
