"""The kinds of ground: classes of this package's modules, and entry points of other packages (`plantar.terrain`)."""

from __future__ import annotations

import pkgutil
from functools import cache
from importlib import import_module
from pathlib import Path

from plantar.extensions import extensions
from plantar.sim.terrain.ground import Terrain

__all__ = ["terrain_kinds"]


@cache
def terrain_kinds() -> dict[str, type[Terrain]]:
    """Kinds of ground by their name in a scene: the class's in lower case; "flat", the default, comes first.

    A kind is a `Terrain` in a module of this folder or an entry point `plantar.terrain` of another package.

    Example:
        >>> list(terrain_kinds())[:3]
        ['flat', 'beam', 'block']
    """
    package = Path(__file__).parent
    modules = [import_module(f"{__package__}.{module.name}") for module in pkgutil.iter_modules([str(package)])]
    found = {
        name.lower(): kind
        for module in modules
        for name in module.__all__
        if isinstance(kind := getattr(module, name), type) and issubclass(kind, Terrain) and kind is not Terrain
    }
    return {"flat": found.pop("flat"), **found, **extensions("plantar.terrain", Terrain)}
