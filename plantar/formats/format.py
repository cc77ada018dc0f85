"""What a recording format is: a name, how it is recognised, and how it is read."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from plantar.layout import SoleLayout
from plantar.pressure_recording import PressureRecording

__all__ = ["Format"]


@dataclass(frozen=True)
class Format:
    """One recording format.

    Attributes:
        name: Name for `--format`.
        title: What it is, in a few words.
        suffixes: File names usually end so; only for listing, files are recognised by their content.
        recognises: Tells from a file's first bytes whether it is of this format.
        read: Reads a file; takes its path and a sole layout to use instead of the format's own geometry, or None.
    """

    name: str
    title: str
    suffixes: tuple[str, ...]
    recognises: Callable[[bytes], bool]
    read: Callable[[Path, SoleLayout | None], PressureRecording]
