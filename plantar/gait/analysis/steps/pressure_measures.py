"""Pressure of contacts: peaks, integrals, areas, regions, and a robot's wrench."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.batch import support_polygons
from plantar.gait.analysis.steps.step_load import StepLoad, usual_step
from plantar.geometry.polygon import signed_margin
from plantar.kernels.geometry import row_hulls
from plantar.layouts.cell_grid import CellGrid
from plantar.layouts.layout import SoleLayout

_MOST_FRAMES = 200  # Frames of a contact in which support polygons are looked at; of more, every n-th


def pressure_measures(load: StepLoad, layout: SoleLayout | CellGrid | None) -> list[dict[str, float]]:
    """Returns measures of each contact of a load by key; areas need a layout."""
    assert load.pressure is not None
    highest = load.pressure.max(axis=1)
    out = {
        "peak_pressure_Pa": load.most(highest),
        "pressure_time_integral_Pas": load.integral(highest),
        "pressure_time_integral_cell_Pas": load.integral(load.pressure).max(axis=1),
    }
    if load.areas is not None and layout is not None:
        area = np.einsum("mk,k->m", load.loaded, load.areas)  # BLAS would start threads for it
        force = load.force * load.loaded
        pressure = np.divide(force.sum(axis=1), area, out=np.zeros(len(area)), where=area > 0.0)
        frames = np.add.reduceat((area > 0.0).astype(float), load.starts)
        every = -(-load.lengths // _MOST_FRAMES)
        chosen = (np.arange(len(area)) - np.repeat(load.starts, load.lengths)) % np.repeat(every, load.lengths) == 0
        held = force if chosen.all() else force[chosen]
        polygons = (
            hull_areas(layout, held) if isinstance(layout, CellGrid) else support_polygons(layout, held, 0.0).area
        )
        counts = -(-load.lengths // every)
        starts = np.cumsum(counts) - counts
        out |= {
            "mean_pressure_Pa": np.add.reduceat(pressure, load.starts) / np.maximum(frames, 1.0),
            "mean_pressure_max_Pa": load.most(pressure),
            "contact_area_m2": load.most(area),
            "footprint_area_m2": np.logical_or.reduceat(load.loaded, load.starts, axis=0) @ load.areas,
            "support_polygon_area_m2": np.maximum.reduceat(polygons, starts),
            "support_polygon_mean_m2": np.add.reduceat(polygons, starts) / counts,
        }
    return [dict(zip(out, row, strict=True)) for row in zip(*(v.tolist() for v in out.values()), strict=True)]


def hull_areas(grid: CellGrid, force: NDArray[np.float64]) -> NDArray[np.float64]:
    """Areas (m,) in m^2 of the convex hulls of a grid's cells with a force (m, k) above 0.

    Example:
        >>> corners = CellGrid(np.array([0, 0, 9]), np.array([0, 9, 0]))
        >>> (hull_areas(corners, np.array([[1.0, 0.0, 0.0], [1.0, 1.0, 1.0]])) / 0.005**2).round(6).tolist()
        [1.0, 59.5]
    """
    row = grid.row - grid.row.min()
    column = grid.column - grid.column.min()
    cells = np.empty(len(force))
    row_hulls.hull_areas(force, row.astype(np.intp), column.astype(np.intp), cells)
    return cells * (grid.pitch[0] * grid.pitch[1])


def region_measures(
    load: StepLoad, region: NDArray[np.int64], names: Sequence[str], durations: Sequence[float]
) -> list[dict[str, dict[str, float]]]:
    """Returns `REGION_MEASURES` of regions with cells in each contact.

    `region`: index (k,) into `names` of each cell, -1 for none; `durations`: whole foot's contact times (c,) in s.
    """
    assert load.pressure is not None
    order = np.argsort(region, kind="stable")
    order = order[region[order] >= 0]  # cells of a region lie side by side: one pass serves all regions
    if len(order) == 0:
        return [{} for _ in durations]
    present, starts = np.unique(region[order], return_index=True)
    # Taken row by row: columns that are picked by an index lie frame by frame, and are slow to go through.
    force = np.add.reduceat(load.force.take(order, axis=1), starts, axis=1)
    pressure = np.maximum.reduceat(load.pressure.take(order, axis=1), starts, axis=1)
    loaded = load.loaded.take(order, axis=1)
    on = np.logical_or.reduceat(loaded, starts, axis=1).astype(float)
    whole = load.integral(load.force.sum(axis=1))
    time = np.array(durations)
    with np.errstate(invalid="ignore", divide="ignore"):
        impulse = load.integral(force)
        usual = usual_step(load.time) if load.frame is None else load.frame
        contact = np.minimum(np.add.reduceat(on, load.starts, axis=0) * usual, time[:, None])
        out = {
            "peak_force_N": load.most(force),
            "peak_pressure_Pa": load.most(pressure),
            "impulse_Ns": impulse,
            "impulse_percent": 100.0 * impulse / np.where(whole > 0.0, whole, np.nan)[:, None],
            "pressure_time_integral_Pas": load.integral(pressure),
            "contact_time_s": contact,
            "contact_percent": 100.0 * contact / np.where(time > 0.0, time, np.nan)[:, None],
        }
    if load.areas is not None:
        out["contact_area_m2"] = load.most(np.add.reduceat(loaded * load.areas[order], starts, axis=1))
    own = [names[index] for index in present.tolist()]
    table = np.stack(list(out.values()), axis=2).tolist()  # (contacts, regions, measures)
    return [{name: dict(zip(out, row, strict=True)) for name, row in zip(own, rows, strict=True)} for rows in table]


_WRENCH = {0: "fx_peak_N", 1: "fy_peak_N", 3: "tx_peak_Nm", 4: "ty_peak_Nm", 5: "tz_peak_Nm"}  # by component


def robot_measures(load: StepLoad, layout: SoleLayout) -> dict[str, float]:
    """Returns largest wrench components about the sole origin, and CoP margins to the support polygon.

    Of the loaded cells of a robot's layout in a contact's load, frame by frame; without components that its cells
    cannot measure, such as the shear on a flat sole.
    """
    largest = np.abs(load.force @ layout.wrench_map.T).max(axis=0)
    reach = np.abs(layout.wrench_map).max(axis=1)
    out = {name: float(largest[i]) for i, name in _WRENCH.items() if reach[i] > 1e-9}
    every = -(-len(load.time) // _MOST_FRAMES)
    force = np.where(load.loaded, load.force, 0.0)[::every]
    normal = force * layout.rotations[:, 2, 2]
    total = normal.sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        cop = normal @ layout.positions[:, :2] / total[:, None]
    polygons = support_polygons(layout, force, 0.0, vertices=True)
    inside = np.flatnonzero((total > 0.0) & (polygons.size >= 3)).tolist()
    margins = [signed_margin(polygons.polygon(i), cop[i]) for i in inside]
    if margins:
        out |= {"cop_margin_polygon_m": min(margins), "cop_margin_polygon_mean_m": float(np.mean(margins))}
    return out
