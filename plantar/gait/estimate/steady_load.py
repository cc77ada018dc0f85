"""Still feet: carrying nearly all, or steadily.

Landing and lifting feet always turn the same way, which would add up in heading.
"""

from collections.abc import Mapping

from plantar.kernels.gait.gyro_bias import SteadyLoad as _Kernel
from plantar.sides import Side


class SteadyLoad:
    """Compares a foot's load with the total and its own mean.

    Attributes:
        kernel: Compiled part, called within the estimator's.

    Args:
        period: Of control in s.
        share: Share of total load of a still foot; the other then is not.
        time_constant: Of the running mean in s.
        band: Still foot's largest difference in N of load and mean.
    """

    def __init__(self, period: float, share: float, time_constant: float, band: float) -> None:
        self.kernel = _Kernel(share, min(1.0, period / time_constant), band)

    def update(self, loads: Mapping[Side, float]) -> dict[Side, float]:
        """Loads in N after a tick, 0 for a foot that can turn; `loads`: each foot's in N."""
        kernel = self.kernel
        kernel.update(loads["left"], loads["right"])
        return {"left": kernel.left, "right": kernel.right}
