"""Virtual wrench away from heat, and the warm footprint."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arguments import number
from plantar.common.arrays import numbers
from plantar.layouts.layout import SoleLayout
from plantar.layouts.taxel_values import taxel_frames, taxel_values
from plantar.sensing.proximity import cells_polygon


def temperature_measure(temperature: ArrayLike, threshold: float, highest: float = math.inf) -> NDArray[np.float64]:
    """Excess kappa (..., n) in K over a threshold (T 3.34): 0 below and if dead, never NaN.

    `temperature`: temperatures (..., n) in degC; NaN or inf if dead; `threshold`: temperature kappa_0 in degC from
    which taxel reacts; `highest`: upper end of sensors' range in degC, where readings are cut.

    Returns excess; InputError: not numeric.
    """
    readings = numbers(temperature, "temperatures")
    level = number(threshold, "threshold of temperature", finite=True)
    most = max(number(highest, "upper end of the range") - level, 0.0)
    excess = np.asarray(np.fmax(readings, level))  # drops NaN
    excess -= level
    return np.asarray(np.where(excess < math.inf, np.minimum(excess, most), 0.0))


def temperature_wrench(
    layout: SoleLayout, temperature: ArrayLike, threshold: float | None = None, gain: float = 1.0
) -> NDArray[np.float64]:
    """Virtual wrench that pushes the sole off heat (T 3.35-3.37).

    w = sum_i [R_i f_i, r_i x R_i f_i] with f_i = [0, 0, gain * kappa_i].

    `temperature`: temperatures (n,) or (frames, n) in degC; NaN if dead; `threshold`: temperature kappa_0 in degC from
    which taxel reacts; layout's if None; `gain`: force of a kelvin of excess in N/K.

    Returns wrench (6,) or (frames, 6) about sole origin in N and N m; ReadingError: temperatures do not fit.
    """
    readings = taxel_frames(layout, temperature, "temperatures")
    level = layout.temperature_threshold if threshold is None else threshold
    newtons = number(gain, "gain of temperature", finite=True)
    highest = layout.ranges["temperature"][1] if "temperature" in layout.ranges else math.inf
    with np.errstate(over="ignore", invalid="ignore"):  # of readings as large as no sensor's, where no range is stated
        return np.asarray(newtons * temperature_measure(readings, level, highest).dot(layout.wrench_map.T))


def warm_taxels(temperature: ArrayLike, threshold: float) -> NDArray[np.bool_]:
    """Taxels at or above a temperature (T 3.34); dead ones are not.

    `temperature`: temperatures (..., n) in degC; NaN or inf if dead; `threshold`: temperature kappa_0 in degC.

    Returns mask (..., n); InputError: not numeric.
    """
    readings = numbers(temperature, "temperatures")
    return np.asarray(np.isfinite(readings) & (readings >= number(threshold, "threshold of temperature")))


def temperature_footprint(
    layout: SoleLayout, temperature: ArrayLike, threshold: float | None = None
) -> NDArray[np.float64]:
    """Convex polygon of the warm cells (T 4.2.5).

    `temperature`: temperatures (n,) in degC; NaN if dead; `threshold`: temperature in degC of warm cell; layout's if
    None.

    Returns polygon (k, 2) in sole frame in m, counter-clockwise; empty if none is warm; ReadingError:
    temperatures do not fit.
    """
    readings = taxel_values(layout, temperature, "temperatures")
    level = layout.temperature_threshold if threshold is None else threshold
    return cells_polygon(layout, warm_taxels(readings, level))
