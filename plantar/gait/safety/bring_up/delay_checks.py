"""Delays of encoders and IMU, by how late they follow what is commanded."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.gait.safety.bring_up.finding import Finding

# s by which angles follow commands: measured: 0.15 of OP3 with a quarter of its stiffness, the least of level 3, which
# 20 % less refuses; 20 % more refuses no other late encoders, which the gyro shows
_LATE = 0.18
_APART = 0.02  # s between encoders and gyro; measured: 183 drawn plants of ten robots have 0.005 at most

MOST_LATE = 0.3
"""Delay in s up to which is tried."""


def check_delays(joints: int, gyro: int | None, period: float) -> list[Finding]:
    """Findings by how late `joints` follow what is commanded, and a `gyro` them, in ticks of a `period` in s.

    None where the gyro is silent.
    """
    found: list[Finding] = []
    if joints * period > _LATE:
        text = f"angles follow what is commanded by {joints * period:.3f} s"
        found.append(Finding("encoders or drives late", text, f"{_LATE} s"))
    apart = 0.0 if gyro is None else -gyro * period
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
