"""Platforms and walkways: which cells and frames are one footprint, of which foot, and in which direction it walks.

A platform sees whoever steps on it. Cells that are loaded and touch, or lie a few centimetres apart and are loaded at
the same time, are one footprint. Of several footprints in a pass, those to the left of the line of walking are the left
foot's; of a single one, the arch, which is open to the medial side, and the hallux tell the side.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import cast

import numpy as np
from numpy.typing import NDArray

from gait.analysis.footprint import footprint_of_cells
from plantar.layout import Side, SoleLayout
from plantar.pressure_recording import FootRecording, PressureRecording

__all__ = ["PlatformPrint", "told_apart"]

_LONGEST, _WIDEST = 0.36, 0.17
"""Largest length and width in m of one footprint."""

_PAUSE = 1.0
"""Time in s without load that ends a pass over the platform."""

_BREAK = 0.25
"""Time in s without load after which a part of the platform is stepped on anew."""

_TRIGGER = 0.25
"""Share of the peak up to which load in the first and last frame is the beginning and end of a contact."""

_ALIKE = 0.02
"""Distance in m to the line of walking from which it tells left from right."""


@dataclass(frozen=True, eq=False)
class PlatformPrint:
    """One footprint on a platform.

    Attributes:
        side: The foot.
        begin: First frame in which it is loaded.
        end: Frame after the last one.
        cells: Cells (n,) of it, as indices of the platform's.
        forward: Direction (2,) of walking in the platform's frame.
    """

    side: Side
    begin: int
    end: int
    cells: NDArray[np.int64]
    forward: NDArray[np.float64]


@dataclass
class _Piece:
    cells: list[int]
    begin: int
    end: int
    load: float


def told_apart(recording: PressureRecording) -> tuple[PressureRecording, tuple[PlatformPrint, ...]]:
    """A platform's recording with its footprints told apart.

    The frame is turned so that the first pass walks along x. Frames without load are put before a first and after a
    last frame that carry little: a platform records from the moment at which it is stepped on.

    Args:
        recording: A recording; one that is not of a platform is given back as it is.

    Returns:
        The recording, with the footprints of each foot under its side, and the footprints.
    """
    if recording.kind != "platform":
        return recording, ()
    whole = next(iter(recording.feet.values()))
    if whole.layout is None:
        return recording, ()
    time, force, padded = _with_quiet_ends(recording.time, whole.force, 1.0 / recording.rate_hz)
    layout = whole.layout
    warnings = list(recording.warnings)
    if padded:
        warnings.append("the platform records while it is loaded: it counts as unloaded just before and after")
    measured = np.where(np.isnan(force), 0.0, force)
    threshold = 0.0 if recording.raw else layout.force_threshold
    groups = _groups(layout, measured, threshold, time)
    if not groups:
        return replace(recording, time=time, feet={whole.side: replace(whole, force=force)}), ()
    prints, notes = _prints(layout, measured, time, groups, cast(Side | None, recording.metadata.get("side")))
    warnings += notes
    turned = _turned(layout, prints[0].forward)
    turn = _rotation(prints[0].forward)
    prints = [replace(p, forward=turn @ p.forward) for p in prints]
    feet: dict[Side, FootRecording] = {}
    sides: tuple[Side, Side] = ("left", "right")
    for side in sides:
        own = [p for p in prints if p.side == side]
        if own:
            part = np.zeros_like(force)
            for p in own:
                part[p.begin : p.end, p.cells] = force[p.begin : p.end, p.cells]
            feet[side] = FootRecording(side, part, replace(turned, side=side))
    told = replace(
        recording,
        time=time,
        feet=feet,
        warnings=tuple(dict.fromkeys(warnings)),
        metadata={**recording.metadata, "frames": len(recording.time)},
    )
    return told, tuple(prints)


def _with_quiet_ends(
    time: NDArray[np.float64], force: NDArray[np.float64], period: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], bool]:
    """Frames without load put in at the ends and at gaps in time where the neighbouring frame carries little."""
    total = np.nansum(force, axis=1)
    little = _TRIGGER * float(total.max(initial=0.0))
    gaps = np.flatnonzero(np.diff(time) > 3.5 * period)
    at: list[int] = []
    when: list[float] = []
    for i in [0, *(gaps + 1).tolist()]:
        if 0.0 < total[i] <= little:
            at.append(i)
            when.append(float(time[i]) - period)
    for i in [*gaps.tolist(), len(time) - 1]:
        if 0.0 < total[i] <= little:
            at.append(i + 1)
            when.append(float(time[i]) + period)
    if not at:
        return time, force, False
    order = np.lexsort((when, at))
    index, moments = np.array(at)[order], np.array(when)[order]
    return np.insert(time, index, moments), np.insert(force, index, 0.0, axis=0), True


def _groups(
    layout: SoleLayout, force: NDArray[np.float64], threshold: float, time: NDArray[np.float64]
) -> list[list[_Piece]]:
    """Parts of the platform that are one footprint."""
    loaded = force > threshold
    pieces: list[_Piece] = []
    for cells in _components(layout, np.asarray(loaded.any(axis=0))):
        busy = loaded[:, cells].any(axis=1)
        frames = np.flatnonzero(busy)
        cuts = np.flatnonzero(np.diff(time[frames]) > _BREAK)
        for a, b in zip([0, *(cuts + 1).tolist()], [*cuts.tolist(), len(frames) - 1], strict=True):
            begin, end = int(frames[a]), int(frames[b]) + 1
            pieces.append(_Piece(cells, begin, end, float(force[begin:end][:, cells].sum(axis=1).max())))
    top = max((p.load for p in pieces), default=0.0)
    pieces = sorted((p for p in pieces if p.load >= 0.005 * top), key=lambda p: -p.load)
    groups: list[list[_Piece]] = []
    for piece in pieces:
        near = [g for g in groups if _one_foot(layout, g, piece, time)]
        if near:
            min(near, key=lambda g: _apart(layout, g[0], piece)).append(piece)
        else:
            groups.append([piece])
    groups = [g for g in groups if sum(p.load for p in g) >= 0.05 * top]
    return sorted(groups, key=lambda g: min(p.begin for p in g))


def _components(layout: SoleLayout, active: NDArray[np.bool_]) -> list[list[int]]:
    """Active cells that touch, or have one cell between them."""
    seen = ~active
    out: list[list[int]] = []
    for start in np.flatnonzero(active).tolist():
        if seen[start]:
            continue
        seen[start] = True
        stack, cells = [start], []
        while stack:
            cell = stack.pop()
            cells.append(cell)
            for near in layout.neighbours[cell]:
                for other in (near, *layout.neighbours[near]):
                    if not seen[other]:
                        seen[other] = True
                        stack.append(other)
        out.append(sorted(cells))
    return out


def _apart(layout: SoleLayout, one: _Piece, other: _Piece) -> float:
    a, b = (layout.positions[p.cells, :2].mean(axis=0) for p in (one, other))
    return float(np.hypot(*(a - b)))


def _one_foot(layout: SoleLayout, group: Sequence[_Piece], piece: _Piece, time: NDArray[np.float64]) -> bool:
    """Whether a part belongs to a footprint: loaded at the same time, and together no larger than a foot."""
    begin, end = min(p.begin for p in group), max(p.end for p in group)
    if time[piece.begin] > time[end - 1] + 0.1 or time[piece.end - 1] < time[begin] - 0.1:
        return False
    points = layout.positions[[c for p in [*group, piece] for c in p.cells], :2]
    values, vectors = np.linalg.eigh(np.cov(points.T) if len(points) > 2 else np.eye(2))
    extent = np.ptp(points @ vectors[:, np.argsort(values)], axis=0)
    return bool(extent[1] <= _LONGEST and extent[0] <= _WIDEST)


def _prints(
    layout: SoleLayout,
    force: NDArray[np.float64],
    time: NDArray[np.float64],
    groups: list[list[_Piece]],
    stated: Side | None,
) -> tuple[list[PlatformPrint], list[str]]:
    notes: list[str] = []
    spans = [(min(p.begin for p in g), max(p.end for p in g)) for g in groups]
    cells = [np.array(sorted({c for p in g for c in p.cells})) for g in groups]
    passes: list[list[int]] = []
    for i, (begin, _) in enumerate(spans):
        if passes and time[begin] - max(time[spans[j][1] - 1] for j in passes[-1]) < _PAUSE:
            passes[-1].append(i)
        else:
            passes.append([i])
    out: dict[int, PlatformPrint] = {}
    for members in passes:
        centres = np.array([_centroid(layout, force, spans[i], cells[i]) for i in members])
        forward = _direction(layout, force, spans, cells, members, centres, notes)
        left = np.array([-forward[1], forward[0]])
        offset = centres @ left
        sides: list[Side]
        if len(members) >= 2 and np.ptp(offset) >= 2.0 * _ALIKE:
            middle = _line_of_walking(centres @ forward, offset)
            sides = ["left" if o > m else "right" for o, m in zip(offset, middle, strict=True)]
        elif stated in ("left", "right"):
            sides = [stated] * len(members)
        else:
            sides = [_side_by_shape(layout, force, spans[i], cells[i], forward) for i in members]
            first = sides[0]
            notes.append(
                f"the file does not say which foot it is: taken as the {first} one from the footprint's shape "
                "(--side overrides)"
            )
            if len(members) >= 2:
                other: Side = "right" if first == "left" else "left"
                sides = [first if k % 2 == 0 else other for k in range(len(members))]
        for i, side in zip(members, sides, strict=True):
            out[i] = PlatformPrint(side, *spans[i], cells[i], forward)
    return [out[i] for i in range(len(groups))], list(dict.fromkeys(notes))


def _centroid(
    layout: SoleLayout, force: NDArray[np.float64], span: tuple[int, int], cells: NDArray[np.int64]
) -> NDArray[np.float64]:
    weight = force[span[0] : span[1]][:, cells].max(axis=0)
    return np.asarray(np.average(layout.positions[cells, :2], axis=0, weights=weight + 1e-12))


def _path(
    layout: SoleLayout, force: NDArray[np.float64], span: tuple[int, int], cells: NDArray[np.int64]
) -> NDArray[np.float64]:
    """From where to where the centre of pressure moves in a contact (2,)."""
    part = force[span[0] : span[1]][:, cells]
    total = part.sum(axis=1)
    part, total = part[total > 0.02 * total.max()], total[total > 0.02 * total.max()]
    path = (part @ layout.positions[cells, :2]) / total[:, None]
    few = max(1, len(path) // 8)
    return np.asarray(path[-few:].mean(axis=0) - path[:few].mean(axis=0))


def _direction(
    layout: SoleLayout,
    force: NDArray[np.float64],
    spans: list[tuple[int, int]],
    cells: list[NDArray[np.int64]],
    members: list[int],
    centres: NDArray[np.float64],
    notes: list[str],
) -> NDArray[np.float64]:
    """Direction of walking of a pass: from its first footprints to its last ones, or along the platform."""
    paths = np.array([_path(layout, force, spans[i], cells[i]) for i in members])
    travel = centres[-1] - centres[0]
    if len(members) >= 3 and np.hypot(*travel) > 0.5:
        half = len(centres) // 2
        ahead = centres[-half:].mean(axis=0) - centres[:half].mean(axis=0)
        return np.asarray(ahead / np.hypot(*ahead))
    path = paths.sum(axis=0)
    if np.hypot(*path) < 0.01:  # standing: along the longer side of the footprint
        points = layout.positions[cells[members[0]], :2]
        path = np.array([1.0, 0.0]) if np.ptp(points[:, 0]) >= np.ptp(points[:, 1]) else np.array([0.0, 1.0])
        notes.append("the centre of pressure hardly moves: the direction of walking is assumed along the platform")
    along = int(np.argmax(np.abs(path)))
    forward = np.zeros(2)
    forward[along] = np.sign(path[along])
    notes.append(
        "the line of walking is taken as parallel to the platform's edge, in the direction in which the CoP moves"
    )
    return forward


def _line_of_walking(along: NDArray[np.float64], offset: NDArray[np.float64]) -> NDArray[np.float64]:
    """The line between the feet: straight, halfway between the outermost footprints on either side of its slope."""
    slope = np.polyfit(along, offset, 1)[0] if len(along) >= 4 and np.ptp(along) > 1.0 else 0.0
    level = offset - slope * along
    return np.asarray(slope * along + 0.5 * (level.min() + level.max()))


def _side_by_shape(
    layout: SoleLayout,
    force: NDArray[np.float64],
    span: tuple[int, int],
    cells: NDArray[np.int64],
    forward: NDArray[np.float64],
) -> Side:
    """The side of a single footprint: as a left foot its arch is open to the right and its hallux lies there."""
    highest = force[span[0] : span[1]].max(axis=0)
    chosen = np.zeros(len(layout), dtype=bool)
    chosen[cells] = highest[cells] > 0.0
    print_ = footprint_of_cells(layout, highest / layout.areas, chosen, "right", forward)
    if print_ is None:
        return "left"
    u, v = print_.centres.T / print_.length  # of a right foot v runs to the left, which is medial
    weight = print_.areas
    middle = (u > 0.33) & (u < 0.55)
    waist = float(np.average(v[middle], weights=weight[middle])) if middle.any() else 0.0
    rest = (u < 0.25) | ((u > 0.60) & (u < 0.80))
    trunk = float(np.average(v[rest], weights=weight[rest])) if rest.any() else 0.0
    front = u > 0.82
    toes = 0.0
    if front.any():
        carried = weight[front] * print_.pressure[front]
        ball = (u > 0.6) & (u < 0.8)
        centre = 0.5 * float(v[ball].min() + v[ball].max()) if ball.any() else trunk
        toes = float(np.average(v[front], weights=carried + 1e-12)) - centre
    return "right" if (trunk - waist) + 0.5 * toes >= 0.0 else "left"


def _rotation(forward: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotation (2, 2) that takes a direction to x."""
    return np.array([[forward[0], forward[1]], [-forward[1], forward[0]]])


def _turned(layout: SoleLayout, forward: NDArray[np.float64]) -> SoleLayout:
    """The layout with a direction turned to x."""
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
