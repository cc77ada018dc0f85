"""What a check of the fuzz tests has seen: errors of one function on one block of readings, each within its bound."""

import numpy as np
from numpy.typing import ArrayLike

from .soles import Block

__all__ = ["Tally"]


class Tally:
    """Collects the names of what was checked, and fails at the first error beyond its bound."""

    def __init__(self) -> None:
        self.readings: dict[str, int] = {}

    def add(self, name: str, block: Block, errors: ArrayLike, bound: float = 0.0, readings: int | None = None) -> None:
        """Check errors of one function on one block; NaN is beyond every bound.

        Args:
            name: The function.
            block: The readings.
            errors: Error of each reading or each value checked.
            bound: What it may be.
            readings: How many readings were tried; as many as there are errors where None.
        """
        values = np.asarray(errors, dtype=float).reshape(-1)
        self.readings[name] = self.readings.get(name, 0) + (len(values) if readings is None else readings)
        bad = np.flatnonzero(~(values <= bound))
        if bad.size:
            at = int(bad[0])
            raise AssertionError(
                f"{name}: sole '{block.layout.name}', value {at} of {len(values)}: error {values[at]:.3g}, "
                f"allowed {bound:.3g}"
            )
