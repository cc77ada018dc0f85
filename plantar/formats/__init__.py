"""Formats of plantar pressure recordings: modules here with a `FORMAT`, and entry points "plantar.formats"."""

import os
from dataclasses import replace
from functools import cache
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules

from plantar.common.arguments import instance
from plantar.common.console.ending import one_line
from plantar.common.extensions import extensions
from plantar.common.files.input_file import check_input, is_file, open_input
from plantar.errors import FormatError, InputError, PlantarError
from plantar.formats.counts import in_newtons
from plantar.formats.format import Format, ReadOptions
from plantar.formats.plausibility import checked
from plantar.formats.table_text import head_of_table
from plantar.formats.text import head_text
from plantar.formats.units import find_unit
from plantar.formats.without_loads import refuse_without_loads
from plantar.layouts.layout import SoleLayout
from plantar.recordings.pressure_recording import PressureRecording

__all__ = ["Format", "ReadOptions", "detect_format", "formats", "is_study_folder", "named_format", "read_recording"]

# How many bytes of a file are looked at, and how many where those do not decide: a platform's table has a row of
# names of a hundred kilobytes.
_HEADS = (1 << 16, 1 << 22)
# Makers of exports without a public description: a table of theirs may be anything
_UNDESCRIBED = ("GAITRite", "zebris")
_PACKED = (b"PK\x03\x04", b"\x1f\x8b", b"BZh", b"\xfd7zXZ", b"7z\xbc\xaf", b"(\xb5/\xfd")  # ZIP to zst


def formats() -> dict[str, Format]:
    """All formats by name, in trial order; InputError if an entry point is no format.

    Example:
        >>> list(formats())[:4]
        ['mcap', 'pedar', 'emed', 'tekscan']
    """
    return _formats()


@cache
def _formats() -> dict[str, Format]:
    modules = (import_module(f"{__name__}.{module.name}") for module in iter_modules(__path__))
    found = [f for module in modules if isinstance(f := getattr(module, "FORMAT", None), Format)]
    others = extensions("plantar.formats", Format, tuple(f.name for f in found))
    found += [replace(f, name=name) for name, f in others.items()]
    return {f.name: f for f in sorted(found, key=lambda f: f.order)}


def named_format(path: str | os.PathLike[str], name: str | None = None) -> Format:
    """Returns format of a name, or of the content of the file at path if name is None; else FormatError."""
    known = formats()
    if name is not None and name not in known:
        raise FormatError(f"unknown format {name!r}; allowed: {', '.join(known)}")
    return detect_format(path) if name is None else known[name]


def is_study_folder(path: str | os.PathLike[str]) -> bool:
    """Whether a path is a folder of recordings that no format claims."""
    held = (f.folders for f in formats().values() if f.folders is not None)
    return os.path.isdir(path) and not any(is_file(Path(path) / name) for name in held)


def detect_format(path: str | os.PathLike[str]) -> Format:
    """Recognise a file or recording folder by content; FormatError if unknown."""
    known = formats()
    names = ", ".join(f"{f.name} ({f.title})" for f in known.values())
    if os.path.isdir(instance(path, str | os.PathLike, "recording", FormatError)):
        for candidate in known.values():
            if candidate.folders is not None and is_file(Path(path) / candidate.folders):
                return candidate
        raise FormatError(f"{path}: cannot be read (a folder that is no ROS 2 bag); known: {names}")
    with open_input(path, FormatError) as stream:
        head = b""
        for size in _HEADS:
            more = stream.read(size - len(head))
            if not head + more:
                raise FormatError(f"{path}: the file is empty")
            if not more:
                break
            head += more
            refuse_without_loads(path, head)
            maker = next((m for m in _UNDESCRIBED if m.lower().encode() in head.lower()), None)
            for candidate in known.values():
                if candidate.recognises(head) and not (maker and candidate.name == "csv"):
                    return candidate
            if maker:
                raise FormatError(
                    f"{path}: an export of {maker}, whose format has no public description; allowed: a table of forces "
                    "or pressures with named columns (--format csv reads this file as one)"
                )
    if head.startswith(_PACKED):
        sheet = "an Excel workbook (.xlsx); allowed: its sheet saved as CSV (a report of steps: --events)"
        raise FormatError(f"{path}: {sheet if b'xl/' in head else 'packed; allowed: what it holds, unpacked'}")
    if head_of_table(head_text(head[: _HEADS[0]]).splitlines()[:-1]) is not None:
        raise FormatError(
            f"{path}: a table, below other text, whose columns no name shows as loads; allowed: a row of names such as "
            "Left Fz [N], or --format csv, which prints the map of columns to fill in"
        )
    raise FormatError(f"{path}: not a recording of a known format; known: {names}")


def read_recording(
    path: str | os.PathLike[str],
    format: str | None = None,
    layout: SoleLayout | None = None,
    *,
    options: ReadOptions | None = None,
) -> PressureRecording:
    """Read a recording of any known format.

    Args:
        path: File.
        format: Its name; by content where None.
        layout: Sole layout; mirrored for the other foot.
        options: What else is known.

    Returns:
        Recording in SI units, or in stated counts.

    Raises:
        FormatError: If unknown or mismatched.
        InputError: If an option is invalid.
    """
    chosen = named_format(path, format)
    known = options or ReadOptions()
    known = known if layout is None else replace(known, layout=instance(layout, SoleLayout, "layout"))
    if known.unit is not None and find_unit(known.unit) is None:
        raise InputError(f"unknown unit {known.unit!r}; allowed: kPa, N/cm2, mmHg, psi, N, kg, raw and their like")
    if known.insole_size is not None:
        known = replace(known, insole_size=_insole_size(known.insole_size, chosen.name))
    if chosen.read is None:
        check_input(path, FormatError)
        raise FormatError(f"{path}: a footprint image is no recording over time")
    try:
        found = chosen.read(Path(path), known)
        found = checked(in_newtons(found) if known.calibrated else found)
        if known.plates and found.kind != "plate":
            raise InputError(f"--plates is for force plates; {path} is a recording of kind {found.kind}")
        if known.columns is not None and found.format != "csv":
            raise InputError(f"--columns is for tables; {path} is a {chosen.name} file, whose columns are known")
        return found
    except FormatError as error:
        text = str(error)
        raise FormatError(text if text.startswith(str(path)) else f"{path}: {text}") from None
    except MemoryError:
        raise FormatError(f"{path}: the file asks for more memory than there is") from None
    except PlantarError:
        raise
    except Exception as error:  # what a damaged file made of a reader; the cause is kept for the developer
        text = one_line(error)[:200]
        raise FormatError(
            f"{path}: not a file that can be read as {chosen.name} ({type(error).__name__}: {text})"
        ) from error


def _insole_size(size: str, format: str) -> str:
    from plantar.formats.nominal_insole import CELL_AREAS

    if format != "pedar":
        raise InputError(f"--insole-size is for pedar recordings; the file is {format}")
    if size.lower() not in CELL_AREAS:
        raise InputError(f"unknown insole size {size!r}; allowed: {', '.join(CELL_AREAS)}")
    return size.lower()
