"""One reading of a skin: a sole, or patches on a body."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import NDArray

from plantar.common.arguments import number
from plantar.common.arrays import numbers, own
from plantar.common.record import constructed_by_kernel
from plantar.errors import ReadingError
from plantar.kernels.skin.percept_fields import ReadingFields

_TIME = "reading field 'time'"
_FORCE = "reading field 'force'"


@constructed_by_kernel
@dataclass(frozen=True, eq=False, init=False, repr=False)
class Reading(ReadingFields):
    """Measurements of a skin's n taxels at one time, read-only: of one sole, or of a `BodySkin` in its order.

    Attributes:
        time: Time in s.
        force: Normal force (n,) on each taxel in N; NaN marks a dead taxel.
        proximity: Distance (n,) from each taxel to nearest surface in m, inf out of range, or None.
        temperature: Temperature (n,) in degC, or None.
        acceleration: Acceleration (n, 3) of each taxel in its own frame in m/s^2, or None.

    Raises:
        ReadingError: Shapes differ.

    Example:
        >>> Reading(time=0.0, force=np.array([1.0, 2.0])).force.sum()
        np.float64(3.0)
    """

    # Without values here: the class that is compiled holds them.
    time: float
    force: NDArray[np.float64]
    proximity: NDArray[np.float64] | None
    temperature: NDArray[np.float64] | None
    acceleration: NDArray[np.float64] | None

    if TYPE_CHECKING:

        def _keep(self, *fields: Any) -> None: ...
        def _take_over(self, *fields: Any) -> None: ...

    def __init__(
        self,
        time: float,
        force: NDArray[Any] | Sequence[float],
        proximity: NDArray[Any] | Sequence[float] | None = None,
        temperature: NDArray[Any] | Sequence[float] | None = None,
        acceleration: NDArray[Any] | Sequence[Sequence[float]] | None = None,
    ) -> None: ...

    def __repr__(self) -> str:
        others = ("proximity", "temperature", "acceleration")
        more = "".join(f", with {name}" for name in others if getattr(self, name) is not None)
        return f"Reading({self.time:.3f} s: {len(self.force)} taxels, {np.nansum(self.force):.1f} N{more})"

    def _checked(
        self, time: object, force: object, proximity: object, temperature: object, acceleration: object
    ) -> tuple[Any, ...]:
        """Fields of a reading that is not plain."""
        at = number(time, _TIME, ReadingError, finite=True)
        values = own(numbers(force, _FORCE, ReadingError))
        if values.ndim != 1:
            raise ReadingError(f"{_FORCE} has shape {values.shape}; expected (taxels,)")
        shape = values.shape
        return (
            at,
            values,
            None if proximity is None else _field("proximity", proximity, shape),
            None if temperature is None else _field("temperature", temperature, shape),
            # nature: vectors of space
            None if acceleration is None else _field("acceleration", acceleration, (*shape, 3)),
        )

    @property
    def distance(self) -> NDArray[np.float64]:
        """Distance (n,) from each taxel to the nearest surface in m; inf out of range, or where it is not measured."""
        return np.full(self.force.shape, np.inf) if self.proximity is None else self.proximity

    @classmethod
    def taken_over(cls, time: float, force: NDArray[np.float64], proximity: NDArray[np.float64] | None = None) -> Self:
        """Reading of arrays made for it, neither copied nor checked.

        Args:
            time: Time in s.
            force: Forces (n,) in N of float64 without another owner; closed to writing.
            proximity: Distances (n,) in m likewise, or None.

        Returns:
            Reading, without temperature and acceleration.
        """
        reading = cls.__new__(cls)
        reading._take_over(time, force, proximity)
        return reading

    def __reduce__(self) -> tuple[Any, ...]:
        # Copies and pickles are made anew: numpy forgets what is read-only.
        return type(self), (self.time, self.force, self.proximity, self.temperature, self.acceleration)


def _field(name: str, given: object, shape: tuple[int, ...]) -> NDArray[np.float64]:
    value = own(numbers(given, f"reading field '{name}'", ReadingError))
    if value.shape != shape:
        raise ReadingError(f"reading field '{name}' has shape {value.shape}; expected {shape}")
    return value
