"""C3D contents as plain arrays; ezc3d is native code, so in a separate process."""

import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.formats.side import side_of

_FOOT = (
    "to|hee|hel|heel|ank|mal|ft|foot|foo|cal|met|mt|mh|hal|hlx|hx|big|sma|smh|vmh|d[1-5]m|p[1-5]m|st[0-9]?$|m[15]|[1-5]m|fcc|fm|"
    "fal|tam|lmal|mmal|mm|lm|cuneo|nav|inst|toe"
)
_MARKER = re.compile(rf"(?:(?P<side>left|right|l|r)[ _.-]?(?:{_FOOT})|(?:{_FOOT})\w*?[ _.-](?P<end>left|right|l|r)$)")
_EVENT = re.compile(
    r"(?P<side>left|right|l|r)?[ _.-]*"
    r"(?:(?P<strike>(?:foot|heel|initial)?[ _-]*(?:strike|contact|on|down)|hs|ic|fs|fc|td)"
    r"|(?P<lift>(?:foot|toe)?[ _-]*(?:off|lift)|to|fo))[ _.-]*(?P<end>left|right|l|r)?\d*"
)


# Of a model of the body, which Vicon stores among the points: angles in degrees and forces in N are no places.
_MODELLED = re.compile(r"angles?|forces?|moments?|powers?|grf|scalars?")
_NO_GROUPS = ("ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS", "REACTIONS")


def foot_of_marker(label: str) -> Side | None:
    """Foot of a marker by its label, or None; also for a model's output, such as LAnkleAngles.

    Example:
        >>> [foot_of_marker(m) for m in ("LTOE", "S01:RHEE", "R_FCC", "Heel.L", "RFT1", "LSHO", "RKNE", "LAnkleForce")]
        ['left', 'right', 'right', 'left', 'right', None, None, None]
    """
    name = label.rpartition(":")[2].strip().lower()
    match = None if _MODELLED.search(name) else _MARKER.match(name)
    return None if match is None else side_of(match["side"] or match["end"])


def event_of(label: str, context: str = "") -> tuple[Side, str] | None:
    """Returns foot and "strikes" or "lifts" of an event's label and context, or None.

    Example:
        >>> event_of("LHS"), event_of("RTO"), event_of("Foot Off", "Right"), event_of("start", "General")
        (('left', 'strikes'), ('right', 'lifts'), ('right', 'lifts'), None)
    """
    match = _EVENT.fullmatch(label.strip().lower())
    if match is None:
        return None
    side = side_of(context, match["side"] or match["end"] or "")
    return None if side is None else (side, "strikes" if match["strike"] else "lifts")


def content_of_file(path: Path) -> dict[str, Any]:
    """Force plates, foot tracks and events of a C3D file.

    Returns "rate" in Hz and "frames" of the analog channels, number of "plates"; of plate i "channels_i" (c, n) as
    scaled by the file, "units_i", "type_i", "corners_i" (4, 3), "origin_i" (3,) and "matrix_i" (6, c) or empty;
    "point_unit"; "track_left" and "track_right" (n, 3), the foot's mean marker at the analog rate; "strikes_..." and
    "lifts_..." of each side in s from the first frame.
    """
    import ezc3d  # 0.08 s

    content = ezc3d.c3d(str(path))
    parameters = content["parameters"]
    analogs = np.asarray(content["data"]["analogs"], dtype=float)[0]
    rate = float(content["header"]["analogs"]["frame_rate"])
    out: dict[str, Any] = {"rate": rate, "frames": analogs.shape[1], "plates": 0}
    out |= _plates(parameters, analogs) | _events(content)
    out["point_unit"] = np.array(_values(parameters, "POINT", "UNITS")[:1] or ["mm"])
    points = np.asarray(content["data"]["points"], dtype=float)[:3]
    labels = [str(x) for x in _values(parameters, "POINT", "LABELS")]
    modelled = {str(x) for group in _NO_GROUPS for x in _values(parameters, "POINT", group)}
    for side in SIDES:
        places = [i for i, label in enumerate(labels[: points.shape[1]]) if label not in modelled]
        own = [i for i in places if foot_of_marker(labels[i]) == side]
        if own and points.shape[2] and analogs.shape[1]:
            known = np.where(np.isfinite(points[:, own]) & (points[:, own] != 0.0), points[:, own], np.nan)
            count = np.isfinite(known).sum(axis=1)
            track = np.nansum(known, axis=1) / np.where(count > 0, count, np.nan)
            every = np.minimum(np.arange(analogs.shape[1]) * points.shape[2] // analogs.shape[1], points.shape[2] - 1)
            out[f"track_{side}"] = track[:, every].T
    return out


def _values(parameters: Any, group: str, *names: str) -> list[Any]:
    held = parameters.get(group, {})
    for name in names:
        if name in held:
            more = (held[f"{name}{i}"]["value"] for i in range(2, 9) if f"{name}{i}" in held)
            return [*held[name]["value"], *(v for part in more for v in part)]
    return []


def _array(parameters: Any, name: str) -> NDArray[np.float64]:
    held = parameters.get("FORCE_PLATFORM", {})
    return np.asarray(held[name]["value"], dtype=float) if name in held else np.zeros(0)


def _plates(parameters: Any, analogs: NDArray[np.float64]) -> dict[str, Any]:
    used = _array(parameters, "USED")
    count = int(used[0]) if len(used) else 0
    types = _array(parameters, "TYPE")
    channels = _array(parameters, "CHANNEL")
    corners, origins, matrices = (_array(parameters, name) for name in ("CORNERS", "ORIGIN", "CAL_MATRIX"))
    units = [str(u) for u in _values(parameters, "ANALOG", "UNITS")]
    channels = channels.reshape(-1, count, order="F") if count and channels.size % max(count, 1) == 0 else channels
    out: dict[str, Any] = {"plates": count}
    for i in range(count):
        kind = int(types[i]) if i < len(types) else 0
        wanted = {1: 6, 2: 6, 3: 8, 4: 6, 5: 8}.get(kind, 0)
        numbers: Sequence[int] = [int(c) - 1 for c in channels[:wanted, i]] if channels.ndim == 2 else []
        there = len(numbers) == wanted and all(0 <= c < len(analogs) for c in numbers)
        out[f"type_{i}"] = kind
        out[f"channels_{i}"] = analogs[numbers] if there and wanted else np.zeros((0, analogs.shape[1]))
        out[f"units_{i}"] = np.array([units[c] if c < len(units) else "" for c in numbers] or [""])
        out[f"corners_{i}"] = _of_plate(corners, (3, 4), i, np.zeros((3, 0))).T
        out[f"origin_{i}"] = _of_plate(origins, (3,), i, np.zeros(3))
        own = matrices if kind in (4, 5) else np.zeros(0)
        out[f"matrix_{i}"] = _of_plate(own, (6, wanted), i, np.zeros((0, 0)))
    return out


def _of_plate(
    values: NDArray[np.float64], shape: tuple[int, ...], i: int, without: NDArray[np.float64]
) -> NDArray[np.float64]:
    size = math.prod(shape)
    part = values.ravel("F")[i * size : (i + 1) * size]
    return part.reshape(shape, order="F") if part.size == size else without


def _events(content: Any) -> dict[str, NDArray[np.float64]]:
    out = {f"{kind}_{side}": np.zeros(0) for kind in ("strikes", "lifts") for side in SIDES}
    parameters = content["parameters"]
    labels, contexts = (_values(parameters, "EVENT", name) for name in ("LABELS", "CONTEXTS"))
    group = parameters.get("EVENT", {})
    if not labels or "TIMES" not in group:
        return out
    points = content["header"]["points"]
    rate = float(points["frame_rate"])
    begin = float(points["first_frame"]) / rate if rate > 0.0 else 0.0
    times = np.asarray(group["TIMES"]["value"], dtype=float)
    times = times.reshape(2, -1) if times.size % 2 == 0 and times.size >= 2 * len(labels) else np.zeros((2, 0))
    for i, label in enumerate(labels):
        found = event_of(str(label), str(contexts[i]) if i < len(contexts) else "")
        if found is not None and i < times.shape[1]:
            key = f"{found[1]}_{found[0]}"
            out[key] = np.sort(np.append(out[key], 60.0 * times[0, i] + times[1, i] - begin))
    return out
