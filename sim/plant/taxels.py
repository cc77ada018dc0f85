"""What true taxels make of the forces on them: gains that differ, and forces that their neighbours feel."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plantar.layouts.layout import SoleLayout

__all__ = ["TaxelErrors"]


class TaxelErrors:
    """The errors of one sole's taxels.

    Args:
        layout: The sole.
        gains: What each taxel (n,) reads of the force that it feels.
        crosstalk: Share of each taxel's force that its neighbours feel instead, each as much: a cover that is stiff
            carries it there. A taxel without neighbours keeps it.

    Example:
        >>> from plantar import hex_layout
        >>> layout = hex_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]])
        >>> errors = TaxelErrors(layout, np.ones(len(layout)), 0.1)
        >>> force = np.eye(len(layout))[0]
        >>> felt = errors.felt(10.0 * force)
        >>> round(float(felt[0]), 9), round(float(felt.sum()), 9)
        (9.0, 10.0)
    """

    def __init__(self, layout: SoleLayout, gains: NDArray[np.float64], crosstalk: float) -> None:
        spread = np.eye(len(layout))
        for i, near in enumerate(layout.neighbours):
            if near:
                spread[i, i] -= crosstalk
                spread[list(near), i] = crosstalk / len(near)
        self._felt = gains[:, None] * spread

    def felt(self, force: NDArray[np.float64]) -> NDArray[np.float64]:
        """What the taxels read.

        Args:
            force: Force (n,) on each taxel in N.

        Returns:
            What each reads (n,) in N.
        """
        return np.asarray(self._felt.dot(force))
