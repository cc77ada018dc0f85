"""White noise of a sensor, drawn in blocks."""

import numpy as np
from numpy.typing import NDArray

from plantar.kernels.sensors.noise_rows import NoiseRows

_TOGETHER = 64  # samples that are drawn at once: a draw of forty numbers costs twice as much alone


def white_noise(rng: np.random.Generator, mean: float, std: float | NDArray[np.float64], count: int) -> NoiseRows:
    """Yields samples (count,) without end, those of repeated `rng.normal(mean, std, count)`.

    No other caller may draw from `rng`.

    Example:
        >>> samples = white_noise(np.random.default_rng(1), 0.0, 2.0, 3)
        >>> rng = np.random.default_rng(1)
        >>> all(bool((next(samples) == rng.normal(0.0, 2.0, 3)).all()) for _ in range(200))
        True
    """

    def drawn() -> NDArray[np.float64]:
        # `rng.normal` takes three times as long where numbers have standard deviations of their own.
        return np.asarray(mean + std * rng.standard_normal((_TOGETHER, count)))

    return NoiseRows(drawn)
