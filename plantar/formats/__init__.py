"""Formats of plantar pressure recordings, one a file. A new one is a module with a `FORMAT`, named in `_MODULES`."""

from __future__ import annotations

import os
from importlib import import_module
from pathlib import Path

from plantar.errors import FormatError
from plantar.formats.format import Format
from plantar.layout import SoleLayout
from plantar.pressure_recording import PressureRecording

__all__ = ["Format", "detect_format", "formats", "read_recording"]

_MODULES = ("mcap_recording", "novel_pedar")
_HEAD = 65536


def formats() -> dict[str, Format]:
    """All formats by name, in the order in which they are tried.

    Example:
        >>> sorted(formats())
        ['mcap', 'pedar']
    """
    found: list[Format] = [import_module(f"plantar.formats.{module}").FORMAT for module in _MODULES]
    return {f.name: f for f in found}


def detect_format(path: str | os.PathLike[str]) -> Format:
    """Recognise a file by its content.

    Args:
        path: The file.

    Returns:
        Its format.

    Raises:
        FormatError: If the file cannot be read, is empty, or is of no known format.
    """
    try:
        with open(path, "rb") as stream:
            head = stream.read(_HEAD)
    except OSError as error:
        raise FormatError(f"{path}: cannot be read ({error.strerror})") from None
    if not head:
        raise FormatError(f"{path}: the file is empty")
    known = formats()
    for candidate in known.values():
        if candidate.recognises(head):
            return candidate
    names = ", ".join(f"{f.name} ({f.title})" for f in known.values())
    raise FormatError(f"{path}: not a recording of a known format; known: {names}")


def read_recording(
    path: str | os.PathLike[str], format: str | None = None, layout: SoleLayout | None = None
) -> PressureRecording:
    """Read a recording of any known format.

    Args:
        path: The file.
        format: Name of its format; recognised from the content where None.
        layout: Sole layout to use instead of the format's own geometry; its mirror image serves the other foot.

    Returns:
        The recording, in SI units.

    Raises:
        FormatError: If the format's name is unknown, or the file is not of it.
    """
    known = formats()
    if format is not None and format not in known:
        raise FormatError(f"unknown format {format!r}; allowed: {', '.join(known)}")
    chosen = detect_format(path) if format is None else known[format]
    try:
        return chosen.read(Path(path), layout)
    except FormatError as error:
        text = str(error)
        raise FormatError(text if text.startswith(str(path)) else f"{path}: {text}") from None
