"""Recording frames packed for the report's player."""

import base64
import zlib
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side
from plantar.gait.analysis.pages.sole_figures import stepped_on
from plantar.gait.analysis.steps.foot_gait import FootGait
from plantar.recordings.pressure_recording import PressureRecording

LONGEST = 60.0  # Time in s that the player shows; of a longer recording the first part that is loaded
USUAL_RATE = 25.0  # Frames a second that the player shows of a long recording
# Frames that are shown at most, and that a recording of many cells is not thinned below.
MOST_FRAMES = 1500
FEWEST_FRAMES = 50
MOST_EVENTS = 2000  # Events that are listed
BELOW = 99.0  # Percent of the loaded readings that are below the colours' end: one spike does not darken all others
MOST_BYTES = 900_000  # Largest size of the packed pressures; a mat of very many cells is shown with fewer frames


def player_data(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> dict[str, Any] | None:
    """Returns a recording's player data as plain JSON values; None if none of its feet has geometry.

    Cells are rings in mm, right and forward; pressures bytes (0 if not loaded, else 1 + 254 p / highest), deflated, in
    base64.
    """
    shown = {side: gait for side, gait in feet.items() if gait.foot.layout is not None}
    if not shown:
        return None
    chosen, packed = _packed(recording, shown)
    time = recording.time[chosen]
    return {
        "times": np.round(time, 4).tolist(),
        "feet": packed,
        "events": _events(shown, float(time[0]), float(time[-1]))[:MOST_EVENTS],
        "whole": bool(time[-1] >= recording.time[-1] - 1.0),
        "unit": "counts" if recording.raw else "kPa",
        "forceUnit": "counts" if recording.raw else "N",
    }


def _packed(
    recording: PressureRecording, feet: Mapping[Side, FootGait]
) -> tuple[NDArray[np.int64], list[dict[str, Any]]]:
    chosen = _frames(recording, feet)
    held = ((gait, np.nan_to_num(gait.foot.force[chosen])) for gait in feet.values())
    loaded = [_shown(recording, gait, force)[force > gait.cell_threshold] for gait, force in held]
    highest = max((float(np.percentile(values, BELOW)) for values in loaded if len(values)), default=0.0) or 1.0
    while True:
        packed = [_foot(recording, gait, chosen, highest) for gait in feet.values()]
        # Base64 takes 4 bytes for 3.
        if len(chosen) <= FEWEST_FRAMES or sum(len(f["pressure"]) for f in packed) <= MOST_BYTES * 4 // 3:
            return chosen, packed
        chosen = chosen[::2]


def _events(feet: Mapping[Side, FootGait], begin: float, end: float) -> list[tuple[float, str]]:
    strikes = [(t, f"{side} heel strike") for side, gait in feet.items() for t in gait.heel_strikes]
    lifts = [(t, f"{side} toe off") for side, gait in feet.items() for t in gait.toe_offs]
    return sorted((round(float(t), 3), name) for t, name in strikes + lifts if begin <= t <= end)


def _frames(recording: PressureRecording, feet: Mapping[Side, FootGait]) -> NDArray[np.int64]:
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


def _shown(recording: PressureRecording, gait: FootGait, force: NDArray[np.float64]) -> NDArray[np.float64]:
    assert gait.foot.layout is not None
    return force if recording.raw else force / gait.foot.layout.areas / 1e3


def _foot(recording: PressureRecording, gait: FootGait, chosen: NDArray[np.int64], highest: float) -> dict[str, Any]:
    layout = gait.foot.layout
    assert layout is not None
    force = np.nan_to_num(gait.foot.force[chosen])
    loaded = force > gait.cell_threshold
    cells = np.arange(len(layout))
    outline = layout.outline
    if recording.kind == "platform":
        cells, outline = stepped_on(layout, np.asarray(loaded.any(axis=0)))
    cop = gait.cop[chosen] if gait.cop is not None else np.full((len(chosen), 2), np.nan)
    return {
        "side": gait.foot.side,
        "cells": [_seen(layout.cell_polygon(int(c))) for c in cells],
        "outline": _seen(outline),
        "pressure": _bytes(_shown(recording, gait, force)[:, cells], loaded[:, cells], highest),
        "highest": float(f"{highest:.4g}"),
        "force": [round(float(f), 1) if np.isfinite(f) else None for f in gait.foot.vertical_force[chosen]],
        "cop": [None if np.isnan(x) else point for (x, _), point in zip(cop, _seen(cop), strict=True)],
    }


def _bytes(value: NDArray[np.float64], loaded: NDArray[np.bool_], highest: float) -> str:
    """Values (n, m) as bytes: 0 if not loaded, else 1 + 254 value / highest; deflated, in base64."""
    levels = np.where(loaded, 1.0 + np.clip(np.rint(254.0 * value / highest), 0.0, 254.0), 0.0)
    return base64.b64encode(zlib.compress(levels.astype(np.uint8).tobytes(), 9)).decode()


def _seen(ring: NDArray[np.float64]) -> list[list[float]]:
    return np.round(1e3 * ring[:, ::-1] * (-1.0, 1.0), 1).tolist()  # type: ignore[no-any-return]
