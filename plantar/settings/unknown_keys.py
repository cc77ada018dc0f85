"""Unknown keys of tables."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

from plantar.errors import InputError, PlantarError

__all__ = ["refuse_unknown_keys"]


def refuse_unknown_keys(
    given: Iterable[str], allowed: Iterable[str], where: str, error: type[PlantarError] = InputError, note: str = ""
) -> None:
    """Refuse keys of a table that are not read.

    Args:
        given: The table's keys.
        allowed: Those that are read.
        where: Name of table, for the message.
        error: Class of the error.
        note: What the allowed keys depend on, such as " with law 'dcm'".

    Raises:
        PlantarError: If a key is unknown; the message names the nearest and the allowed ones.

    Example:
        >>> refuse_unknown_keys(["heigth"], ["height", "width"], "[terrain]")
        Traceback (most recent call last):
        plantar.errors.InputError: [terrain] has an unknown key 'heigth'; nearest: height; allowed: height, width
    """
    known = list(allowed)
    for key in given:
        if key not in known:
            near = ", ".join(get_close_matches(str(key), known))
            hint = f"nearest: {near}; " if near else ""
            raise error(f"{where} has an unknown key '{key}'; {hint}allowed{note}: {', '.join(known)}")
