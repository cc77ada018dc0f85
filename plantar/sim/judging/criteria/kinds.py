"""The kinds of criteria: this package's, and entry points `plantar.criteria`; and the table of a scene."""

import pkgutil
from collections.abc import Mapping
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

from plantar.common.extensions import extensions
from plantar.common.settings.unknown_keys import refuse_unknown_keys
from plantar.errors import SceneError
from plantar.sim.judging.criteria.criterion import Criterion

NO_OUTCOME = "none"
"""What `--set outcome=none` leaves of a scene's outcome: the criteria of every run alone."""


@cache
def criterion_kinds() -> dict[str, type[Criterion]]:
    """Kinds of criteria by name.

    Example:
        >>> "stood_on" in criterion_kinds()
        True
    """
    package = Path(__file__).parent
    found: dict[str, type[Criterion]] = {}
    for module in pkgutil.iter_modules([str(package)]):
        loaded = import_module(f"{__package__}.{module.name}")
        for value in vars(loaded).values():
            is_own = isinstance(value, type) and value.__module__ == loaded.__name__
            if is_own and issubclass(value, Criterion) and value is not Criterion:
                found[module.name] = value
    return {**found, **extensions("plantar.criteria", Criterion, tuple(found))}


def outcome_of(table: Any, where: str) -> dict[str, Criterion]:
    """Returns the criteria of a scene's `[outcome]` table by name; `where` names the scene in messages.

    Raises:
        SceneError: If a name or a setting is unknown or wrong.

    Example:
        >>> outcome_of({"soft_landings": {"largest": 0.4}}, "scene 'mine'")["soft_landings"].largest
        0.4
    """
    if table == NO_OUTCOME:
        return {}
    if not isinstance(table, Mapping):
        raise SceneError(f'{where}: outcome is {table!r}; allowed: a table, or "{NO_OUTCOME}"')
    kinds = criterion_kinds()
    refuse_unknown_keys(table, kinds, f"{where}: [outcome]", SceneError)
    return {
        name: kinds[name].from_table(settings, f"{where}: [outcome.{name}]", SceneError)
        for name, settings in table.items()
    }
