"""Units, signs and axes of gyro and accelerometer, by the torso's turns and leans."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.gait.safety.bring_up.axes import described, scale_of, signed_permutation
from plantar.gait.safety.bring_up.body_motion import BodyMotion, smoothed
from plantar.gait.safety.bring_up.delay_checks import MOST_LATE, period_of
from plantar.gait.safety.bring_up.finding import Finding
from plantar.gait.safety.bring_up.motion import STOOD
from plantar.gait.safety.bring_up.response import delayed_response, response
from plantar.mechanics.lip import GRAVITY

_SPAN = 0.025  # s over which turns are differenced and readings averaged
_GAIN = (0.5, 1.6)  # of a sensor; torsos of drawn plants turn by 0.9 to 1.1 of what is commanded
_SILENT = 0.2  # share of the expected motion below which a sensor reports none
_DEGREES = (20.0, 160.0)  # gains taken for degrees: about 57.3
_BIAS = 0.1  # rad/s of a gyro at rest; drawn ones have 0.0075

Trace = Mapping[str, NDArray[np.float64]]


def check_imu(trace: Trace, motion: BodyMotion, *, commanded: bool = False) -> tuple[list[Finding], int | None]:
    """Findings of the IMU by the rows of standing, leaning and turning, and the gyro's delay in ticks.

    The delay is that after the `motion`; None where the gyro is silent. A `commanded` motion is not what encoders show:
    the body sways besides, so that the accelerometer's axes are not checked.
    """
    rest = trace["time"] < STOOD
    pull = trace["accelerometer"][rest].mean(axis=0)
    size = float(np.linalg.norm(pull))
    found: list[Finding] = []
    allowed = f"{0.8 * GRAVITY:.1f} to {1.2 * GRAVITY:.1f} m/s^2 at rest"
    if 0.8 < size < 1.2:
        found.append(Finding("accelerometer in g", f"it reads {size:.3g} at rest", allowed))
    elif not 0.8 * GRAVITY < size < 1.2 * GRAVITY:
        cause = "accelerometer silent" if size < 0.1 else "accelerometer in another unit"
        found.append(Finding(cause, f"it reads {size:.4g} at rest", allowed))
    if size < 0.1 or commanded:
        findings, _, late = _gyro(trace, motion, None)
        return found + findings, late
    accelerometer = _accelerometer_axes(trace, motion, pull / size, GRAVITY / size)
    findings, gyro, late = _gyro(trace, motion, accelerometer)
    found += findings
    if not np.array_equal(accelerometer, np.eye(3)):
        if gyro is not None and np.array_equal(accelerometer, gyro):
            found.append(Finding(described(gyro, "IMU"), f"it reads {_listed(pull)} m/s^2 at rest", "z up, x forward"))
        else:
            words = f"it reads {_listed(pull)} m/s^2 at rest"
            found.append(Finding(described(accelerometer, "accelerometer"), words, f"(0, 0, {GRAVITY}): up, x forward"))
    return found, late


def _accelerometer_axes(trace: Trace, motion: BodyMotion, up: NDArray[np.float64], gain: float) -> NDArray[np.float64]:
    """Signed permutation (3, 3) from the torso's axes to the accelerometer's.

    Gravity at rest shows z; leans and tilts show x and y.
    """
    measured = gain * smoothed(trace["accelerometer"], period_of(trace))
    return signed_permutation(np.column_stack([response(motion.force, measured), up]))


def _gyro(
    trace: Trace, motion: BodyMotion, accelerometer: NDArray[np.float64] | None
) -> tuple[list[Finding], NDArray[np.float64] | None, int | None]:
    """Findings of the gyro, the signed permutation (3, 3) of its axes, and its delay in ticks; None where silent."""
    turn = motion.turn
    period = period_of(trace)
    span = max(1, round(_SPAN / period))
    rate = (turn[span:] - turn[:-span]) / (span * period)
    mean = np.lib.stride_tricks.sliding_window_view(trace["gyro"], span, axis=0)[:-1].mean(axis=-1)
    # Sooner than the encoders, too
    sooner = round(MOST_LATE / period)
    axes_of, late = delayed_response(rate[sooner:], mean[:-sooner], 2.0 * MOST_LATE, period)
    late -= sooner
    size = float(np.linalg.norm(axes_of, axis=1).max())
    allowed = f"turns as the encoders show, in rad/s, by {_GAIN[0]} to {_GAIN[1]} times"
    if size < _SILENT:
        return [Finding("gyro silent", f"it reports {size:.2f} times the torso's turns", allowed)], None, None
    axes = signed_permutation(axes_of)
    gain = scale_of(axes_of, axes)
    found: list[Finding] = []
    for name, column in zip("xyz", np.abs(axes_of).max(axis=0), strict=True):
        if column < _SILENT * gain:
            text = f"turns about {name} appear as {column:.2f} times as large"
            found.append(Finding(f"gyro does not report turns about {name}", text, allowed))
    if _DEGREES[0] < gain < _DEGREES[1]:
        found.append(Finding("gyro in degrees", f"it reports {gain:.1f} times the torso's turns", allowed))
    elif not _GAIN[0] < gain < _GAIN[1]:
        found.append(Finding("gyro in another unit", f"it reports {gain:.2f} times the torso's turns", allowed))
    if not np.array_equal(axes, np.eye(3)) and not (accelerometer is not None and np.array_equal(axes, accelerometer)):
        words = f"turns about x, y and z appear as {_signs(axes)}"
        found.append(Finding(described(axes, "gyro"), words, "turns about x, y and z as such"))
    rest = trace["time"] < STOOD
    bias = trace["gyro"][rest].mean(axis=0) / (gain if gain > _GAIN[1] else 1.0)
    if float(np.abs(bias).max()) > _BIAS:
        found.append(Finding("gyro's zero is off", f"it reads {_listed(bias)} rad/s at rest", f"within {_BIAS} rad/s"))
    return found, axes, late


def _listed(vector: NDArray[np.float64]) -> str:
    return "(" + ", ".join(f"{value:.3g}" for value in vector) + ")"


def _signs(axes: NDArray[np.float64]) -> str:
    names = []
    for column in axes.T:
        row = int(np.abs(column).argmax())
        names.append(("-" if column[row] < 0.0 else "") + "xyz"[row])
    return ", ".join(names)
