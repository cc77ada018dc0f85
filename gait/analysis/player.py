"""Frames of a recording, packed for the report's player: small enough to stand in the page."""

from __future__ import annotations

import base64
import zlib
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gait.analysis.parameters import FootGait
from plantar.layout import Side
from plantar.pressure_recording import PressureRecording

__all__ = ["player_data"]

LONGEST = 60.0
"""Time in s that the player shows; of a longer recording the first part that is loaded."""

USUAL_RATE = 25.0
"""Frames a second that the player shows of a long recording."""

MOST_FRAMES = 1500
MOST_BYTES = 900_000
"""Largest size of the packed pressures; a mat of very many cells is shown with fewer frames."""


def player_data(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> dict[str, Any] | None:
    """What the player needs, as plain JSON values.

    Args:
        recording: The recording.
        feet: The gait of its feet.

    Returns:
        "times" (s) of the frames; for each foot its side, cells (rings of corners in mm, to the right and forward),
        outline, pressure as bytes (0 for a cell that is not loaded, else 1 + 254 p / highest), deflated and in base64,
        highest pressure, force and CoP; "events". None where no foot has geometry.
    """
    shown = {side: gait for side, gait in feet.items() if gait.foot.layout is not None}
    if not shown:
        return None
    chosen = _frames(recording, shown)
    packed: list[dict[str, Any]] = []
    while True:
        packed = [_foot(recording, gait, chosen) for gait in shown.values()]
        if sum(len(f["pressure"]) for f in packed) <= MOST_BYTES * 4 // 3 or len(chosen) <= 50:
            break
        chosen = chosen[::2]
    time = recording.time[chosen]
    events = sorted(
        (round(float(t), 3), f"{side} {name}")
        for side, gait in shown.items()
        for c in gait.contacts
        for t, name in ((c.heel_strike, "heel strike"), (c.toe_off, "toe off"))
        if t is not None and time[0] <= t <= time[-1]
    )
    return {
        "times": np.round(time, 4).tolist(),
        "feet": packed,
        "events": events[:2000],
        "whole": bool(time[-1] >= recording.time[-1] - 1.0),
        "unit": "counts" if recording.raw else "kPa",
        "forceUnit": "counts" if recording.raw else "N",
    }


def _frames(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> NDArray[np.int64]:
    """Indices of the frames that are shown."""
    time = recording.time
    begin = 0
    if time[-1] - time[0] > LONGEST:
        first = [c.begin for gait in feet.values() for c in gait.contacts if c.complete]
        if first:
            begin = max(0, int(np.searchsorted(time, time[min(first)] - 1.0)))
    end = int(np.searchsorted(time, time[begin] + LONGEST, side="right"))
    every = 1
    if end - begin > MOST_FRAMES:
        every = max(1, round(recording.rate_hz / USUAL_RATE), -(-(end - begin) // MOST_FRAMES))
    return np.arange(begin, end, every)


def _foot(recording: PressureRecording, gait: FootGait, chosen: NDArray[np.int64]) -> dict[str, Any]:
    layout = gait.foot.layout
    assert layout is not None
    force = gait.foot.force[chosen]
    missing = np.isnan(force)
    force = np.where(missing, 0.0, force)
    loaded = force > gait.cell_threshold
    cells = np.arange(len(layout))
    if recording.kind == "platform":  # a platform shows what is stepped on
        near = np.asarray(loaded.any(axis=0))
        cells = np.flatnonzero(near | np.array([any(near[j] for j in row) for row in layout.neighbours]))
        cells = cells if len(cells) else np.arange(len(layout))
    value = force[:, cells] if recording.raw else force[:, cells] / layout.areas[cells] / 1e3
    highest = float(value.max(initial=0.0)) or 1.0
    levels = np.where(loaded[:, cells], 1.0 + np.clip(np.rint(254.0 * value / highest), 0.0, 254.0), 0.0)
    vertical = gait.foot.vertical_force[chosen]
    cop = gait.cop[chosen] if gait.cop is not None else np.full((len(chosen), 2), np.nan)
    outline = layout.outline
    if recording.kind == "platform":
        points = np.vstack([layout.cell_polygon(int(c)) for c in cells])
        (x0, y0), (x1, y1) = points.min(axis=0) - 0.01, points.max(axis=0) + 0.01
        outline = np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
    return {
        "side": gait.foot.side,
        "cells": [_seen(layout.cell_polygon(int(c))) for c in cells],
        "outline": _seen(outline),
        "pressure": base64.b64encode(zlib.compress(levels.astype(np.uint8).tobytes(), 9)).decode(),
        "highest": float(f"{highest:.4g}"),
        "force": [None if not np.isfinite(f) else round(float(f), 1) for f in vertical],
        "cop": [None if not np.isfinite(x) else [round(-1e3 * float(y), 1), round(1e3 * float(x), 1)] for x, y in cop],
    }


def _seen(ring: NDArray[np.float64]) -> list[list[float]]:
    """A ring as it is seen from above, toes up: to the right and forward, in mm."""
    return np.round(1e3 * ring[:, ::-1] * (-1.0, 1.0), 1).tolist()  # type: ignore[no-any-return]
