"""Platforms and walkways: footprints, their feet, and the walking direction."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import cast

import numpy as np
from numpy.typing import NDArray

from plantar.gait.analysis.prints.platform_walk import (
    PlatformLoad,
    PrintCells,
    cells_of_prints,
    direction_of_walk,
    passes_over,
    sides_of_walk,
)
from plantar.layouts.layout import SoleLayout
from plantar.recordings.pressure_recording import FootRecording, PressureRecording
from plantar.sides import SIDES, Side

_TRIGGER = 0.25  # Share of the peak up to which load in the first and last frame is the beginning and end of a contact


@dataclass(frozen=True, eq=False)
class PlatformPrint:
    """Footprint on a platform.

    Attributes:
        side: Foot.
        begin: First loaded frame.
        end: Frame after the last.
        cells: Platform indices (n,).
        forward: Walking direction (2,) in the platform's frame.
    """

    side: Side
    begin: int
    end: int
    cells: NDArray[np.int64]
    forward: NDArray[np.float64]


def separated_feet(recording: PressureRecording) -> tuple[PressureRecording, tuple[PlatformPrint, ...]]:
    """Platform's recording by foot, and its footprints; others unchanged.

    The first pass walks along x. Ends that carry little get unloaded frames.
    """
    whole = next(iter(recording.feet.values()), None)
    if recording.kind != "platform" or whole is None or whole.layout is None:
        return recording, ()
    time, force, padded = _with_quiet_ends(recording.time, whole.force, 1.0 / recording.rate_hz)
    warnings = list(recording.warnings)
    if padded:
        warnings.append("the platform records while it is loaded: it counts as unloaded just before and after")
    load = PlatformLoad(whole.layout, np.where(np.isnan(force), 0.0, force), time)
    cells = cells_of_prints(load, 0.0 if recording.raw else whole.layout.force_threshold)
    if not cells:
        return replace(recording, time=time, feet={whole.side: replace(whole, force=force)}), ()
    prints, notes = _prints(load, cells, cast(Side | None, recording.metadata.get("side")))
    turn = _rotation(prints[0].forward)
    separated = replace(
        recording,
        time=time,
        feet=_feet(force, _turned(whole.layout, prints[0].forward), prints),
        warnings=tuple(dict.fromkeys([*warnings, *notes])),
        metadata={**recording.metadata, "frames": len(recording.time)},
    )
    return separated, tuple(replace(p, forward=turn @ p.forward) for p in prints)


def _feet(force: NDArray[np.float64], layout: SoleLayout, prints: Sequence[PlatformPrint]) -> dict[Side, FootRecording]:
    feet: dict[Side, FootRecording] = {}
    for side in SIDES:
        if own := [p for p in prints if p.side == side]:
            part = np.zeros_like(force)
            for p in own:
                part[p.begin : p.end, p.cells] = force[p.begin : p.end, p.cells]
            feet[side] = FootRecording(side, part, replace(layout, side=side))
    return feet


def _prints(
    load: PlatformLoad, cells: Sequence[PrintCells], stated: Side | None
) -> tuple[list[PlatformPrint], list[str]]:
    notes: list[str] = []
    out: list[PlatformPrint] = []
    for walk in passes_over(load, cells):
        forward = direction_of_walk(walk, notes)
        sides = zip(walk.prints, sides_of_walk(walk, forward, stated, notes), strict=True)
        out += [PlatformPrint(side, own.begin, own.end, own.cells, forward) for own, side in sides]
    return out, list(dict.fromkeys(notes))


def _with_quiet_ends(
    time: NDArray[np.float64], force: NDArray[np.float64], period: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], bool]:
    """Unloaded frames added at ends and time gaps where the neighbouring frame carries little."""
    total = np.nansum(force, axis=1)
    little = (total > 0.0) & (total <= _TRIGGER * float(total.max(initial=0.0)))
    gaps = np.flatnonzero(np.diff(time) > 3.5 * period)
    first = [i for i in [0, *(gaps + 1).tolist()] if little[i]]
    last = [i for i in [*gaps.tolist(), len(time) - 1] if little[i]]
    if not first and not last:
        return time, force, False
    at = np.array([*first, *(i + 1 for i in last)])
    when = np.concatenate([time[first] - period, time[last] + period])
    order = np.lexsort((when, at))
    return np.insert(time, at[order], when[order]), np.insert(force, at[order], 0.0, axis=0), True


def _rotation(forward: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.array([[forward[0], forward[1]], [-forward[1], forward[0]]])


def _turned(layout: SoleLayout, forward: NDArray[np.float64]) -> SoleLayout:
    if forward[0] == 1.0:
        return layout
    whole = np.eye(3)
    whole[:2, :2] = _rotation(forward)
    return replace(
        layout,
        positions=layout.positions @ whole.T,
        vertices=layout.vertices @ whole.T,
        outline=layout.outline @ whole[:2, :2].T,
    )
