"""What a recording format is: a name, how it is recognised, and how it is read."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from plantar.layouts.layout import Side, SoleLayout
from plantar.recordings.pressure_recording import PressureRecording

__all__ = ["Format", "ReadOptions"]


@dataclass(frozen=True)
class ReadOptions:
    """What the user knows about a file and the file may not say. What is given here is used instead of the file's word.

    Attributes:
        layout: Sole layout to use instead of the format's own geometry; mirrored for the other foot.
        unit: Unit of the values, for example "kPa", "N" or "raw"; see `plantar.formats.units`.
        rate_hz: Frames a second.
        side: Which foot the file holds, where it holds one; of a pedar file of two insoles that it does not separate,
            whose the first columns are.
        insole_size: Size of a pedar insole, for example "x" or "vw"; see `plantar.formats.nominal_insole`.
        mass_kg: Mass of the body, which turns forces in body weights into N.
        plates: Which foot steps on each force plate, in the file's order; None for a plate that is left out. Empty
            where the data decides.
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
        title: What it is, in a few words.
        suffixes: File names usually end so; only for listing, files are recognised by their content.
        recognises: Tells from a file's first bytes whether it is of this format.
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
