"""Type of a recording format: a name, how it is recognised, and how it is read."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from plantar.layouts.layout import Side, SoleLayout
from plantar.recordings.pressure_recording import PressureRecording

__all__ = ["Format", "ReadOptions"]


@dataclass(frozen=True)
class ReadOptions:
    """What is known about a file, used instead of its own statements.

    Attributes:
        layout: Sole layout; mirrored for the other foot.
        unit: Unit of the values, for example "kPa", "N" or "raw"; see `plantar.formats.units`.
        rate_hz: Frames a second.
        side: The foot of a file of one; of a pedar file of two insoles that it does not separate, of the first columns.
        insole_size: Size of a pedar insole, for example "x" or "vw"; see `plantar.formats.nominal_insole`.
        mass_kg: Mass of the body, which turns forces in body weights into N.
        plates: The foot of each force plate, in the file's order; None for a plate that is left out.
    """

    layout: SoleLayout | None = None
    unit: str | None = None
    rate_hz: float | None = None
    side: Side | None = None
    insole_size: str | None = None
    mass_kg: float | None = None
    plates: tuple[Side | None, ...] = ()


@dataclass(frozen=True)
class Format:
    """One recording format.

    Attributes:
        name: Name for `--format`.
        title: Description in a few words.
        suffixes: Usual ends of file names, only for listing.
        recognises: Whether a file's first bytes are of this format.
        read: Reads a file; None for footprint images, which are no recordings.
        folders: File that a folder of this format holds, where the format is a folder.
        order: Formats are tried in this order; those that recognise any table or text have a high one.
    """

    name: str
    title: str
    suffixes: tuple[str, ...]
    recognises: Callable[[bytes], bool]
    read: Callable[[Path, ReadOptions], PressureRecording] | None
    folders: str | None = None
    order: int = 50
