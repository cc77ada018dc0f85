"""Plantar's own recordings (MCAP) of `plantar.recordings.recorder`."""

from dataclasses import replace
from pathlib import Path
from typing import get_args

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.errors import DependencyError, FormatError
from plantar.formats.format import Format, ReadOptions
from plantar.formats.side import on_one_time
from plantar.formats.units import find_unit
from plantar.recordings.mcap_content import MCAP_MAGIC
from plantar.recordings.pressure_recording import FootRecording, Kind, PressureRecording, layout_for, sampling
from plantar.recordings.recording import Recording, Table, read_mcap


def _read(path: Path, options: ReadOptions) -> PressureRecording:
    """Read "/skin/left" and "/skin/right", whose field "force" is in N, or in counts; else any topics with arrays."""
    recording = read_mcap(path)
    raw = _is_raw(recording, options.unit)
    warnings = list(recording.warnings)
    tables: dict[Side, Table] = {}
    for side in SIDES:
        table = recording.topics.get(f"/skin/{side}")
        if table is not None and "force" in table.fields and len(table) > 0:
            tables[side] = _once(table)
    if not tables:
        return _other_bag(path, options, ", ".join(recording.topics) or "none")
    base, forces = on_one_time({side: (t.time, t.fields["force"]) for side, t in tables.items()}, warnings)
    time, rate, notes = sampling(base, None, options.rate_hz)
    warnings += notes
    feet: dict[Side, FootRecording] = {}
    for side, force in forces.items():
        own = layout_for(side, options.layout) or recording.layouts.get(side)
        if own is None:
            warnings.append(f"no layout of the {side} sole: forces only, give one with --layout for pressures and CoP")
        feet[side] = FootRecording(side, force, own, placement=_placement(recording, side, time))
    return PressureRecording(
        path=path,
        format=FORMAT.name,
        rate_hz=rate,
        time=time,
        feet=feet,
        metadata=dict(recording.metadata),
        warnings=tuple(warnings),
        raw=raw,
        kind=next((kind for kind in get_args(Kind) if kind == recording.metadata.get("kind")), "robot"),
    )


def _is_raw(recording: Recording, stated: str | None) -> bool:
    """Whether values are counts, as the recording or an option says; FormatError for an option that says otherwise."""
    counts = recording.metadata.get("unit") == "counts"
    newtons = recording.metadata.get("unit") == "N"
    unit = None if stated is None else find_unit(stated)
    if unit is None:
        return counts
    if unit.kind == "raw" and not newtons:
        return True
    if counts or unit.kind != "force" or unit.factor != 1.0:
        held = "counts" if counts else "forces in N"
        raise FormatError(
            f"unit {stated!r} of a Plantar recording, which holds {held}; allowed: N for forces, raw for counts"
        )
    return False


def _once(table: Table) -> Table:
    """Topic without repeated frames of an instant, as at a run's start: the last counts."""
    kept = np.append(np.diff(table.time) != 0.0, True)
    if kept.all() or not kept[-1]:
        return table
    return replace(table, time=table.time[kept], fields={name: values[kept] for name, values in table.fields.items()})


def _placement(recording: Recording, side: Side, time: NDArray[np.float64]) -> NDArray[np.float64] | None:
    truth = recording.topics.get(f"/truth/{side}")
    if truth is None or not {"position", "rotation"} <= set(truth.fields) or len(truth) < 2:
        return None
    position = truth.fields["position"]
    rotation = truth.fields["rotation"]
    if position.shape[1] != 3 or rotation.shape[1] != 9:
        return None
    columns = (position[:, 0], position[:, 1], np.unwrap(np.arctan2(rotation[:, 3], rotation[:, 0])))
    return np.column_stack([np.interp(time, truth.time, column) for column in columns])


def _other_bag(path: Path, options: ReadOptions, topics: str) -> PressureRecording:
    from plantar.formats.ros_bag import read_bag

    try:
        return read_bag(path, options)
    except (FormatError, DependencyError):
        raise FormatError(
            f"no taxel forces (/skin/left, /skin/right) in the recording, nor another topic with an array of "
            f"numbers; its topics: {topics}"
        ) from None


FORMAT = Format(
    name="mcap",
    title="Plantar recording",
    suffixes=(".mcap",),
    recognises=lambda head: head.startswith(MCAP_MAGIC),
    read=_read,
    order=10,
)
