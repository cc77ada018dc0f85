"""Pressure of one contact: peaks, pressure-time integrals in both definitions, areas, regions, and a robot's wrench."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.batch import support_polygons
from plantar.gait.analysis.steps.step_load import StepLoad
from plantar.geometry.polygon import signed_margin
from plantar.layouts.layout import SoleLayout

__all__ = ["pressure_measures", "region_measures", "robot_measures"]

_MOST_FRAMES = 200
"""Frames of a contact in which support polygons are looked at; of more, every n-th."""


def _integral(values: NDArray[np.float64], time: NDArray[np.float64]) -> NDArray[np.float64]:
    """Integral over time (trapezoids) of each column; of (m,) or (m, k) values."""
    if len(time) < 2:
        return np.zeros(values.shape[1:])
    step = np.diff(time)
    weight = 0.5 * (np.concatenate([step, [0.0]]) + np.concatenate([[0.0], step]))
    return np.asarray(weight @ values)


def pressure_measures(load: StepLoad, layout: SoleLayout | None) -> dict[str, float]:
    """Measures of a contact's pressures.

    Args:
        load: The contact, with pressures.
        layout: Where the cells are; None where only the values are known.
    """
    assert load.pressure is not None
    highest = load.pressure.max(axis=1)
    out = {
        "peak_pressure_Pa": float(highest.max()),
        "pressure_time_integral_Pas": float(_integral(highest, load.time)),
        "pressure_time_integral_cell_Pas": float(_integral(load.pressure, load.time).max()),
    }
    if load.areas is None or layout is None:
        return out
    area = load.loaded @ load.areas
    force = np.where(load.loaded, load.force, 0.0)
    pressure = np.divide(force.sum(axis=1), area, out=np.zeros(len(area)), where=area > 0.0)
    every = -(-len(area) // _MOST_FRAMES)
    polygons = support_polygons(layout, force[::every], 0.0).area
    footprint = float(load.areas[load.loaded.any(axis=0)].sum())
    on = area > 0.0
    return out | {
        "mean_pressure_Pa": float(pressure[on].mean()) if on.any() else 0.0,
        "mean_pressure_max_Pa": float(pressure.max()),
        "contact_area_m2": float(area.max()),
        "footprint_area_m2": footprint,
        "support_polygon_area_m2": float(polygons.max()),
        "support_polygon_mean_m2": float(polygons.mean()),
    }


def region_measures(
    load: StepLoad, region: NDArray[np.int64], names: Sequence[str], duration: float
) -> dict[str, dict[str, float]]:
    """Measures of each region of the foot in one contact.

    Args:
        load: The contact, with pressures.
        region: Index (k,) into `names` of each cell, -1 for none.
        duration: Contact time of the whole foot in s.

    Returns:
        The measures of each region that has cells; those of `plantar.gait.analysis.measures.REGION_MEASURES`.
    """
    assert load.pressure is not None
    order = np.argsort(region, kind="stable")
    order = order[region[order] >= 0]  # cells of a region lie side by side: one pass serves all regions
    if len(order) == 0:
        return {}
    present, starts = np.unique(region[order], return_index=True)
    force = np.add.reduceat(load.force[:, order], starts, axis=1)
    pressure = np.maximum.reduceat(load.pressure[:, order], starts, axis=1)
    loaded = load.loaded[:, order]
    on = np.logical_or.reduceat(loaded, starts, axis=1).sum(axis=0)
    impulses, integrals = _integral(force, load.time), _integral(pressure, load.time)
    whole = float(_integral(load.force.sum(axis=1), load.time))
    step = float(np.median(np.diff(load.time))) if len(load.time) > 1 else 0.0
    contact = np.minimum(on * step, duration)
    areas = None if load.areas is None else np.add.reduceat(loaded * load.areas[order], starts, axis=1).max(axis=0)
    peak_force, peak_pressure = force.max(axis=0), pressure.max(axis=0)
    out: dict[str, dict[str, float]] = {}
    for i, index in enumerate(present.tolist()):
        out[names[index]] = {
            "peak_force_N": float(peak_force[i]),
            "peak_pressure_Pa": float(peak_pressure[i]),
            "impulse_Ns": float(impulses[i]),
            "impulse_percent": 100.0 * float(impulses[i]) / whole if whole > 0.0 else np.nan,
            "pressure_time_integral_Pas": float(integrals[i]),
            "contact_time_s": float(contact[i]),
            "contact_percent": 100.0 * float(contact[i]) / duration if duration > 0.0 else np.nan,
        }
        if areas is not None:
            out[names[index]]["contact_area_m2"] = float(areas[i])
    return out


def robot_measures(load: StepLoad, layout: SoleLayout) -> dict[str, float]:
    """Wrench of a sole of taxels, and margin of its centre of pressure to the support polygon.

    Both are of the loaded cells at one instant: forces that push keep their CoP inside the hull of their cells.

    Returns:
        Largest magnitudes of the wrench's components about the sole frame's origin, and the smallest and mean margin.
    """
    wrench = np.abs(load.force @ layout.wrench_map.T)
    fx, fy, _, tx, ty, tz = wrench.max(axis=0)
    out = {"fx_peak_N": fx, "fy_peak_N": fy, "tx_peak_Nm": tx, "ty_peak_Nm": ty, "tz_peak_Nm": tz}
    every = -(-len(load.time) // _MOST_FRAMES)
    force = np.where(load.loaded, load.force, 0.0)[::every]
    normal = force * layout.rotations[:, 2, 2]
    total = normal.sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        cop = normal @ layout.positions[:, :2] / total[:, None]
    polygons = support_polygons(layout, force, 0.0, vertices=True)
    margins: list[float] = []
    for i, point in enumerate(cop):
        if total[i] > 0.0 and polygons.size[i] >= 3:
            margins.append(signed_margin(polygons.polygon(i), point))
    if margins:
        out |= {"cop_margin_polygon_m": min(margins), "cop_margin_polygon_mean_m": float(np.mean(margins))}
    return out
