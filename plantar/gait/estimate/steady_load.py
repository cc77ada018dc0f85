"""Which loaded feet are still: those that carry nearly all, and those with a steady load.

A foot that lands or lifts off turns always the same way, which would add up in the heading.
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
        """The loads in N after one more control tick, 0 for a foot that may turn; `loads` are those of each foot
        in N.
        """
        kernel = self.kernel
        kernel.update(loads["left"], loads["right"])
        return {"left": kernel.left, "right": kernel.right}
