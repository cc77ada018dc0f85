"""Table of the footsteps of a walk (metadata.csv), as StepUP-P150 has it: feet, frames, boxes and faults."""

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import cast

from plantar.common.files.input_file import is_file
from plantar.common.files.text_table import TextTable, read_text_table
from plantar.common.sides import SIDES
from plantar.errors import FormatError
from plantar.formats.text import number
from plantar.layouts.layout import Side

NAME = "metadata.csv"
PEOPLE = "participant_metadata.csv"
"""Names of the tables of footsteps, beside a walk, and of people, in a folder above it."""

_NEEDED = ("side", "startframe", "endframe")
_BOX = ("ymin", "ymax", "xmin", "xmax")
_FAULTS = ("incomplete", "outlier", "standing")
_LEVELS_ABOVE = 4  # Folders above a walk in which the table of people is looked for: person/footwear/speed


@dataclass(frozen=True)
class StatedStep:
    """Row of the table.

    Attributes:
        number: Place in a stack of footsteps.
        begin: First frame of the walk.
        end: Last frame.
        box: First and last row and column on the walkway; None where not stated.
        backwards: Whether it walks towards row 0; None where not stated.
        turn_deg: Angle by which the foot turns to the right of the direction of walking.
        unused: Why it is not in the means, or empty.
    """

    number: int
    side: Side
    walk: int
    begin: int
    end: int
    box: tuple[int, int, int, int] | None = None
    backwards: bool | None = None
    turn_deg: float | None = None
    unused: str = ""


@dataclass(frozen=True)
class StepTable:
    """Rows of a table of footsteps, and whose they are: participant, footwear and speed, where stated."""

    steps: tuple[StatedStep, ...]
    who: Mapping[str, str] = field(default_factory=dict)


def step_table_beside(path: Path) -> StepTable | None:
    """Returns the table in a walk's folder; None without one, FormatError if it is no table of footsteps."""
    table = path.parent / NAME
    return read_step_table(table) if is_file(table) else None


def people_of_steps(path: Path) -> Mapping[str, str]:
    """Participant, footwear and speed that the table in a walk's folder states; empty without one, or unreadable.

    What is wrong with a table is reported where its footsteps are read.
    """
    try:
        return _who(read_text_table(path.parent / NAME, FormatError))
    except FormatError:
        return {}


def read_step_table(path: str | os.PathLike[str]) -> StepTable:
    """Read a table of footsteps: a row each, with Side, StartFrame and EndFrame, and what else StepUP-P150 states.

    Other columns: FootstepID, PassID, Ymin, Ymax, Xmin, Xmax, Orientation, RotationAngle, Exclude, Incomplete, Outlier,
    Standing, ParticipantID, Footwear, Speed.

    Raises:
        FormatError: If a column is missing, or a cell is not what it should be.
    """
    table = read_text_table(path, FormatError)
    missing = [name for name in _NEEDED if table.column(name) is None]
    if missing:
        raise FormatError(
            f"{os.fspath(path)}: no column {', '.join(missing)}; allowed: a row a footstep with Side, StartFrame, "
            "EndFrame"
        )
    columns = {name: at for name in table.names if (at := table.column(name)) is not None}
    steps = [_stated(path, columns, place, line, row) for place, (line, row) in enumerate(table.rows)]
    if not steps:
        raise FormatError(f"{os.fspath(path)}: no footstep in it; allowed: a row a footstep")
    if len({step.number for step in steps}) < len(steps):
        raise FormatError(f"{os.fspath(path)}: a FootstepID is given twice; allowed: each once")
    return StepTable(tuple(steps), _who(table))


def _who(table: TextTable) -> dict[str, str]:
    if not table.rows:
        return {}
    first = table.rows[0][1]
    known = {"participant": "participantid", "footwear": "footwear", "speed": "speed"}
    named = ((key, table.column(name)) for key, name in known.items())
    who = {key: first[at].strip() for key, at in named if at is not None and at < len(first) and first[at].strip()}
    if who.get("participant", "").isdigit():
        who["participant"] = f"{int(who['participant']):03}"  # as the folders are named
    return who


def _stated(
    path: str | os.PathLike[str], columns: Mapping[str, int], place: int, line: int, row: list[str]
) -> StatedStep:
    def text(name: str) -> str:
        at = columns.get(name, len(row))
        return row[at].strip() if at < len(row) else ""

    def whole(name: str, default: int | None = None) -> int:
        held = text(name)
        if held.isascii() and held.isdigit() and len(held) < 10:
            return int(held)
        found = number(held)
        if not held and default is not None:
            return default
        if found is None or found != round(found) or not 0 <= found < 1e9:
            raise FormatError(f"{os.fspath(path)}, line {line}: {name} is {held!r}; allowed: a whole number")
        return int(found)

    side = text("side").lower()
    if side not in SIDES:
        raise FormatError(f"{os.fspath(path)}, line {line}: side is {text('side')!r}; allowed: left, right")
    begin = whole("startframe")
    end = whole("endframe")
    box = cast(tuple[int, int, int, int], tuple(map(whole, _BOX))) if all(map(text, _BOX)) else None
    if end <= begin or (box is not None and (box[1] < box[0] or box[3] < box[2])):
        raise FormatError(f"{os.fspath(path)}, line {line}: it ends before it begins; allowed: first, then last")
    faults = [name for name in _FAULTS if whole(name, 0)]
    excluded = whole("exclude", int(bool(faults)))
    orientation = text("orientation")
    return StatedStep(
        number=whole("footstepid", place),
        side=side,
        walk=whole("passid", 0),
        begin=begin,
        end=end,
        box=box,
        backwards=None if not orientation else whole("orientation") == 0,
        turn_deg=number(text("rotationangle")),
        unused=f"excluded by {NAME}: {', '.join(faults) or 'no reason stated'}" if excluded else "",
    )


def masses_of_people(path: Path) -> dict[str, float]:
    """Returns mass in kg of each participant by the table of people in a folder above a walk; empty without one."""
    for folder in list(path.resolve().parents)[1 : _LEVELS_ABOVE + 2]:
        if is_file(folder / PEOPLE):
            return _masses(folder / PEOPLE)
    return {}


def _masses(path: Path) -> dict[str, float]:
    table = read_text_table(path, FormatError)
    out = {}
    for _, row in table.rows:
        cells = dict(zip(table.names, row, strict=False))
        person = cells.get("participantid", "").strip()
        mass = number(cells.get("weight (kg)", ""))
        if mass is not None and mass > 0.0 and person.isdecimal():
            out[f"{int(person):03}"] = mass
    return out
