"""Which feet carry so that they stand still: those that carry nearly all, and those whose load stays as it is.

A sole that comes to carry turns on what it met first until it lies flat, and one that is about to lift off turns on its
last edge: on h1, whose plant differs from its model as it may, by half a milliradian a step, always the same way, where
one hip carries more than the other. That adds up to the heading's error. In single support it turns by a tenth of that.
Both ends of it are cut where the load is the same, so that the body has swayed as far to the side at the one as at the
other: what the legs err by their lean cancels.
"""

from __future__ import annotations

from collections.abc import Mapping

from plantar.kernels.gait.gyro_bias import SteadyLoad as _Kernel
from plantar.sides import Side

__all__ = ["SteadyLoad"]


class SteadyLoad:
    """Compares what each foot carries with what both do, and with its own running mean.

    Attributes:
        kernel: What computes it: the estimator calls it within its own.

    Args:
        period: Control period in s.
        share: Share of what both feet carry from which one stands still; the other one then does not.
        time_constant: Time constant in s of the running mean.
        band: Largest difference in N of load and mean of a foot that stands still beside the other one.

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
        """One control tick.

        Args:
            loads: What each foot carries in N; 0 for one that does not count as loaded.

        Returns:
            The same loads in N, 0 of a foot that may turn.
        """
        kernel = self.kernel
        kernel.update(loads["left"], loads["right"])
        return {"left": kernel.left, "right": kernel.right}
