"""Table of a study: each file's participant, condition and properties."""

import os
import re
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field

from plantar.common.files.text_table import read_text_table
from plantar.common.sides import SIDES
from plantar.errors import FormatError, InputError
from plantar.formats.text import number
from plantar.gait.analysis.subject import BODY_MASSES, FOOT_LENGTHS

# Names that a column may have, by what it holds; other columns are carried through to the tables.
_NAMES = {
    "file": ("file", "recording", "filename", "path"),
    "participant": ("participant", "participant_id", "subject", "subject_id", "id", "patient"),
    "condition": ("condition", "group", "shoe", "task"),
    "mass_kg": ("mass_kg", "mass", "weight_kg", "body_mass_kg"),
    "foot_length_m": ("foot_length_m", "foot_length"),
    "side": ("side", "foot"),
    "insole_size": ("insole_size",),
    "unit": ("unit",),
    "rate_hz": ("rate_hz", "rate"),
    "layout": ("layout",),
}
# Names that look as if they were read: by word stems, another unit, or beside the one that is.
_ALIKE = {
    "participant": r"(?:participant|subject|patient|proband|person)s?(?:_?(?:id|name|no|nr|number|code))?|id|name",
    "condition": r"(?:condition|group|cohort|shoe|task|footwear)s?(?:_?(?:id|name))?",
    "mass_kg": r"(?:body_?)?(?:mass|weight)(?:_\w*)?|kg|lbs?",
    "foot_length_m": r"(?:foot|shoe)_?(?:length|size)(?:_\w*)?",
    "side": r"(?!affected_|involved_)(?:\w+_)?side|foot|leg|limb",
    "unit": r"units?(?:_\w*)?",
    "rate_hz": r"(?:sampl\w*_?|frame_?)?(?:rate|frequency|freq|fs)(?:_\w*)?",
}


@dataclass(frozen=True)
class Participation:
    """One recording of a study; None where no table states a value.

    Attributes:
        file: Path relative to the study's folder.
        condition: Name of the condition, or empty.
        mass_kg: Body mass in kg.
        foot_length_m: In m.
        side: "left" or "right" for a one-foot file that does not name it.
        layout: Layout file relative to the study's folder.
        listed: Whether the table names the file.
    """

    file: str
    participant: str
    condition: str = ""
    mass_kg: float | None = None
    foot_length_m: float | None = None
    side: str | None = None
    insole_size: str | None = None
    unit: str | None = None
    rate_hz: float | None = None
    layout: str | None = None
    more: Mapping[str, str] = field(default_factory=dict)
    listed: bool = True


def read_participants(path: str | os.PathLike[str]) -> list[Participation]:
    """Read a study's table: CSV or TSV, a row of names and a row a recording.

    Columns file, participant and condition; optionally mass_kg, foot_length_m (or _mm, _cm), side, insole_size, unit,
    rate_hz and layout; others are carried through.
    """
    table = read_text_table(path, FormatError)
    names = table.names
    columns = {key: at for key, known in _NAMES.items() if (at := table.column(*known)) is not None}
    missing = [key for key in ("file", "participant", "condition") if key not in columns]
    if missing:
        raise FormatError(
            f"{os.fspath(path)}: the table of participants has no column {' and '.join(missing)}; it needs file, "
            "participant and condition"
        )
    lengths = table.column("foot_length_mm"), table.column("foot_length_cm")
    out = [_participation(f"{os.fspath(path)}, line {line}", names, row, columns, lengths) for line, row in table.rows]
    counts = Counter(participation.file for participation in out)
    twice = next((file for file, count in counts.items() if count > 1), None)
    if twice is not None:
        raise FormatError(f"{os.fspath(path)}: {twice} is named twice")
    if not out:
        raise FormatError(f"{os.fspath(path)}: the table of participants has no rows")
    return out


def not_read(more: Mapping[str, str]) -> list[str]:
    """Returns a line for each of more columns that looks like one that is read.

    Example:
        >>> len(not_read({"age": "30", "mass_lb": "132"}))
        1
    """
    alike = {name: next((key for key, stems in _ALIKE.items() if re.fullmatch(stems, name)), None) for name in more}
    return [f"column {n!r} is not read, only carried along; allowed: {key!r}" for n, key in alike.items() if key]


def _participation(
    where: str, names: list[str], row: list[str], columns: Mapping[str, int], lengths: tuple[int | None, int | None]
) -> Participation:
    def text(key: str) -> str | None:
        at = columns.get(key)
        return (row[at].strip() or None) if at is not None and at < len(row) else None

    def value(key: str, allowed: tuple[float, float], at: int | None = None, factor: float = 1.0) -> float | None:
        words = text(key) if at is None else (row[at].strip() if at < len(row) else None)
        if not words:
            return None
        found = number(words)
        if found is None or not allowed[0] <= found * factor <= allowed[1]:
            low, high = (bound / factor for bound in allowed)
            name = key if at is None else names[at]
            raise InputError(f"{where}: {name} is {words!r}; allowed: {low:g} to {high:g}, or empty")
        return found * factor

    length = value("foot_length_m", FOOT_LENGTHS)
    for at, factor in zip(lengths, (1e-3, 1e-2), strict=True):
        if length is None and at is not None:
            length = value("foot_length_m", FOOT_LENGTHS, at, factor)
    side = text("side")
    if side is not None and side.lower() not in SIDES:
        raise InputError(f"{where}: side is {side!r}; allowed: left, right, or empty")
    file = row[columns["file"]] if columns["file"] < len(row) else ""  # a name may begin with a blank
    if not file.strip():
        raise InputError(f"{where}: names no file")
    used = set(columns.values()) | {at for at in lengths if at is not None}
    more = {re.sub(r"\W+", "_", names[i]): row[i].strip() for i in range(min(len(names), len(row))) if i not in used}
    return Participation(
        file=file,
        participant=text("participant") or os.path.splitext(os.path.basename(file))[0],
        condition=text("condition") or "",
        mass_kg=value("mass_kg", BODY_MASSES),
        foot_length_m=length,
        side=side.lower() if side else None,
        insole_size=text("insole_size"),
        unit=text("unit"),
        rate_hz=value("rate_hz", (0.1, 1e5)),
        layout=text("layout"),
        more={key: content for key, content in more.items() if key},
    )
