"""Units of pressure that recordings state."""

from __future__ import annotations

from collections.abc import Mapping

__all__ = ["PASCALS"]

PASCALS: Mapping[str, float] = {
    "kpa": 1e3,
    "n/cm2": 1e4,
    "mpa": 1e6,
    "hpa": 1e2,
    "pa": 1.0,
    "mmhg": 133.322,
    "psi": 6894.757,
    "bar": 1e5,
    "mbar": 1e2,
    "kg/cm2": 98066.5,
}
"""Pressure units by their lower-case name, in Pa."""
