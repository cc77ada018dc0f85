"""Parts of other packages, from entry points such as `plantar.terrain`."""

from functools import cache
from importlib.metadata import entry_points
from typing import TypeVar

from plantar.common.console.ending import one_line
from plantar.errors import InputError

T = TypeVar("T")


@cache
def extensions(group: str, kind: type[T], taken: tuple[str, ...] = ()) -> dict[str, T]:
    """Returns parts of a group by names of their entry points. `group`: such as "plantar.terrain".

    Example:
        >>> extensions("plantar.no_such_group", object)
        {}
    """
    found: dict[str, T] = {}
    for entry in entry_points(group=group):
        if entry.name in (*taken, *found):
            raise InputError(f"entry point {entry.name} = {entry.value} of {group} has a taken name; rename it")
        try:
            part = entry.load()
        except Exception as error:
            raise InputError(f"entry point {entry.value} of {group} cannot be loaded: {one_line(error)}") from error
        if not (issubclass(part, kind) if isinstance(part, type) else isinstance(part, kind)):
            raise InputError(f"entry point {entry.value} of {group} is no {kind.__module__}.{kind.__name__}")
        found[entry.name] = part
    return found
