"""What is commanded and measured during bring-up."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.gait.command import Sensors
from plantar.layouts.layout import SoleLayout


class Trace:
    """Rows of a bring-up, one a tick.

    Args:
        layouts: Of each side.
        joints: Number of joint angles.
    """

    def __init__(self, layouts: Mapping[Side, SoleLayout], joints: int) -> None:
        self._positions = {side: layouts[side].positions[:, :2] for side in SIDES}
        self._joints = joints
        self._rows: list[NDArray[np.float64]] = []

    def add(self, time: float, sensors: Sensors, expected: NDArray[np.float64]) -> str | None:
        """Add a tick at a `time` in s of the motion, of commanded joint angles `expected` (k,) in rad.

        Returns what of its `sensors` cannot be read, or None.
        """
        row = [np.array([time]), np.array([_number(getattr(sensors, "time", None))]), expected]
        for name, size in (("joint_positions", self._joints), ("gyro", 3), ("accelerometer", 3)):
            value = _vector(getattr(sensors, name, None), size)
            if value is None:
                return name.replace("_", " ")
            row.append(value)
        readings = getattr(sensors, "readings", None)
        for side in SIDES:
            force = (
                _vector(getattr(readings.get(side), "force", None), len(self._positions[side]), dead=True)
                if (isinstance(readings, Mapping))
                else None
            )
            if force is None:
                return f"{side} sole"
            load = float(force.sum())
            share = force / load if abs(load) > 1e-9 else np.zeros(len(force))
            row += [np.array([load]), share @ self._positions[side], share[::-1] @ self._positions[side]]
        self._rows.append(np.concatenate(row))
        return None

    def __len__(self) -> int:
        return len(self._rows)

    def table(self) -> dict[str, NDArray[np.float64]]:
        """Arrays by name, a row a tick."""
        widths = {"time": 1, "clock": 1, "expected": self._joints}
        widths |= {"joints": self._joints, "gyro": 3, "accelerometer": 3}
        for side in SIDES:  # "reversed": by the taxels in reversed order
            widths |= {f"load_{side}": 1, f"center_{side}": 2, f"reversed_{side}": 2}
        rows = np.array(self._rows).reshape(-1, sum(widths.values()))
        found: dict[str, NDArray[np.float64]] = {}
        at = 0
        for name, width in widths.items():
            found[name] = rows[:, at] if width == 1 else rows[:, at : at + width]
            at += width
        return found


def _number(value: Any) -> float:
    try:
        return float(value)
    except (TypeError, ValueError):
        return float("nan")


def _vector(value: Any, size: int, *, dead: bool = False) -> NDArray[np.float64] | None:
    """Finite numbers (size,); with `dead`, NaN among them are 0."""
    try:
        found = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        return None
    if found.shape != (size,):
        return None
    if dead and np.isfinite(found).any():
        found = np.where(np.isfinite(found), found, 0.0)
    return found if np.isfinite(found).all() else None
