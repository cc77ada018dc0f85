"""Keys of tables that are unknown or hold no text, and names that none of a list has."""

import os
from collections.abc import Iterable, Mapping, Sequence
from difflib import get_close_matches
from pathlib import Path

from plantar.errors import InputError, PlantarError

_MOST_LISTED = 12  # names in a message that also has a near one


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


def builtin_or_file(
    name: str | os.PathLike[str], what: str, builtin: Mapping[str, Path], error: type[PlantarError]
) -> Path:
    """Returns the TOML file at a path or of a `builtin` name; raises `error`, with `what` it is, for none."""
    from plantar.common.arguments import instance  # numpy, which lists of names do not load

    path = Path(instance(name, str | os.PathLike, what, error))
    if path.suffix == ".toml":
        if not path.exists():
            raise error(f"{what} file {path} does not exist")
        return path
    if str(name) not in builtin:
        near = get_close_matches(str(name), builtin, 2)
        hint = f"did you mean {' or '.join(near)}? " if near else ""
        long = near and len(builtin) > _MOST_LISTED
        allowed = f"what plantar list {what}s lists" if long else ", ".join(builtin)
        raise error(f"unknown {what} '{name}'; {hint}allowed: {allowed}, or a {what} .toml file")
    return builtin[str(name)]
