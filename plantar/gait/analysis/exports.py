"""Recordings in other programs' files: NPZ, CSV, C3D, OpenSim, each with a sidecar.

OpenSim's ground has y up and z right: its (x, z, -y) is (x, y, z) here.
"""

import hashlib
import json
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from plantar.common.atomic import keep_inputs, parent_folder, replacing, write_text
from plantar.common.files.input_file import name_in_text
from plantar.common.optional_library import optional_library
from plantar.common.sides import Side
from plantar.common.table_writer import write_csv_rows
from plantar.common.version import VERSION
from plantar.errors import InputError
from plantar.gait.analysis.c3d_export import write_onto_c3d
from plantar.gait.analysis.results import Analysis
from plantar.layouts.layout_file import layout_to_dict
from plantar.recordings.pressure_recording import PressureRecording


class GroundReaction(NamedTuple):
    """Ground reaction on one foot.

    `force`: force (n, 3) in N, NaN if unmeasured; horizontal parts 0 without wrench; `cop`: point (n, 2) in m, 0
    without load; `free`: free vertical moment (n,) there in N m.
    """

    force: NDArray[np.float64]
    cop: NDArray[np.float64]
    free: NDArray[np.float64]


def ground_reactions(analysis: Analysis) -> dict[Side, GroundReaction]:
    """Ground force on each foot: laboratory axes of plates, sole frame of insoles and robots."""
    out: dict[Side, GroundReaction] = {}
    for side, gait in analysis.feet.items():
        foot = gait.foot
        vertical = foot.vertical_force
        known = foot.center_of_pressure(1e-6)
        force = np.column_stack([np.zeros((len(vertical), 2)), vertical])
        free = np.zeros(len(vertical))
        cop = np.zeros((len(vertical), 2)) if known is None else np.nan_to_num(known)
        if foot.wrench is not None:
            wrench = np.nan_to_num(foot.wrench)
            force[:, :2] = wrench[:, :2]
            free = wrench[:, 5] - cop[:, 0] * force[:, 1] + cop[:, 1] * force[:, 0]
        force[np.isnan(vertical)] = np.nan
        out[side] = GroundReaction(force, cop, free)
    return out


def write_mot(analysis: Analysis, path: Path) -> None:
    """Write an analysis' ground forces to an OpenSim motion file (.mot) at a path; InputError of raw counts."""
    if analysis.recording.raw:
        raise InputError("a recording of raw counts has no forces for OpenSim; allowed: npz, csv, c3d")
    names = ["time"]
    columns = [analysis.recording.time]
    for side, reaction in ground_reactions(analysis).items():
        x, y = reaction.cop.T
        zero = np.zeros(len(x))
        parts: Mapping[str, tuple[NDArray[np.float64], ...]] = {
            "force_{}_v": (reaction.force[:, 0], reaction.force[:, 2], -reaction.force[:, 1]),
            "force_{}_p": (x, zero, -y),
            "torque_{}_": (zero, reaction.free, zero),
        }
        for name, three in parts.items():
            names += [f"ground_{name.format(side)}{axis}" for axis in "xyz"]
            columns += three
    head = f"ground forces\nversion=1\nnRows={len(columns[0])}\nnColumns={len(names)}\ninDegrees=no\nendheader\n"
    with path.open("w", encoding="utf-8") as stream:
        stream.write(head + "\t".join(names) + "\n")
        for row in np.column_stack(columns).tolist():
            stream.write("\t".join(f"{v:.10g}" for v in row) + "\n")


def write_external_loads(analysis: Analysis, path: Path, motion: str) -> None:
    """Write OpenSim's description (.xml) at `path` of the columns and bodies of a `motion` file of an `analysis`."""
    root = ElementTree.Element("OpenSimDocument", Version="40000")
    loads = ElementTree.SubElement(root, "ExternalLoads", name="externalloads")
    objects = ElementTree.SubElement(loads, "objects")
    plates = analysis.recording.kind == "plate"
    for side in analysis.feet:
        body = f"calcn_{side[0]}"
        one = ElementTree.SubElement(objects, "ExternalForce", name=f"ground_{side}")
        for key, value in (
            ("applied_to_body", body),
            ("force_expressed_in_body", "ground"),
            ("point_expressed_in_body", "ground" if plates else body),
            ("force_identifier", f"ground_force_{side}_v"),
            ("point_identifier", f"ground_force_{side}_p"),
            ("torque_identifier", f"ground_torque_{side}_"),
            ("data_source_name", motion),
        ):
            ElementTree.SubElement(one, key).text = value
    ElementTree.SubElement(loads, "datafile").text = motion
    ElementTree.indent(root)
    ElementTree.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)


_BLOCK = 4096
_PLATE = ("Fx [N]", "Fy [N]", "Fz [N]", "COPx [m]", "COPy [m]", "Tz [N m]")
"""Columns of a plate in a table, in the order of `GroundReaction`."""


def export_analysis(analysis: Analysis, path: str | os.PathLike[str]) -> list[Path]:
    """Write a recording in its suffix's format, and a BIDS sidecar (.json).

    Args:
        analysis: Recording without baselines.
        path: .npz (times, forces in N of each cell, layouts, events), .csv (a column a cell, `left 12 [N]`; of
            force plates force, CoP and free moment, `left Fz [N]`), .c3d (a
            force platform a foot, its CoP as point, events in group EVENT; needs ezc3d) or .mot (OpenSim, external
            loads as .xml).

    Returns:
        Files written; the sidecar of walk.c3d is walk.c3d.json.

    Raises:
        InputError: For other suffixes, unwritable folders.
        DependencyError: If ezc3d is missing.
    """
    target = Path(path)
    write = EXPORTS.get(target.suffix.lower())
    if write is None:
        raise InputError(f"cannot export to '{target.name}'; allowed: {', '.join(EXPORTS)}")
    keep_inputs(target, [analysis.recording.path])
    with parent_folder(target), replacing(target) as temporary:
        write(analysis, temporary)
    loads = []
    if target.suffix.lower() == ".mot":
        loads = [target.with_name(f"{target.stem}_loads.xml")]
        write_external_loads(analysis, loads[0], target.name)
    return [
        target,
        *loads,
        write_text(target.with_name(f"{target.name}.json"), json.dumps(_sidecar(analysis, target), indent=1) + "\n"),
    ]


def exporter(formats: Sequence[str]) -> Callable[[Analysis, Path], None] | None:
    """Function that writes an analysis in `formats`, such as "c3d" or ".csv", into a folder; None without formats."""
    suffixes = list(dict.fromkeys(f".{text.lower().removeprefix('.')}" for text in formats))
    for suffix in suffixes:
        if suffix not in EXPORTS:
            raise InputError(f"--export is {suffix[1:]!r}; allowed: {', '.join(known[1:] for known in EXPORTS)}")
    if ".c3d" in suffixes:
        with optional_library("ezc3d", "formats"):
            import ezc3d  # noqa: F401  # before anything is measured

    def write(analysis: Analysis, folder: Path) -> None:
        for suffix in suffixes:
            export_analysis(analysis, folder / f"{analysis.recording.path.stem}{suffix}")

    return write if suffixes else None


def _unit(analysis: Analysis) -> str:
    return "raw" if analysis.recording.raw else "N"


def _events(analysis: Analysis) -> list[tuple[str, str, float]]:
    found = [(side, "heel_strike", t) for side, gait in analysis.feet.items() for t in gait.heel_strikes]
    found += [(side, "toe_off", t) for side, gait in analysis.feet.items() for t in gait.toe_offs]
    return sorted(found, key=lambda one: one[2])


def _sidecar(analysis: Analysis, target: Path) -> dict[str, Any]:
    recording = analysis.recording
    plates = target.suffix.lower() == ".csv" and _with_wrenches(recording)
    return {
        "SamplingFrequency": recording.rate_hz,
        "StartTime": float(recording.time[0]),
        "RecordingDuration": float(recording.time[-1] - recording.time[0]),
        "TaskName": analysis.metrics.get("activity", {}).get("name", "unknown"),
        "Units": _unit(analysis),
        "Columns": {side: len(_PLATE) if plates else foot.force.shape[1] for side, foot in recording.feet.items()},
        "SoftwareName": "plantar",
        "SoftwareVersions": VERSION,
        "SourceFile": recording.path.name,
        "SourceFormat": recording.format,
        "Sha256": hashlib.sha256(target.read_bytes()).hexdigest(),
        "Warnings": list(recording.warnings),
        "Events": [{"onset": t, "trial_type": what, "side": side} for side, what, t in _events(analysis)],
    }


def _with_wrenches(recording: PressureRecording) -> bool:
    """Whether a recording is of force plates that measure more than the vertical force."""
    return recording.kind == "plate" and all(foot.wrench is not None for foot in recording.feet.values())


def _write_npz(analysis: Analysis, path: Path) -> None:
    recording = analysis.recording
    arrays: dict[str, Any] = {"time": recording.time, "rate_hz": recording.rate_hz, "unit": _unit(analysis)}
    arrays["kind"] = recording.kind
    for side, foot in recording.feet.items():
        arrays[side] = foot.force
        if foot.layout is not None:
            arrays[f"layout_{side}"] = json.dumps(layout_to_dict(foot.layout))
    for side in recording.feet:
        for what in ("heel_strike", "toe_off"):
            arrays[f"{what}s_{side}"] = np.array([t for s, w, t in _events(analysis) if (s, w) == (side, what)])
    with path.open("wb") as stream:
        np.savez(stream, **arrays)


def _write_csv(analysis: Analysis, path: Path) -> None:
    recording = analysis.recording
    feet, unit = recording.feet.items(), _unit(analysis)
    if _with_wrenches(recording):
        reactions = ground_reactions(analysis)
        names = [f"{side} {head}" for side in reactions for head in _PLATE]
        columns = [np.column_stack([r.force, r.cop, r.free]) for r in reactions.values()]
    else:
        ids = {s: np.arange(1, f.force.shape[1] + 1) if f.layout is None else f.layout.ids for s, f in feet}
        names = [f"{side} {cell} [{unit}]" for side in ids for cell in ids[side]]
        columns = [foot.force for _, foot in feet]
    with path.open("w", encoding="utf-8", newline="") as stream:
        write_csv_rows(stream, [["time [s]", *names]])
        for begin in range(0, len(recording.time), _BLOCK):
            part = slice(begin, begin + _BLOCK)
            block = np.column_stack([recording.time[part], *(column[part] for column in columns)])
            write_csv_rows(stream, ([None if v != v else f"{v:.9g}" for v in row] for row in block.tolist()))


def _even_frames(recording: PressureRecording) -> tuple[int, NDArray[np.int64], NDArray[np.bool_]]:
    """Count of evenly spaced frames, the nearest recorded one (n,) of each, and which (n,) lie in a gap."""
    time = recording.time
    rate = recording.rate_hz
    even = time[0] + np.arange(round(float(time[-1] - time[0]) * rate) + 1) / rate
    at = np.searchsorted(0.5 * (time[1:] + time[:-1]), even)
    return len(even), at, np.abs(time[at] - even) > 0.75 / rate


def _write_c3d(analysis: Analysis, path: Path) -> None:
    with optional_library("ezc3d", "formats"):
        import ezc3d
    recording = analysis.recording
    if recording.format == "c3d" and recording.path.is_file():
        forces = {side: reaction.force for side, reaction in ground_reactions(analysis).items()}
        places = {side: gait.cop for side, gait in analysis.feet.items() if gait.cop is not None}
        write_onto_c3d(recording, path, _events(analysis), forces, places)
        return
    frames, at, lost = _even_frames(recording)
    cops = {f"{side}.CoP": gait.cop for side, gait in analysis.feet.items() if gait.cop is not None}
    points = np.zeros((4, max(1, len(cops)), frames))  # the format has no file without points
    for i, cop in enumerate(cops.values()):
        points[:2, i] = np.nan_to_num(cop[at]).T
    unknown = np.array([np.isnan(cop[at, 0]) | lost for cop in cops.values()] or [np.ones(frames, dtype=bool)])
    file = ezc3d.c3d()
    unit = _unit(analysis)
    reactions = ground_reactions(analysis)
    channels = []
    corners = []
    count = len(reactions)
    for reaction in reactions.values():
        low = reaction.cop.min(axis=0) - 0.05
        high = reaction.cop.max(axis=0) + 0.05
        x, y = (reaction.cop - 0.5 * (low + high)).T  # moments are about the middle of the plate
        fx, fy, fz = reaction.force.T
        six = np.array([fx, fy, fz, y * fz, -x * fz, x * fy - y * fx + reaction.free])[:, at]
        channels.append(np.where(lost | np.isnan(fz[at]), np.nan, six))
        corners.append([[high[0], high[1], 0.0], [low[0], high[1], 0.0], [low[0], low[1], 0.0], [high[0], low[1], 0.0]])
    axes = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")
    for group, name, value in (
        ("POINT", "RATE", [recording.rate_hz]),
        ("POINT", "UNITS", ["m"]),
        ("POINT", "LABELS", list(cops) or ["none"]),
        ("ANALOG", "RATE", [recording.rate_hz]),
        ("ANALOG", "LABELS", [f"{side}.{axis}" for side in reactions for axis in axes]),
        ("ANALOG", "UNITS", [unit, unit, unit, f"{unit}m", f"{unit}m", f"{unit}m"] * count),
        ("ANALOG", "SCALE", [1.0] * (6 * count)),
        ("ANALOG", "OFFSET", [0] * (6 * count)),
        ("FORCE_PLATFORM", "USED", np.array([count])),
        ("FORCE_PLATFORM", "TYPE", np.full(count, 2)),
        ("FORCE_PLATFORM", "ZERO", np.array([1, 0])),
        ("FORCE_PLATFORM", "CORNERS", np.array(corners).transpose(2, 1, 0)),
        ("FORCE_PLATFORM", "ORIGIN", np.zeros((3, count))),
        ("FORCE_PLATFORM", "CHANNEL", np.arange(1, 6 * count + 1).reshape(-1, 6).T),
    ):
        file["parameters"][group][name]["value"] = value
    file["data"]["points"] = points
    file["data"]["meta_points"] = {  # residual -1: the point is not there, as without load
        "residuals": np.where(unknown, -1.0, 0.0)[None],
        "camera_masks": np.zeros((7, len(unknown), frames), dtype=bool),
    }
    file["data"]["analogs"] = np.concatenate(channels)[None]
    events = _events(analysis)
    if events:
        names = {"heel_strike": "Foot Strike", "toe_off": "Foot Off"}
        times = np.array([t - float(recording.time[0]) for _, _, t in events])
        file.add_parameter("EVENT", "USED", [len(events)])
        file.add_parameter("EVENT", "CONTEXTS", [side.capitalize() for side, _, _ in events])
        file.add_parameter("EVENT", "LABELS", [names[what] for _, what, _ in events])
        file.add_parameter("EVENT", "TIMES", np.vstack([times // 60.0, times % 60.0]))
    file.write(name_in_text(path, InputError, "the C3D file to write"))


EXPORTS: Mapping[str, Callable[[Analysis, Path], None]] = {
    ".npz": _write_npz,
    ".csv": _write_csv,
    ".c3d": _write_c3d,
    ".mot": write_mot,
}
"""What writes a file of each suffix."""
