"""Rectangle with a safety offset, for the limits of a contact wrench cone (T 4.4.4)."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.arguments import number
from plantar.errors import InputError
from plantar.geometry.enclosing import bounding_box
from plantar.geometry.inscribed import inscribed_rectangle

__all__ = ["safe_rectangle"]


def safe_rectangle(
    polygon: ArrayLike, offset: float, method: Literal["inscribed", "bounding"] = "inscribed"
) -> NDArray[np.float64]:
    """Axis-aligned rectangle that stands for the contact in the wrench cone (T 4.32-4.41, corrected).

    Its sides move inwards by a safety offset. The bounding box is faster and reaches beyond the contact (T
    4.4.4).

    Args:
        polygon: Convex support polygon (k, 2) in the contact frame in m.
        offset: How far each side moves inwards in m, 0 or more; T uses 0.01.
        method: "inscribed" or "bounding".

    Returns:
        Corners (4, 2) in m from the lower left one: its row 0 is (Xmin, Ymin), its row 2 (Xmax, Ymax). Sides that
        would pass each other meet in the middle. No corners (0, 2) for an empty polygon.

    Raises:
        InputError: If the polygon is not (k, 2) numbers, the offset is not finite and 0 or more, or the method is
            neither.

    Example:
        >>> safe_rectangle([[0.0, 0.0], [0.2, 0.0], [0.2, 0.1], [0.0, 0.1]], 0.01).round(9).tolist()
        [[0.01, 0.01], [0.19, 0.01], [0.19, 0.09], [0.01, 0.09]]
    """
    inwards = number(offset, "safety offset", nan=True)
    if not 0.0 <= inwards < np.inf:
        raise InputError(f"safety offset is {offset} m; allowed: finite, 0 or more")
    if method not in ("inscribed", "bounding"):
        raise InputError(f"method is {method!r}; allowed: inscribed, bounding")
    box = inscribed_rectangle(polygon) if method == "inscribed" else bounding_box(polygon)
    if len(box) == 0:
        return box
    low, high = box[0], box[2]
    middle = 0.5 * (low + high)
    (x1, y1), (x2, y2) = np.minimum(low + inwards, middle), np.maximum(high - inwards, middle)
    return np.array([[x1, y1], [x2, y1], [x2, y2], [x1, y2]])
