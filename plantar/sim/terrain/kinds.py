"""The kinds of ground: this package's, and entry points `plantar.terrain`."""

import pkgutil
from functools import cache
from importlib import import_module
from pathlib import Path

from plantar.common.extensions import extensions
from plantar.sim.terrain.ground import Terrain


@cache
def terrain_kinds() -> dict[str, type[Terrain]]:
    """Kinds of ground by lower-case class name; "flat", the default, first.

    Example:
        >>> list(terrain_kinds())[:3]
        ['flat', 'beam', 'block']
    """
    package = Path(__file__).parent
    modules = [import_module(f"{__package__}.{module.name}") for module in pkgutil.iter_modules([str(package)])]
    defined = [
        value
        for module in modules
        for _, value in sorted(vars(module).items())
        if isinstance(value, type) and value.__module__ == module.__name__
    ]
    found = {kind.__name__.lower(): kind for kind in defined if issubclass(kind, Terrain) and not _is_abstract(kind)}
    return {"flat": found.pop("flat"), **found, **extensions("plantar.terrain", Terrain, ("flat", *found))}


def _is_abstract(kind: type[Terrain]) -> bool:
    """Whether a class is what kinds share: it leaves a method to them."""
    return kind is Terrain or any(getattr(getattr(kind, name), "__isabstractmethod__", False) for name in dir(kind))
