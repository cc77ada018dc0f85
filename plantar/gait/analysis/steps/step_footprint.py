"""The footprint of a step's lengths, arch index and regions: the foot's own, on a platform the step's."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from plantar.gait.analysis.prints.footprint import Footprint, footprint_of_cells
from plantar.gait.analysis.prints.platform import PlatformPrint
from plantar.gait.analysis.prints.regions import regions_of, with_toe_line
from plantar.gait.analysis.steps.events import Contact
from plantar.gait.analysis.steps.foot_gait import FootGait
from plantar.gait.analysis.steps.step_load import StepLoads
from plantar.recordings.pressure_recording import PressureRecording
from plantar.sides import Side

__all__ = ["footprint_of_step", "print_of_contact", "with_picture"]


def with_picture(recording: PressureRecording, gait: FootGait, loads: StepLoads) -> FootGait:
    """Returns a foot's gait in a recording with its maximum pressure picture by its loads, its footprint and
    regions.
    """
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
    print_, region = _with_regions(print_, loaded, of_sole)
    whole = footprint_of_cells(layout, np.ones(len(layout)), np.ones(len(layout), dtype=bool), gait.foot.side)
    return replace(gait, footprint=print_, region=region, sole=whole)


def _highest_of_steps(recording: PressureRecording, gait: FootGait, loads: StepLoads) -> NDArray[np.float64]:
    """Largest force (k,) of each cell in N: the mean over the complete steps, of a platform the largest of all."""
    highest = loads.highest([c for c in gait.contacts if c.complete])
    highest = highest if len(highest) else gait.foot.measured.max(axis=0, initial=0.0)[None]
    return np.asarray(np.max(highest, axis=0) if recording.kind == "platform" else np.mean(highest, axis=0))


def _with_regions(
    print_: Footprint, loaded: NDArray[np.bool_], of_sole: float | None = None
) -> tuple[Footprint, NDArray[np.int64]]:
    """A footprint with its toe line, and the region of each cell (k,), -1 for those that are not loaded."""
    print_ = with_toe_line(print_)
    region = np.full(len(loaded), -1)
    region[loaded] = regions_of(print_, of_sole)
    return print_, region


def footprint_of_step(
    recording: PressureRecording,
    gait: FootGait,
    loads: StepLoads,
    contact: Contact,
    prints: Sequence[PlatformPrint],
) -> tuple[Footprint | None, NDArray[np.int64] | None]:
    """Returns footprint and region (k,) of each cell (-1 for none) of the step of a contact; None without geometry.

    They are of a foot's gait in a recording, on a platform of the step's own loads and prints.
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
    return (None, None) if print_ is None else _with_regions(print_, loaded)


def print_of_contact(contact: Contact, side: Side, prints: Sequence[PlatformPrint]) -> PlatformPrint | None:
    """Returns the footprint of a platform's prints that shares most frames with a contact of a side's foot, or None."""
    own = [p for p in prints if p.side == side and p.begin < contact.end and p.end > contact.begin]
    return max(own, key=lambda p: min(p.end, contact.end) - max(p.begin, contact.begin), default=None)
