"""One boundary between millimetres (inside `shoes`) and SI (everywhere else)."""

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

MM_PER_M = 1000.0  # millimetres in a metre

_Length = TypeVar("_Length", float, NDArray[np.float64])


def to_m(length: _Length) -> _Length:
    """Length or array of lengths in mm, in m.

    Example:
        >>> to_m(250.0)
        0.25
    """
    return length / MM_PER_M


def to_mm(length: _Length) -> _Length:
    """Length or array of lengths in m, in mm.

    Example:
        >>> to_mm(0.25)
        250.0
    """
    return length * MM_PER_M
