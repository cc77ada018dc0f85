"""Which loaded feet are still: those that carry nearly all, and those with a steady load.

A landing sole turns until it lies flat, and one that lifts off turns on its last edge: on h1 with a random plant by
half a milliradian a step, always the same way, which adds up in the heading; in single support by a tenth of that. Both
ends of a stance are cut at the same load, so that the body has swayed equally far at both and the error by its lean
cancels.
"""

from __future__ import annotations

from collections.abc import Mapping

from plantar.kernels.gait.gyro_bias import SteadyLoad as _Kernel
from plantar.sides import Side

__all__ = ["SteadyLoad"]


class SteadyLoad:
    """Compares each foot's load with the total and with its own running mean.

    Attributes:
        kernel: The compiled part, which the estimator calls within its own.

    Args:
        period: Control period in s.
        share: Share of the total load from which a foot is still; the other one then is not.
        time_constant: Time constant in s of the running mean.
        band: Largest difference in N of load and mean of a still foot.

    Example:
        >>> steady = SteadyLoad(0.005, 0.8, 0.25, 40.0)
        >>> steady.update({"left": 400.0, "right": 400.0})
        {'left': 400.0, 'right': 400.0}
        >>> steady.update({"left": 500.0, "right": 300.0})
        {'left': 0.0, 'right': 0.0}
        >>> steady.update({"left": 700.0, "right": 100.0})
        {'left': 700.0, 'right': 0.0}
    """

    def __init__(self, period: float, share: float, time_constant: float, band: float) -> None:
        self.kernel = _Kernel(share, min(1.0, period / time_constant), band)

    def update(self, loads: Mapping[Side, float]) -> dict[Side, float]:
        """Advance by one control tick.

        Args:
            loads: Load of each foot in N; 0 for an unloaded one.

        Returns:
            The loads in N, 0 for a foot that may turn.
        """
        kernel = self.kernel
        kernel.update(loads["left"], loads["right"])
        return {"left": kernel.left, "right": kernel.right}
