"""Parts that other packages bring: what they name as entry points of a group, such as `plantar.terrain`."""

from __future__ import annotations

from functools import cache
from importlib.metadata import entry_points
from typing import TypeVar

from plantar.errors import InputError

__all__ = ["extensions"]

T = TypeVar("T")


@cache
def extensions(group: str, kind: type[T]) -> dict[str, T]:
    """The parts of a group.

    Args:
        group: The group, for example "plantar.terrain".
        kind: Class that each part has to be an instance of; a class that it has to extend where the parts are classes
            (`type[...]` is not needed: a part that is a class is compared as one).

    Returns:
        The parts by the names of their entry points; empty where no package brings one.

    Raises:
        InputError: If one cannot be loaded or is of another kind; the message names it.

    Example:
        >>> extensions("plantar.no_such_group", object)
        {}
    """
    found: dict[str, T] = {}
    for entry in entry_points(group=group):
        try:
            part = entry.load()
        except Exception as error:
            raise InputError(f"entry point {entry.value} of {group} cannot be loaded: {error}") from error
        if not (issubclass(part, kind) if isinstance(part, type) else isinstance(part, kind)):
            raise InputError(f"entry point {entry.value} of {group} is no {kind.__module__}.{kind.__name__}")
        found[entry.name] = part
    return found
