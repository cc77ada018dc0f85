"""Units that recordings state: pressure, force, length, time, and unconverted raw counts."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

# N
_POUND = 4.4482216152605
_KILOGRAM = 9.80665
_PSI = 6894.757293168  # Pa


def _each(*named: tuple[str, float]) -> Mapping[str, float]:
    return {name: factor for names, factor in named for name in names.split()}


PASCALS = _each(
    ("pa pascal n/m2", 1.0),
    ("hpa mbar", 1e2),
    ("kpa kilopascal kn/m2 mn/mm2", 1e3),
    ("n/cm2 newton/cm2 ncm-2 n·cm-2", 1e4),
    ("bar", 1e5),
    ("mpa n/mm2", 1e6),
    ("mmhg torr", 133.322387415),
    ("psi lb/in2 lbf/in2", _PSI),
    ("kg/cm2 kgf/cm2 kp/cm2", 1e4 * _KILOGRAM),
    ("g/cm2 gf/cm2", 10.0 * _KILOGRAM),
    ("atm", 101325.0),
)
"""Pressure units by their plain lower-case name, in Pa."""

FORCES = _each(
    ("n newton newtons nt", 1.0),
    ("kn", 1e3),
    ("mn", 1e-3),
    ("dan", 10.0),
    ("kgf kg kp", _KILOGRAM),
    ("g gf", 1e-3 * _KILOGRAM),
    ("lb lbf lbs pound pounds", _POUND),
)
"""Force units by their plain lower-case name, in N; a mass means its weight."""

LENGTHS = _each(
    ("mm millimeters millimetres", 1e-3),
    ("cm centimeters centimetres", 1e-2),
    ("m meters metres", 1.0),
    ("in inch inches", 0.0254),
)
"""Length units by their plain lower-case name, in m."""

SECONDS = _each(
    ("s sec second", 1.0),
    ("ms msec millisec millisecond millis", 1e-3),
    ("us usec microsec microsecond micros", 1e-6),
    ("ns nsec", 1e-9),
    ("min minute", 60.0),
    ("h hour", 3600.0),
)
"""Time units by their lower-case name in the singular, in s."""

_NAMES = ("n", "nt", "newton", "newtons")
MOMENTS: Mapping[str, float] = {
    f"{force}{sign}{name}": factor for name, factor in LENGTHS.items() for force in _NAMES for sign in ("", ".", "-")
}
"""Moment units by their plain lower-case name, in N m."""

RAW = ("raw", "counts", "count", "adc", "digital", "do", "bits", "v", "mv", "uv", "volt", "volts")
"""Names of readings that were never calibrated."""


@dataclass(frozen=True)
class Unit:
    """Unit of a recording's numbers.

    `kind`: "pressure", "force" or "raw"; `factor`: pa or N of one; 1 for raw counts.
    """

    kind: Literal["pressure", "force", "raw"]
    factor: float
    name: str


def plain(text: str) -> str:
    """Unit name in lower case, without brackets, blanks and raised digits."""
    out = text.strip().strip("[](){}'\"").replace("²", "2").replace("\ufffd", "2").replace("^", "").replace("*", "")
    return out.replace(" ", "").lower()


def seconds_of_unit(unit: str) -> float:
    """Seconds of a lower-case unit of time; 0 of none."""
    return SECONDS.get(unit, SECONDS.get(unit[:-1], 0.0))


def find_unit(text: str) -> Unit | None:
    """Unit of a text, or None. "mN" is millinewton, "MN" is refused.

    Example:
        >>> find_unit("N/cm²")
        Unit(kind='pressure', factor=10000.0, name='N/cm²')
        >>> find_unit("Raw").kind, find_unit("parsec")
        ('raw', None)
    """
    name = plain(text)
    stated = text.strip()
    if name in PASCALS and not (name == "mpa" and stated.strip("[]() ").startswith("m")):  # millipascal: a misprint
        return Unit("pressure", PASCALS[name], stated)
    if name in FORCES and not stated.strip("[]() ").startswith("MN"):
        return Unit("force", FORCES[name], stated)
    return Unit("raw", 1.0, stated) if name in RAW else None
