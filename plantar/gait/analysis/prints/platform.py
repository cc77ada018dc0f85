"""Platforms and walkways: footprints, their feet, and the walking direction."""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import cast

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.errors import FormatError
from plantar.gait.analysis.prints.footprint import Footprint
from plantar.gait.analysis.prints.platform_walk import (
    LONGEST,
    PlatformLoad,
    PrintCells,
    cells_of_prints,
    direction_of_walk,
    extent_of,
    footprint_on,
    passes_over,
    rightness,
    sides_of_walk,
)
from plantar.layouts.layout import SoleLayout
from plantar.recordings.pressure_recording import FootRecording, PressureRecording

# Cells by which a footprint at the edge is shorter than the others, and the share of their width, where it is cut off.
_SHORTER = 1.5
_NARROWER = 0.8
# Median place of arch and hallux, in lengths of the footprint, from which they are the other foot's: made and real feet
# have 0.12 and 0.13 on their own side, flat ones about 0.
_OTHER = -0.05
_TRIGGER = 0.25  # Share of the peak up to which load in the first and last frame is the beginning and end of a contact


@dataclass(frozen=True, eq=False)
class PlatformPrint:
    """Footprint on a platform.

    `begin`: first loaded frame; `end`: frame after the last; `cells`: platform indices (n,); `forward`: walking
    direction (2,) in the platform's frame; `cut`: whether cut off by the platform's edge.
    """

    side: Side
    begin: int
    end: int
    cells: NDArray[np.int64]
    forward: NDArray[np.float64]
    cut: bool = False


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
    shapes: list[Footprint] = []
    for walk in passes_over(load, cells):
        longest = max(extent_of(load.layout, p.cells)[1] for p in walk.prints)
        three = any(
            load.time[c.begin] < load.time[a.end - 1] for a, c in zip(walk.prints, walk.prints[2:], strict=False)
        )
        if longest > LONGEST or three:
            what = f"a footprint of {longest:.2g} m" if longest > LONGEST else "three footprints at once"
            when = f"{load.time[walk.prints[0].begin]:.1f} s"
            notes.append(f"{what}: two people, or feet that touch? The pass over the platform at {when} is left out")
            continue
        forward = direction_of_walk(walk, notes)
        sides = zip(walk.prints, sides_of_walk(walk, forward, stated, notes), strict=True)
        out += [PlatformPrint(side, own.begin, own.end, own.cells, forward) for own, side in sides]
        shapes += [footprint_on(load, own, forward) for own in walk.prints]
    if not out:
        raise FormatError(f"{notes[0]}; allowed: one person, whose footprints lie apart")
    inward = [rightness(s) * (1.0 if p.side == "right" else -1.0) for p, s in zip(out, shapes, strict=True)]
    if float(np.median(inward)) < _OTHER and float(np.percentile(inward, 90.0)) < 0.0:
        notes.append(
            "arches and great toes of the footprints lie as in the other foot: feet that cross over (left and right, "
            "taken from their places, are then exchanged), or the wrong --side"
        )
    return _with_cuts(load, out, shapes, notes), list(dict.fromkeys(notes))


def _with_cuts(
    load: PlatformLoad, prints: list[PlatformPrint], shapes: Sequence[Footprint], notes: list[str]
) -> list[PlatformPrint]:
    """Prints of shapes, marked where the edge cuts them off: shorter or narrower than those that lie inside."""
    beside = np.array([len(near) for near in cast(SoleLayout, load.layout).neighbours])
    at_edge = np.array([(beside[p.cells] < np.median(beside)).any() for p in prints])
    sizes = np.array([(shape.length, shape.width) for shape in shapes])
    if at_edge.all():
        notes.append(
            "no footprint lies inside the platform: its edge may cut them off, so that all of them is too small"
        )
        return prints
    length, width = sizes[~at_edge].max(axis=0)
    short = sizes[:, 0] < length - _SHORTER * np.sqrt(load.layout.areas.max())
    cut = at_edge & (short | (sizes[:, 1] < _NARROWER * width))
    for p, size in zip(itertools.compress(prints, cut), sizes[cut], strict=True):
        notes.append(
            f"the platform's edge cuts off the {p.side} footprint at {load.time[p.begin]:.1f} s ({size[0]:.2g} x "
            f"{size[1]:.2g} m, others {length:.2g} x {width:.2g} m): it is no step, and no length is measured to it"
        )
    return [replace(p, cut=bool(c)) for p, c in zip(prints, cut, strict=True)]


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
