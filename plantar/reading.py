"""One reading of a sole: what its taxels said at one instant."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.errors import ReadingError

__all__ = ["Reading"]


@dataclass(frozen=True, eq=False)
class Reading:
    """What n taxels of one sole measured at one time.

    Attributes:
        time: Time in s.
        force: Normal force (n,) on each taxel in N; NaN marks a dead taxel.
        proximity: Distance (n,) from each taxel to the nearest surface in m, inf where nothing is in range, or None.
        temperature: Temperature (n,) in degC, or None.
        acceleration: Acceleration (n, 3) of each taxel in its own frame in m/s^2, or None.

    Raises:
        ReadingError: If an array is not numeric or its shape does not agree with the number of taxels.

    Example:
        >>> Reading(time=0.0, force=np.array([1.0, 2.0])).force.sum()
        np.float64(3.0)
    """

    time: float
    force: NDArray[np.float64]
    proximity: NDArray[np.float64] | None = None
    temperature: NDArray[np.float64] | None = None
    acceleration: NDArray[np.float64] | None = None

    def __post_init__(self) -> None:
        force = _numbers("force", self.force)
        if force.ndim != 1:
            raise ReadingError(f"reading field 'force' has shape {force.shape}; expected (taxels,)")
        object.__setattr__(self, "force", force)
        if self.proximity is not None:
            self._keep("proximity", self.proximity, force.shape)
        if self.temperature is not None:
            self._keep("temperature", self.temperature, force.shape)
        if self.acceleration is not None:
            self._keep("acceleration", self.acceleration, (*force.shape, 3))

    def _keep(self, name: str, given: ArrayLike, shape: tuple[int, ...]) -> None:
        """Take a field over as numbers of a shape."""
        value = _numbers(name, given)
        if value.shape != shape:
            raise ReadingError(f"reading field '{name}' has shape {value.shape}; expected {shape}")
        object.__setattr__(self, name, value)


def _numbers(name: str, value: ArrayLike) -> NDArray[np.float64]:
    try:
        return np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise ReadingError(f"reading field '{name}' is not numeric") from None
