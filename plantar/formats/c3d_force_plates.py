"""Force plates in C3D files: the force, its moment and the centre of pressure of each plate, without cells.

ezc3d reads the file in a process of its own, with limits: its native code might crash or ask for any amount of memory
on damaged files.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.errors import DependencyError, FormatError
from plantar.files.confined import confined
from plantar.files.input_file import check_input, open_input
from plantar.formats.format import Format, ReadOptions
from plantar.formats.units import FORCES, LENGTHS
from plantar.recordings.pressure_recording import FootRecording, PressureRecording, StatedEvents, possible_rate
from plantar.sides import SIDES, Side

__all__ = ["FORMAT", "plates_of_file"]

_LARGEST, _HEAD = 256e6, 1 << 16  # bytes
_MEMORY, _MEMORY_A_BYTE = 250e6, 64.0  # ezc3d takes 48 times the file
_SECONDS, _SECONDS_A_BYTE = 10.0, 3e-6
_LEAST = 20.0
"""Vertical force in N from which a plate counts as stepped on."""


def _recognises(head: bytes) -> bool:
    if len(head) < 1024 or head[1] != 0x50 or not 2 <= head[0] <= 100:
        return False
    processor = (head[0] - 1) * 512 + 3  # in the head of the parameters: Intel, DEC or SGI
    return processor < len(head) and head[processor] in (84, 85, 86)


def _read(path: Path, options: ReadOptions) -> PressureRecording:
    """Read the force plates.

    Raises:
        FormatError: If the file is damaged or holds no force plate.
        DependencyError: If ezc3d is not installed.
    """
    if find_spec("ezc3d") is None:
        raise DependencyError("ezc3d", "formats")
    size = check_input(path, FormatError, _LARGEST)
    with open_input(path, FormatError) as stream:
        head = stream.read(_HEAD)
    if len(head) < 512 or head[1] != 0x50:
        raise FormatError(f"{path}: not a C3D file that can be read (no C3D header)")
    limits = {"memory": _MEMORY + _MEMORY_A_BYTE * size, "seconds": _SECONDS + _SECONDS_A_BYTE * size}
    held = confined("plantar.formats.c3d_force_plates:plates_of_file", path, FormatError, "a C3D file", **limits)
    rate = options.rate_hz or float(held["rate"])
    count = int(held["plates"])
    if count == 0:
        raise FormatError(f"{path}: the C3D file holds no force plate (group FORCE_PLATFORM)")
    possible_rate(rate, "its analog channels state")
    warnings = _cut_short(head, held)
    plates = [_Plate(held, i, warnings) for i in range(count)]
    used = [p for p in plates if (p.force[:, 2] > _LEAST).any()]
    if not used:
        raise FormatError(f"{path}: no force plate carries more than {_LEAST:g} N")
    if len(used) < count:
        warnings.append(f"{count - len(used)} of {count} force plates are never stepped on")
    if any(p.turned for p in used):
        warnings.append("the plates' forces point down: taken as those on the plate, and turned to those on the foot")
    feet = {side: _foot(side, own) for side, own in _sides(used, options, warnings).items()}
    time = np.arange(len(used[0].force)) / rate
    warnings.append("force plates have no cells: no pressures, areas and regions; the CoP is in the laboratory's axes")
    return PressureRecording(
        path=path,
        format=FORMAT.name,
        rate_hz=rate,
        time=time,
        feet=feet,
        metadata={"plates": count},
        warnings=tuple(dict.fromkeys(warnings)),
        kind="plate",
        events=_stated_events(held),
    )


def _stated_events(held: Mapping[str, NDArray[Any]]) -> dict[Side, StatedEvents]:
    """The foot strikes and foot offs that the group EVENT states, in the frames' time."""
    found = {side: StatedEvents(held[f"strikes_{side}"], held[f"lifts_{side}"]) for side in SIDES}
    return {side: own for side, own in found.items() if len(own.heel_strikes) or len(own.toe_offs)}


def _cut_short(head: bytes, held: Mapping[str, NDArray[Any]]) -> list[str]:
    """A warning where the file holds fewer frames than its header states: the library reads what there is."""
    first, last = struct.unpack_from("<HH", head, 6)
    (samples,) = struct.unpack_from("<H", head, 18)
    read = held["force_0"].shape[1]
    stated = (last - first + 1) * samples
    processor = (head[0] - 1) * 512 + 3
    other_order = processor >= len(head) or head[processor] == 86  # SGI: bytes the other way round
    if (
        other_order or last == 65535 or last < first or not read < stated
    ):  # long recordings state their frames elsewhere
        return []
    return [f"the file is cut short: {read} of {stated} frames are there"]


class _Plate:
    """One force plate: force on the foot (n, 3) in N, CoP (n, 2) and centre (2,) in m, free moment (n,) in N m."""

    def __init__(self, held: dict[str, NDArray[Any]], number: int, warnings: list[str]) -> None:
        units = [str(u) for u in held[f"units_{number}"]]
        force_unit, moment_unit, length_unit = (u.strip().lower() for u in units)
        if force_unit not in FORCES:
            warnings.append(f"a plate's unit of force {force_unit!r} is not known: N is assumed")
        if length_unit not in LENGTHS:
            warnings.append(f"a plate's unit of length {length_unit!r} is not known: mm is assumed")
        length = LENGTHS.get(length_unit, 1e-3)
        self.force = held[f"force_{number}"].T * FORCES.get(force_unit, 1.0)
        self.force[~np.isfinite(self.force)] = np.nan
        loaded = self.force[np.abs(self.force[:, 2]) > _LEAST, 2]
        self.turned = len(loaded) > 0 and float(np.median(loaded)) < 0.0
        moment_length = 1.0 if moment_unit in ("nm", "n.m", "n*m") else 1e-3
        self.free_moment = held[f"tz_{number}"].T[:, 2] * moment_length
        if self.turned:
            self.force, self.free_moment = -self.force, -self.free_moment
        self.cop = held[f"cop_{number}"].T[:, :2] * length
        self.cop[~np.isfinite(self.cop).all(axis=1) | ~(self.force[:, 2] > _LEAST)] = np.nan
        self.centre = held[f"corners_{number}"][:2].mean(axis=1) * length


def _sides(plates: list[_Plate], options: ReadOptions, warnings: list[str]) -> dict[Side, list[_Plate]]:
    """Which plates are of which foot: by their place across the direction of walking."""
    if len(plates) == 1:
        side = options.side or "left"
        if options.side is None:
            warnings.append(
                "the file does not say which foot steps on the plate: taken as the left one (--side overrides)"
            )
        return {side: plates}
    onset = [float(np.argmax(p.force[:, 2] > _LEAST)) for p in plates]
    order = np.argsort(onset)
    travel = plates[int(order[-1])].centre - plates[int(order[0])].centre
    path = np.vstack([p.cop[np.isfinite(p.cop).all(axis=1)][[0, -1]] for p in plates if np.isfinite(p.cop).any()])
    along = sum((path[i + 1] - path[i] for i in range(0, len(path), 2)), np.zeros(2))
    steps = along if np.hypot(*along) > 0.02 else travel
    direction = np.zeros(2)  # along the laboratory's axis that the walk follows most
    direction[int(np.argmax(np.abs(steps)))] = np.sign(steps[int(np.argmax(np.abs(steps)))]) or 1.0
    places = [np.nanmean(p.cop, axis=0) if np.isfinite(p.cop).any() else p.centre for p in plates]
    leftward = np.array([place @ np.array([-direction[1], direction[0]]) for place in places])
    middle = 0.5 * (leftward.max() + leftward.min())
    warnings.append("which plate is stepped on by which foot is told from their places across the direction of walking")
    if np.ptp(leftward) < 0.02:
        warnings.append("the plates lie in one line: taken as stepped on by left and right in turns")
        return {
            "left": [plates[int(i)] for i in order[0::2]],
            "right": [plates[int(i)] for i in order[1::2]],
        }
    left = [p for p, y in zip(plates, leftward, strict=True) if y >= middle]
    right = [p for p, y in zip(plates, leftward, strict=True) if y < middle]
    return {"left": left, "right": right}


def _foot(side: Side, plates: list[_Plate]) -> FootRecording:
    force = np.sum([np.nan_to_num(p.force) for p in plates], axis=0)
    load = np.array([np.where(np.isfinite(p.cop[:, 0]), np.nan_to_num(p.force[:, 2]), 0.0) for p in plates])
    places = np.array([np.nan_to_num(p.cop) for p in plates])
    with np.errstate(invalid="ignore", divide="ignore"):
        cop = (load[:, :, None] * places).sum(axis=0) / load.sum(axis=0)[:, None]
    free = np.sum([np.nan_to_num(p.free_moment) for p in plates], axis=0)
    x, y = np.nan_to_num(cop).T
    moment = np.column_stack([y * force[:, 2], -x * force[:, 2], x * force[:, 1] - y * force[:, 0] + free])
    return FootRecording(side, force[:, 2:3], None, total=force[:, 2], cop=cop, wrench=np.column_stack([force, moment]))


def plates_of_file(path: Path) -> dict[str, Any]:
    """The force plates of a C3D file; called in a process of its own.

    Args:
        path: The file.

    Returns:
        "rate" in Hz and the number of "plates"; of each plate i "force_i", "cop_i", "tz_i" (3, n), "corners_i" (3, 4)
        and the "units_i" of force, moment and length.
    """
    import ezc3d  # 0.08 s

    content = ezc3d.c3d(str(path), extract_forceplat_data=True)
    plates = content["data"]["platform"]
    out: dict[str, Any] = {"rate": float(content["header"]["analogs"]["frame_rate"]), "plates": len(plates)}
    out |= _events_of(content)
    for i, plate in enumerate(plates):
        out[f"force_{i}"] = np.asarray(plate["force"], dtype=float)
        out[f"cop_{i}"] = np.asarray(plate["center_of_pressure"], dtype=float)
        out[f"tz_{i}"] = np.asarray(plate["Tz"], dtype=float)
        out[f"corners_{i}"] = np.asarray(plate["corners"], dtype=float)
        out[f"units_{i}"] = np.array([plate["unit_force"], plate["unit_moment"], plate["unit_position"]])
    return out


def _events_of(content: Any) -> dict[str, NDArray[np.float64]]:
    """Times in s of the strikes and lifts of each foot, from the first frame that the file holds."""
    out = {f"{kind}_{side}": np.zeros(0) for kind in ("strikes", "lifts") for side in SIDES}
    group = content["parameters"].get("EVENT", {})
    if not all(key in group for key in ("LABELS", "CONTEXTS", "TIMES")):
        return out
    points = content["header"]["points"]
    rate = float(points["frame_rate"])
    begin = float(points["first_frame"]) / rate if rate > 0.0 else 0.0
    times = np.asarray(group["TIMES"]["value"], dtype=float).reshape(2, -1)
    for i, (label, context) in enumerate(zip(group["LABELS"]["value"], group["CONTEXTS"]["value"], strict=False)):
        word, side = str(label).lower(), str(context).strip().lower()
        kind = "strikes" if "strike" in word or "contact" in word else "lifts" if "off" in word else ""
        if kind and side in SIDES and i < times.shape[1]:
            key = f"{kind}_{side}"
            out[key] = np.sort(np.append(out[key], 60.0 * times[0, i] + times[1, i] - begin))
    return out


FORMAT = Format(name="c3d", title="force plates in a C3D file", suffixes=(".c3d",), recognises=_recognises, read=_read)
"""The entry of the registry."""
