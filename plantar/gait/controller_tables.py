"""Controller settings by dotted names, such as `estimator.gravity`."""

from collections.abc import Mapping
from types import NoneType
from typing import Any, get_args, get_type_hints

from plantar.common.settings.body_scale import REFERENCE_BODY, BodyScale
from plantar.common.settings.part import Part
from plantar.common.settings.schema import Setting
from plantar.common.settings.unknown_keys import refuse_unknown_keys
from plantar.errors import InputError, PlantarError
from plantar.gait.balance.balance_laws import balance_laws
from plantar.gait.controller_settings import ControllerSettings
from plantar.gait.feet.swing_kinds import swing_kinds
from plantar.gait.propose.proposer_kind import proposer_kinds


def _parts() -> tuple[dict[str, tuple[type[Part], ...]], frozenset[str]]:
    """Classes of each table, and which can be None, by `ControllerSettings` field types."""
    found: dict[str, tuple[type[Part], ...]] = {}
    optional = set()
    for hint in get_type_hints(ControllerSettings).values():
        for kind in get_args(hint) or (hint,):
            if isinstance(kind, type) and issubclass(kind, Part) and kind.table:
                found[kind.table] = (*found.get(kind.table, ()), kind)
                if NoneType in get_args(hint):
                    optional.add(kind.table)
    own = {kind.table: (kind,) for kind in (*swing_kinds().values(), *proposer_kinds()) if kind.table}
    return found | {"balance": tuple(balance_laws().values())} | own, frozenset(optional)


_PARTS = _parts()

CONTROLLER_TABLES: Mapping[str, tuple[type[Part], ...]] = _PARTS[0]
"""Settings classes of each table; `balance` has one for each law."""

_CHOOSING: Mapping[str, tuple[Setting, ...]] = {
    "balance": (
        Setting(
            "law",
            "the robot's",
            "",
            ", ".join(balance_laws()),
            "Balance law; one that is not the robot's has default gains.",
        ),
    )
}
"""Settings that choose among a table's classes."""

OPTIONAL_PARTS: frozenset[str] = _PARTS[1]
"""Tables of parts that may be off."""


def controller_keys(table: str) -> tuple[str, ...]:
    """Settings that a table can hold, without those that scenes give.

    Example:
        >>> controller_keys("landing")[:6]
        ('contact_force', 'press_force', 'depth', 'speed', 'acceleration', 'reach')
    """
    kinds = CONTROLLER_TABLES[table]
    found = (name for kind in kinds for name in kind.names() if name not in kind.given_by)
    choosing = (setting.name for setting in _CHOOSING.get(table, ()))
    return tuple(dict.fromkeys((*choosing, *found)))


def controller_settings_described(table: str, body: BodyScale = REFERENCE_BODY) -> tuple[Setting, ...]:
    """Returns a table's settings; of two classes with one name, the first's.

    `body`: scales defaults that are shares into SI.
    """
    found = {setting.name: setting for setting in _CHOOSING.get(table, ())}
    for kind in CONTROLLER_TABLES[table]:
        for setting in kind.described(body):
            found.setdefault(setting.name, setting)
    return tuple(found[name] for name in controller_keys(table))


def check_controller_table(name: str, table: Any, where: str, error: type[PlantarError] = InputError) -> dict[str, Any]:
    """Check a table whatever runs with it. `table`: values by name. Returns a copy of the table."""
    if not isinstance(table, Mapping):
        raise error(f"{where} is not a table")
    for kind in CONTROLLER_TABLES[name]:
        for key in kind.given_by.keys() & table.keys():
            raise error(f"{where} '{key}' is given by '{kind.given_by[key]}'; leave it out here")
    refuse_unknown_keys(table, controller_keys(name), where, error)
    for kind in CONTROLLER_TABLES[name]:
        kind.from_table({k: v for k, v in table.items() if k in kind.names()}, where, error)
    return dict(table)
