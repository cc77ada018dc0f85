"""A C3D file as it was read, with events, centres of pressure and forces of each foot added."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.files.input_file import name_in_text
from plantar.common.sides import Side
from plantar.errors import FormatError, InputError
from plantar.formats.units import LENGTHS, plain
from plantar.recordings.pressure_recording import PressureRecording

_SAME = 0.1  # Time in s between a stated event and a found one that are the same
_NAMES = {"heel_strike": "Foot Strike", "toe_off": "Foot Off"}
_KINDS = {"heel_strike": "heel_strikes", "toe_off": "toe_offs"}


def write_onto_c3d(
    recording: PressureRecording,
    path: Path,
    events: list[tuple[str, str, float]],
    forces: Mapping[Side, NDArray[np.float64]],
    cops: Mapping[Side, NDArray[np.float64]],
) -> None:
    """Write a C3D recording's file to `path` with what was found in it; markers, channels and parameters stay.

    Args:
        recording: Of a C3D file.
        path: File to write.
        events: Side, "heel_strike" or "toe_off", and time in s; those that the file states are not repeated.
        forces: Force (n, 3) on each foot in N.
        cops: CoP (n, 2) of each foot in m, NaN without load.
    """
    import ezc3d

    file = ezc3d.c3d(name_in_text(recording.path, FormatError))
    axes = list(recording.metadata["axes"])
    points = np.array(file["data"]["points"])
    analogs = np.array(file["data"]["analogs"])
    every = np.minimum(np.arange(points.shape[2]) * analogs.shape[2] // points.shape[2], analogs.shape[2] - 1)
    scale = 1.0 / LENGTHS.get(plain(str(([*file["parameters"]["POINT"]["UNITS"]["value"], "mm"])[0])), 1e-3)
    _add_points(file, points, {side: _in_file(cop[every], axes) * scale for side, cop in cops.items()})
    _add_channels(file, analogs, {side: _in_file(force, axes) for side, force in forces.items()})
    rate = float(file["header"]["analogs"]["frame_rate"])
    first = float(file["header"]["points"]["first_frame"]) / float(file["header"]["points"]["frame_rate"])
    begin = float(recording.time[0])
    new = [
        (side, what, first + (time - begin) * recording.rate_hz / rate)
        for side, what, time in events
        if not _is_stated(recording, side, what, time)
    ]
    _add_events(file, new)
    file.write(name_in_text(path, InputError, "the C3D file to write"))


def _in_file(values: NDArray[np.float64], axes: list[int]) -> NDArray[np.float64]:
    """Values (n, 2) or (n, 3) with z up, as (3, n) in the file's axes; 0 where there is no third one."""
    out = np.zeros((3, len(values)))
    for own, axis in enumerate(axes[: values.shape[1]]):
        out[axis] = values[:, own]
    return out


def _add_points(file: Any, points: NDArray[np.float64], cops: Mapping[Side, NDArray[np.float64]]) -> None:
    if not cops:
        return
    frames = points.shape[2]
    added = np.ones((4, len(cops), frames))
    added[:3] = np.nan_to_num(np.stack(list(cops.values()), axis=1))
    lost = np.stack([np.isnan(cop).any(axis=0) for cop in cops.values()])
    meta = file["data"]["meta_points"]
    file["data"]["points"] = np.concatenate([points, added], axis=1)
    meta["residuals"] = np.concatenate([meta["residuals"], np.where(lost, -1.0, 0.0)[None]], axis=1)
    masks = np.zeros((7, len(cops), frames), dtype=bool)
    meta["camera_masks"] = np.concatenate([meta["camera_masks"], masks], axis=1)
    names = {"LABELS": [f"{side}.CoP" for side in cops], "DESCRIPTIONS": [""] * len(cops)}
    _extend(file["parameters"]["POINT"], points.shape[1], names)


def _add_channels(file: Any, analogs: NDArray[np.float64], forces: Mapping[Side, NDArray[np.float64]]) -> None:
    names = [f"{side}.F{axis}" for side in forces for axis in "xyz"]
    if not names:
        return
    values = np.concatenate(list(forces.values()))[None, :, : analogs.shape[2]]
    file["data"]["analogs"] = np.concatenate([analogs, values], axis=1)
    count = len(names)
    _extend(
        file["parameters"]["ANALOG"],
        analogs.shape[1],
        {
            "LABELS": names,
            "UNITS": ["N"] * count,
            "DESCRIPTIONS": ["force on the foot"] * count,
            "SCALE": [1.0] * count,
            "OFFSET": [0] * count,
            "GAIN": [0] * count,
        },
    )


def _is_stated(recording: PressureRecording, side: str, what: str, time: float) -> bool:
    stated = next((getattr(own, _KINDS[what]) for s, own in recording.events.items() if s == side), np.zeros(0))
    return bool(len(stated) and np.abs(stated - time).min() <= _SAME)


def _add_events(file: Any, events: list[tuple[str, str, float]]) -> None:
    if not events:
        return
    parameters = file["parameters"]
    group = parameters.get("EVENT", {})
    if "TIMES" not in group or "LABELS" not in group:
        for name in ("LABELS", "CONTEXTS", "DESCRIPTIONS"):
            file.add_parameter("EVENT", name, [""])
        file.add_parameter("EVENT", "USED", [0])
        file.add_parameter("EVENT", "TIMES", np.zeros((2, 0)))
        group = parameters["EVENT"]
        for name in ("LABELS", "CONTEXTS", "DESCRIPTIONS"):
            group[name]["value"] = []
    before = len(group["LABELS"]["value"])
    times = np.array([time for _, _, time in events])
    held = np.asarray(group["TIMES"]["value"], dtype=float).reshape(2, -1)
    group["TIMES"]["value"] = np.hstack([held, np.vstack([times // 60.0, times % 60.0])])
    subjects = group["SUBJECTS"]["value"] if "SUBJECTS" in group else []
    _extend(
        group,
        before,
        {
            "LABELS": [_NAMES[what] for _, what, _ in events],
            "CONTEXTS": [side.capitalize() for side, _, _ in events],
            "DESCRIPTIONS": ["found in the force by Plantar"] * len(events),
            "SUBJECTS": [subjects[0] if subjects else ""] * len(events),
            "ICON_IDS": [1 if what == "heel_strike" else 2 for _, what, _ in events],
            "GENERIC_FLAGS": [0] * len(events),
        },
    )
    if "USED" in group:
        group["USED"]["value"] = np.array([before + len(events)])


def _extend(group: Any, count: int, values: Mapping[str, list[Any]]) -> None:
    """Add values to those parameters of `count` values that a group has; missing ones before them are filled in."""
    for name, more in values.items():
        if name in group:
            held = group[name]["value"]
            known = held if isinstance(held, list) else np.asarray(held).ravel().tolist()
            filled = [more[0] if not isinstance(more[0], str) else "" for _ in range(len(known), count)]
            group[name]["value"] = [*known[:count], *filled, *more]
