"""Steps of a walkway or stack as feet: times between steps, lengths, and which steps are in the means."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side, other_side
from plantar.errors import FormatError, InputError
from plantar.formats.format import ReadOptions
from plantar.formats.step_table import step_table_beside
from plantar.formats.walkway import PITCH, walkway_file
from plantar.gait.analysis.options import AnalysisOptions
from plantar.gait.analysis.steps.events import Contact
from plantar.gait.analysis.steps.foot_gait import FootGait, Step
from plantar.gait.analysis.steps.segments import without_standing
from plantar.gait.analysis.steps.steady import with_used_steps
from plantar.gait.analysis.steps.step_times import OtherFoot, longest_strides, stride_times, time_measures
from plantar.gait.analysis.steps.walk_geometry import step_geometry
from plantar.gait.analysis.walkway.measured_step import MeasuredStep, measure_step
from plantar.gait.analysis.walkway.walkway_steps import steps_of_file
from plantar.recordings.pressure_recording import FootRecording

SENSOR = ("a walkway", PITCH**2)
"""What measured, and the area of its cells in m2."""

_LONGEST = 3.0  # Longest contact in s of a step: a longer one is standing
_AROUND = 1.0  # s before and after a pass in which no foot is on the walkway


@dataclass(frozen=True, eq=False)
class MeasuredWalkway:
    """Feet of a walkway or stack.

    `feet`: gait of each side; `curves`: mean vertical force (101,) in N of the used steps; `maps`: mean of their
    largest pressures in Pa, NaN where fewer than half of them load; `warnings`: what was assumed.
    """

    feet: Mapping[Side, FootGait]
    curves: Mapping[Side, NDArray[np.float64]]
    maps: Mapping[Side, NDArray[np.float64]]
    warnings: tuple[str, ...]


def measure_walkway(
    path: Path, options: ReadOptions, choices: AnalysisOptions, grid: tuple[int, int]
) -> MeasuredWalkway:
    """Measure the footsteps of a walkway or stack one by one; memory is that of one pass.

    Args:
        path: NPZ or NPY file; a table metadata.csv in its folder decides on feet.
        options: Unit and rate, where they are not kPa and 100 Hz.
        choices: Steps in the means, and regions. Events are the first and last loaded frames.
        grid: Rows and columns of the maps.

    Raises:
        FormatError: If the file is neither, or holds no footstep.
        InputError: For events or a segment, which walkways do not have.
    """
    if choices.events != "own" or choices.threshold is not None or choices.segment is not None:
        raise InputError("--events, --threshold and --segment are not for walkways; allowed: --steps, --from, --to")
    file = walkway_file(path, options)
    notes = list(file.notes)
    table = step_table_beside(path)
    if table is None:
        notes.append("no metadata.csv lies beside it: feet are those left and right of the line of walking")
    found = [m for step in steps_of_file(file, table, notes) if (m := measure_step(step, choices.masks, grid))]
    if not found:
        raise FormatError(f"{path}: no footstep in it")
    standing = sum(m.lift - m.strike > _LONGEST for m in found)
    if standing:
        notes.append(f"{standing} contact(s) of more than {_LONGEST:g} s are standing, no steps")
    ordered = sorted(found, key=lambda m: m.strike)
    sides = {side: [m for m in ordered if m.side == side] for side in SIDES}
    present = {side: own for side, own in sides.items() if own}
    contacts = {side: _contacts(own) for side, own in present.items()}
    spans = _passes(ordered)
    feet = {}
    for side, own in present.items():
        other = contacts.get(other_side(side))
        others = None if other is None else OtherFoot(other, _spans(other), spans)
        feet[side] = _foot(side, own, contacts[side], others, present, choices)
    used = {side: {step.number for step in gait.used} for side, gait in feet.items()}
    means = {s: [m for m, c in _steps_of(own, contacts[s]) if c in used[s]] for s, own in present.items()}
    return MeasuredWalkway(
        feet,
        {side: np.mean([m.curve for m in own], axis=0) for side, own in means.items() if own},
        {side: _mean_map(own) for side, own in means.items() if own},
        tuple(dict.fromkeys([*notes, *(note for gait in feet.values() for note in gait.warnings)])),
    )


def _contacts(own: Sequence[MeasuredStep]) -> list[Contact]:
    contacts = [
        Contact(m.strike, m.lift, 2 * i, 2 * i + 2, walk=m.walk, cut="cut off" in m.unused) for i, m in enumerate(own)
    ]
    return without_standing(contacts, _LONGEST)


def _steps_of(own: Sequence[MeasuredStep], contacts: Sequence[Contact]) -> list[tuple[MeasuredStep, int]]:
    """Measured steps that are complete, and their numbers from 1."""
    complete = [m for m, c in zip(own, contacts, strict=True) if c.complete]
    return [(m, number) for number, m in enumerate(complete, 1)]


def _spans(contacts: Sequence[Contact]) -> list[tuple[float, float]]:
    return [(c.heel_strike or 0.0, c.toe_off or 0.0) for c in contacts]


def _passes(ordered: Sequence[MeasuredStep]) -> list[tuple[float, float]]:
    """Times in s of each pass, with those around it in which nobody is on the walkway."""
    ends: dict[int, tuple[float, float]] = {}
    for m in ordered:
        begin, end = ends.get(m.walk, (m.strike, m.lift))
        ends[m.walk] = (min(begin, m.strike), max(end, m.lift))
    return [(begin - _AROUND, end + _AROUND) for begin, end in ends.values()]


def _foot(
    side: Side,
    own: Sequence[MeasuredStep],
    contacts: Sequence[Contact],
    others: OtherFoot | None,
    present: Mapping[Side, Sequence[MeasuredStep]],
    choices: AnalysisOptions,
) -> FootGait:
    places = {s: [m.place for m in each if m.place is not None] for s, each in present.items()}
    lengths = step_geometry(places)[side] if len(places[side]) == len(own) else [{} for _ in own]
    most = longest_strides(contacts)
    longest = iter(most)
    strides = iter(stride_times(contacts, most))
    before: Contact | None = None
    steps: list[Step] = []
    left_out: dict[int, str] = {}
    for m, contact, length in zip(own, contacts, lengths, strict=True):
        if contact.complete:
            times = time_measures(contact, before, next(strides), next(longest), others)
            measures = {**times, **m.measures, **length}
            number = len(steps) + 1
            steps.append(Step(side, number, m.strike, m.lift, contact, measures, m.regions))
            if m.unused:
                left_out[number] = m.unused
        before = contact
    empty = FootRecording(side, np.zeros((0, 0)))
    gait = FootGait(empty, None, tuple(contacts), tuple(steps), None, np.zeros(0), masks=choices.masks)
    gait = with_used_steps(gait, choices, "platform")
    kept = (replace(s, used=False, unused=left_out[s.number]) if s.number in left_out else s for s in gait.steps)
    return replace(gait, steps=tuple(kept))


def _mean_map(own: Sequence[MeasuredStep]) -> NDArray[np.float64]:
    maps = np.array([m.map for m in own])
    return np.where((maps > 0.0).mean(axis=0) >= 0.5, maps.mean(axis=0), np.nan)
