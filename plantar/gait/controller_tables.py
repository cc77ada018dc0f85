"""The controller's settings by their dotted names, such as `estimator.gravity`: tables of a robot file or a scene."""

from __future__ import annotations

from collections.abc import Mapping
from types import NoneType
from typing import Any, get_args, get_type_hints

from plantar.errors import InputError, PlantarError
from plantar.gait.controller_settings import ControllerSettings
from plantar.gait.feet.swing_kinds import swing_kinds
from plantar.settings.body_scale import REFERENCE_BODY, BodyScale
from plantar.settings.part import Part
from plantar.settings.schema import Setting
from plantar.settings.unknown_keys import refuse_unknown_keys

__all__ = [
    "CONTROLLER_TABLES",
    "OPTIONAL_PARTS",
    "check_controller_table",
    "controller_keys",
    "controller_settings_described",
]


def _parts() -> tuple[dict[str, tuple[type[Part], ...]], frozenset[str]]:
    """Classes of each table, and which of them may be None, by the types of the fields of `ControllerSettings`."""
    found: dict[str, tuple[type[Part], ...]] = {}
    optional = set()
    for hint in get_type_hints(ControllerSettings).values():
        for kind in get_args(hint) or (hint,):
            if isinstance(kind, type) and issubclass(kind, Part) and kind.table:
                found[kind.table] = (*found.get(kind.table, ()), kind)
                if NoneType in get_args(hint):
                    optional.add(kind.table)
    return found | {kind.table: (kind,) for kind in swing_kinds().values() if kind.table}, frozenset(optional)


_PARTS = _parts()

CONTROLLER_TABLES: Mapping[str, tuple[type[Part], ...]] = _PARTS[0]
"""Settings classes of each table; `balance` has one for each law."""

OPTIONAL_PARTS: frozenset[str] = _PARTS[1]
"""Tables of parts that may be off."""


def controller_keys(table: str) -> tuple[str, ...]:
    """Names of the settings that a table may hold, without those that a scene gives elsewhere.

    Args:
        table: A name of `CONTROLLER_TABLES`.

    Example:
        >>> controller_keys("landing")[:6]
        ('contact_force', 'press_force', 'depth', 'speed', 'acceleration', 'reach')
    """
    kinds = CONTROLLER_TABLES[table]
    return tuple(dict.fromkeys(name for kind in kinds for name in kind.names() if name not in kind.given_by))


def controller_settings_described(table: str, body: BodyScale = REFERENCE_BODY) -> tuple[Setting, ...]:
    """Returns the settings of a table; where two classes share a name, that of the first.

    Args:
        table: A name of `CONTROLLER_TABLES`.
        body: The body for which defaults that are shares of one are given in SI.
    """
    found: dict[str, Setting] = {}
    for kind in CONTROLLER_TABLES[table]:
        for setting in kind.described(body):
            found.setdefault(setting.name, setting)
    return tuple(found[name] for name in controller_keys(table))


def check_controller_table(name: str, table: Any, where: str, error: type[PlantarError] = InputError) -> dict[str, Any]:
    """Check a table of settings before it is known what is run with it.

    Args:
        name: A name of `CONTROLLER_TABLES`.
        table: Values by name.
        where: Name of the table, for messages.
        error: What is raised.

    Returns:
        A copy of the table.

    Raises:
        PlantarError: Of the class `error`: a key is unknown or a value not allowed; the message names it.
    """
    if not isinstance(table, Mapping):
        raise error(f"{where} is not a table")
    for kind in CONTROLLER_TABLES[name]:
        for key in kind.given_by.keys() & table.keys():
            raise error(f"{where} '{key}' is given by '{kind.given_by[key]}'; leave it out here")
    refuse_unknown_keys(table, controller_keys(name), where, error)
    for kind in CONTROLLER_TABLES[name]:
        kind.from_table({k: v for k, v in table.items() if k in kind.names()}, where, error)
    return dict(table)
