"""The foot of a recording of one sensor."""

from __future__ import annotations

import re

from plantar.errors import InputError
from plantar.layouts.layout import Side

__all__ = ["side_of", "sides_of_plates"]

_MARKS: dict[Side, re.Pattern[str]] = {
    "left": re.compile(r"left|links|gauche|izquierd|(?:(?<=[\W_\d])|^)(?:l|lf|lt)(?=[\W_\d]|$)", re.IGNORECASE),
    "right": re.compile(r"right|rechts|droit|derech|(?:(?<=[\W_\d])|^)(?:r|rf|rt)(?=[\W_\d]|$)", re.IGNORECASE),
}


def side_of(*texts: str) -> Side | None:
    """The foot that the first of some texts with a foot's name names; None without.

    Example:
        >>> side_of("HX210.11.31.M11-DFM-RF S0073"), side_of("walk_left.fsx"), side_of("walk", "left and right")
        ('right', 'left', None)
    """
    for text in texts:
        found = [side for side, mark in _MARKS.items() if mark.search(text)]
        if len(found) == 1:
            return found[0]
    return None


def sides_of_plates(text: str | None) -> tuple[Side | None, ...]:
    """The foot of each force plate (None: left out) of a text such as "L,R" or "left,-,right"; else InputError.

    Example:
        >>> sides_of_plates("L,-,right"), sides_of_plates(None)
        (('left', None, 'right'), ())
    """
    out: list[Side | None] = []
    for part in (text or "").split(",") if text else []:
        side = side_of(part.strip())
        if side is None and part.strip() not in ("-", "none"):
            raise InputError(f"--plates names {part.strip()!r}; allowed: L, R or -, one a plate, as in L,R")
        out.append(side)
    return tuple(out)
