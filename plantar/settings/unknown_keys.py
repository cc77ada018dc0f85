"""Keys of tables that are unknown or hold no text."""

from collections.abc import Iterable, Mapping, Sequence
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
            hint = nearest(str(key), known)
            raise error(f"{where} has an unknown key '{key}'; {hint}allowed{note}: {', '.join(known)}")


def refuse_other_than_texts(
    table: Mapping[str, object], keys: Iterable[str], where: str, error: type[PlantarError]
) -> None:
    """Raises `error` if one of `keys` in a `table` holds no text; `where` names it."""
    for key in keys:
        if not isinstance(table.get(key, ""), str):
            raise error(f"{where}: '{key}' is not a text")


def nearest(name: str, known: Sequence[str]) -> str:
    """Returns which of `known` an unknown `name` may mean, for a message; empty where none is near.

    Example:
        >>> nearest("heigth", ["height", "width"]), nearest("a", ["height"])
        ('nearest: height; ', '')
    """
    near = ", ".join(get_close_matches(name, known))
    return f"nearest: {near}; " if near else ""
