"""ZMP from skin against force-torque sensors at the ankles (T 4.3.1, Fig. 42-43).

Both share a low pass and the controller's feet; clipped noise is corrected (`plantar.gait.estimate.skin_load`).
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES
from plantar.gait.controller import Command
from plantar.gait.estimate.ankle_sensor import SoleWrench
from plantar.gait.estimate.skin_load import SkinLoad
from plantar.layouts.layout import Side, SoleLayout
from plantar.mechanics.zmp import zmp_of_feet

FILTER_TIME = 0.02
"""Time constant in s of both low-pass filters: that of the balance laws' own."""


_BEGIN = 1.0  # s from which it counts


class ZmpComparison:
    """Follows both ZMPs through a run.

    `noise`: standard deviation of a taxel in N; `period`: control period in s. Attributes `latest`: world ZMP (2,) in m
    from the skin and from the ankles, None without load.
    """

    def __init__(self, layouts: Mapping[Side, SoleLayout], noise: float, period: float) -> None:
        self._share = period / (FILTER_TIME + period)
        self._skins = {s: SkinLoad(layouts[s], noise, self._share) for s in SIDES}
        self._wrenches: dict[Side, NDArray[np.float64]] = {}
        self._differences: list[NDArray[np.float64]] = []
        self.latest: tuple[NDArray[np.float64] | None, NDArray[np.float64] | None] = (None, None)

    def update(self, time: float, command: Command) -> None:
        """Take the tick's `command` at `time` in s, with sensor data and ankle loads."""
        skin: list[NDArray[np.float64] | None] = []
        ankle: list[NDArray[np.float64] | None] = []
        skin_loads: list[float] = []
        ankle_loads: list[float] = []
        for side in SIDES:
            wrench = command.ankle_loads[side].wrench_in_sole
            last = self._wrenches.get(side, wrench)
            self._wrenches[side] = last + self._share * (wrench - last)
            place = command.state.positions_sole[side][:2]
            turn = command.state.rotations_sole[side][:2, :2]
            for points, loads, sole in (
                (skin, skin_loads, self._skins[side].update(command.percepts[side].reading)),
                (ankle, ankle_loads, SoleWrench(self._wrenches[side])),
            ):
                cop = sole.position_cop_in_sole
                loads.append(sole.vertical_force)
                points.append(None if cop is None else place + turn @ cop)
        one = zmp_of_feet(skin, skin_loads)
        other = zmp_of_feet(ankle, ankle_loads)
        if one is not None and other is not None and time >= _BEGIN:
            self._differences.append(one - other)
        self.latest = (one, other)

    def summary(self) -> dict[str, Any]:
        """RMS, largest and mean (x, y) distance between the ZMPs in m."""
        if not self._differences:
            return {"samples": 0, "rms_m": None, "max_m": None, "mean_m": None}
        rows = np.array(self._differences)
        distance = np.hypot(rows[:, 0], rows[:, 1])
        return {
            "samples": len(rows),
            "rms_m": round(float(np.sqrt(np.mean(distance**2))), 5),
            "max_m": round(float(distance.max()), 5),
            "mean_m": [round(float(v), 5) for v in rows.mean(axis=0)],
            "filter_s": FILTER_TIME,
        }
