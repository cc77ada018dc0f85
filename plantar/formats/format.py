"""Type of a recording format: name, recognition and reading."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from plantar.common.sides import SIDES, Side
from plantar.errors import InputError
from plantar.layouts.layout import SoleLayout
from plantar.recordings.pressure_recording import RATES, PressureRecording


@dataclass(frozen=True)
class ReadOptions:
    """Known facts that replace a file's own statements.

    Attributes:
        layout: Sole layout; mirrored for the other foot.
        unit: Of the values, such as "kPa", "N" or "raw"; see `plantar.formats.units`.
        rate_hz: Frames a second.
        side: Foot of a one-foot file; of first columns in a pedar file of two unseparated insoles.
        insole_size: Of a pedar insole, such as "x" or "vw"; see `plantar.formats.nominal_insole`.
        mass_kg: Body mass, which turns forces in body weights into N.
        plates: Foot of each force plate in file order; None leaves a plate out.
        columns: Which columns of a table are what, such as "left=Fz1, right=Fz2, time=t", or as a mapping.
        calibrated: Whether counts of soles whose layout is calibrated become forces in N.

    Raises:
        InputError: If the rate, mass or side cannot be.
    """

    layout: SoleLayout | None = None
    unit: str | None = None
    rate_hz: float | None = None
    side: Side | None = None
    insole_size: str | None = None
    mass_kg: float | None = None
    plates: tuple[Side | None, ...] = ()
    columns: str | Mapping[str, str | int] | None = None
    calibrated: bool = True

    def __post_init__(self) -> None:
        if self.rate_hz is not None and not RATES[0] <= self.rate_hz <= RATES[1]:
            raise InputError(f"a rate of {self.rate_hz:g} Hz is not possible; allowed: {RATES[0]:g} to {RATES[1]:g}")
        if self.mass_kg is not None and not 0.0 < self.mass_kg < float("inf"):
            raise InputError(f"the mass is {self.mass_kg:g} kg; allowed: above 0")
        if self.side not in (None, *SIDES):
            raise InputError(f"the side is {self.side!r}; allowed: left, right")


@dataclass(frozen=True)
class Format:
    """One recording format.

    Attributes:
        name: Name for `--format`.
        title: Few words.
        suffixes: Usual file name ends, for listing.
        recognises: Whether first bytes are of this format.
        read: Reads a file; None for footprint images.
        folders: File in a folder of this format, if it is one.
        order: Trial order; high for those that recognise any table or text.
    """

    name: str
    title: str
    suffixes: tuple[str, ...]
    recognises: Callable[[bytes], bool]
    read: Callable[[Path, ReadOptions], PressureRecording] | None
    folders: str | None = None
    order: int = 50
