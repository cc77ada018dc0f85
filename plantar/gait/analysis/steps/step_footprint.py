"""Footprint of a step: the foot's own, on a platform the step's."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.common.sides import Side
from plantar.gait.analysis.masks import Masks
from plantar.gait.analysis.prints.footprint import Footprint, footprint_of_cells
from plantar.gait.analysis.prints.platform import PlatformPrint
from plantar.gait.analysis.prints.regions import regions_of, ten_regions_of, with_toe_line
from plantar.gait.analysis.steps.events import Contact
from plantar.gait.analysis.steps.foot_gait import FootGait
from plantar.gait.analysis.steps.step_load import StepLoads
from plantar.layouts.cell_grid import CellGrid
from plantar.layouts.layout import SoleLayout
from plantar.recordings.pressure_recording import PressureRecording


def with_picture(recording: PressureRecording, gait: FootGait, loads: StepLoads) -> FootGait:
    """Returns foot's gait in a recording with maximum pressure picture by its loads, footprint and regions."""
    layout = gait.foot.layout
    if layout is None:
        return gait
    top = _highest_of_steps(recording, gait, loads)
    picture = top if recording.raw else top / layout.areas
    gait = replace(gait, picture=np.asarray(picture))
    loaded = top > gait.cell_threshold
    if recording.kind == "platform" or not gait.contacts:
        return gait
    print_ = footprint_of_cells(layout, picture, loaded, gait.foot.side)
    if print_ is None:
        return gait
    insole = recording.kind == "insole"
    of_sole = float(layout.outline[:, 0].max() - print_.origin[0]) if insole else None
    whole = footprint_of_cells(layout, np.ones(len(layout)), np.ones(len(layout), dtype=bool), gait.foot.side)
    print_, region = with_regions(gait.masks, layout, print_, whole, loaded, of_sole)
    return replace(gait, footprint=print_, region=region, sole=whole)


def _highest_of_steps(recording: PressureRecording, gait: FootGait, loads: StepLoads) -> NDArray[np.float64]:
    highest = loads.highest([c for c in gait.contacts if c.complete])
    highest = highest if len(highest) else gait.foot.measured.max(axis=0, initial=0.0)[None]
    return np.asarray(np.max(highest, axis=0) if recording.kind == "platform" else np.mean(highest, axis=0))


def with_regions(
    masks: Masks,
    layout: SoleLayout | CellGrid,
    print_: Footprint,
    sole: Footprint | None,
    loaded: NDArray[np.bool_],
    of_sole: float | None = None,
) -> tuple[Footprint, NDArray[np.int64]]:
    """Returns footprint with its toe line, and region (k,) of each of a layout's cells by masks, -1 for none.

    `sole`: footprint of the whole sole, of which polygons are shares; `loaded`: cells (k,) of the print; `of_sole`: as
    of `regions_of`.
    """
    print_ = with_toe_line(print_)
    region = np.full(len(loaded), -1)
    if masks.kind == "polygons":
        for index, inside in reversed(list(enumerate(cells_in_polygons(masks, layout, sole or print_)))):
            region[inside] = index
    else:
        region[loaded] = ten_regions_of(print_, of_sole) if masks.kind == "ten" else regions_of(print_, of_sole)
    return print_, region


def places_in_foot(layout: SoleLayout | CellGrid, print_: Footprint) -> NDArray[np.float64]:
    """Returns cells' places (k, 2) in foot coordinates: shares of a footprint's, or sole's, length and width."""
    low = print_.rings.reshape(-1, 2).min(axis=0)
    high = print_.rings.reshape(-1, 2).max(axis=0)
    return np.asarray((print_.in_foot(layout.positions[:, :2]) - low) / (high - low))


def cells_in_polygons(masks: Masks, layout: SoleLayout | CellGrid, print_: Footprint) -> list[NDArray[np.bool_]]:
    """Returns which cells (k,) of a layout are in each polygon of masks, by the length and width of a print."""
    places = places_in_foot(layout, print_)
    return [np.asarray(shapely.contains_xy(shapely.Polygon(ring), places)) for ring in masks.polygons]


def footprint_of_step(
    recording: PressureRecording, gait: FootGait, loads: StepLoads, contact: Contact, prints: Sequence[PlatformPrint]
) -> tuple[Footprint | None, NDArray[np.int64] | None]:
    """Returns footprint and region (k,) of each cell (-1 for none) of a contact's step; None without geometry.

    Of a foot's gait in a recording, on platforms of the step's own loads and prints.
    """
    layout = gait.foot.layout
    if recording.kind != "platform" or layout is None:
        return gait.footprint, gait.region
    (highest,) = loads.highest([contact])
    of_step = print_of_contact(contact, gait.foot.side, prints)
    loaded = highest > gait.cell_threshold
    forward = of_step.forward if of_step is not None else np.array([1.0, 0.0])
    pressure = highest if recording.raw else highest / layout.areas
    print_ = footprint_of_cells(layout, pressure, loaded, gait.foot.side, forward)
    return (None, None) if print_ is None else with_regions(gait.masks, layout, print_, None, loaded)


def print_of_contact(contact: Contact, side: Side, prints: Sequence[PlatformPrint]) -> PlatformPrint | None:
    """Returns platform footprint of prints that shares most frames with a side's contact, or None."""
    own = [p for p in prints if p.side == side and p.begin < contact.end and p.end > contact.begin]
    return max(own, key=lambda p: min(p.end, contact.end) - max(p.begin, contact.begin), default=None)
