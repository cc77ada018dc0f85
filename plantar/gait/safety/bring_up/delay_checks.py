"""Delays of encoders and IMU, by how late they follow what is commanded."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.gait.safety.bring_up.finding import Finding

_LATE = 0.15  # s by which angles follow commands; drawn plants with a quarter of the stiffness have 0.1
_APART = 0.02  # s between encoders and gyro; drawn plants have 0.005

MOST_LATE = 0.3
"""Delay in s up to which is tried."""


def check_delays(joints: int, gyro: int | None, period: float) -> list[Finding]:
    """Findings by the delays of `joints` and `gyro`, in ticks of a `period` in s; None where the gyro is silent."""
    found: list[Finding] = []
    if joints * period > _LATE:
        text = f"angles follow what is commanded by {joints * period:.3f} s"
        found.append(Finding("encoders or drives late", text, f"{_LATE} s"))
    apart = 0.0 if gyro is None else (joints - gyro) * period
    if abs(apart) > _APART:
        late = "encoders" if apart > 0.0 else "IMU"
        other = "IMU" if apart > 0.0 else "encoders"
        text = f"they turn with the torso {abs(apart):.3f} s after the {other}"
        found.append(Finding(f"{late} late", text, f"{_APART} s between them"))
    return found


def joint_delay(trace: Mapping[str, NDArray[np.float64]]) -> int:
    """Ticks by which measured joint angles follow the expected ones best."""
    best = np.inf
    found = 0
    for late in range(round(MOST_LATE / period_of(trace)) + 1):
        expected = trace["expected"][: len(trace["joints"]) - late]
        measured = trace["joints"][late:]
        rest = float(np.square(measured - measured.mean(axis=0) - (expected - expected.mean(axis=0))).mean())
        if rest < best:
            best = rest
            found = late
    return found


def period_of(trace: Mapping[str, NDArray[np.float64]]) -> float:
    """Time in s between two rows."""
    return float(np.median(np.diff(trace["time"])))
