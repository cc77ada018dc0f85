"""Units that recordings state: pressure in Pa, force in N, length in m, and raw counts, which stay what they are."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

__all__ = ["FORCES", "LENGTHS", "MOMENTS", "PASCALS", "RAW", "Unit", "find_unit", "plain"]

PASCALS: Mapping[str, float] = {
    "kpa": 1e3,
    "n/cm2": 1e4,
    "n/mm2": 1e6,
    "n/m2": 1.0,
    "mpa": 1e6,
    "hpa": 1e2,
    "pa": 1.0,
    "kilopascal": 1e3,
    "pascal": 1.0,
    "kn/m2": 1e3,
    "newton/cm2": 1e4,
    "mmhg": 133.322387415,
    "psi": 6894.757293168,
    "lb/in2": 6894.757293168,
    "lbf/in2": 6894.757293168,
    "bar": 1e5,
    "mbar": 1e2,
    "kg/cm2": 98066.5,
    "kgf/cm2": 98066.5,
    "g/cm2": 98.0665,
    "atm": 101325.0,
}
"""Pressure units by their plain lower-case name, in Pa."""

FORCES: Mapping[str, float] = {
    "n": 1.0,
    "newton": 1.0,
    "newtons": 1.0,
    "nt": 1.0,
    "kn": 1e3,
    "mn": 1e-3,
    "kgf": 9.80665,
    "kg": 9.80665,
    "g": 9.80665e-3,
    "gf": 9.80665e-3,
    "lb": 4.4482216152605,
    "lbf": 4.4482216152605,
    "lbs": 4.4482216152605,
}
"""Force units by their plain lower-case name, in N; a mass stands for its weight."""

LENGTHS: Mapping[str, float] = {
    "mm": 1e-3,
    "millimeters": 1e-3,
    "millimetres": 1e-3,
    "cm": 1e-2,
    "centimeters": 1e-2,
    "centimetres": 1e-2,
    "m": 1.0,
    "meters": 1.0,
    "metres": 1.0,
    "in": 0.0254,
    "inch": 0.0254,
    "inches": 0.0254,
}
"""Length units by their plain lower-case name, in m."""

_NAMES = ("n", "nt", "newton", "newtons")
MOMENTS: Mapping[str, float] = {
    f"{force}{sign}{name}": factor for name, factor in LENGTHS.items() for force in _NAMES for sign in ("", ".", "-")
}
"""Moment units by their plain lower-case name, in N m."""

RAW: tuple[str, ...] = ("raw", "counts", "count", "adc", "digital", "do", "bits")
"""Names of readings that were never calibrated."""


@dataclass(frozen=True)
class Unit:
    """What the numbers of a recording are.

    Attributes:
        kind: "pressure", "force" or "raw".
        factor: Pa or N for one of them; 1 for raw counts.
        name: As it was stated.
    """

    kind: Literal["pressure", "force", "raw"]
    factor: float
    name: str


def plain(text: str) -> str:
    """A unit's name in lower case, without brackets, blanks and raised digits."""
    out = text.strip().strip("[](){}'\"").replace("²", "2").replace("\ufffd", "2").replace("^", "").replace("*", "")
    return out.replace(" ", "").lower()


def find_unit(text: str) -> Unit | None:
    """What a stated unit means; None where it is not known.

    Args:
        text: The unit as a file or a user writes it.

    Returns:
        The unit. "mN" is read as millinewton and "MN" is refused: nothing here weighs so much.

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
