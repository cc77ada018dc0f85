"""Unknown keys of tables."""

from collections.abc import Iterable
from difflib import get_close_matches

from plantar.errors import InputError, PlantarError


def refuse_unknown_keys(
    given: Iterable[str], allowed: Iterable[str], where: str, error: type[PlantarError] = InputError, note: str = ""
) -> None:
    """Refuse keys `given` in a table that are not among `allowed`.

    Raises `error` with `where` as the table's name, the nearest and the allowed keys, and a `note` on what they depend
    on, such as " with law 'dcm'".

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
