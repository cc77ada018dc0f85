"""`key=value` settings: which table a key belongs to, and what its text means."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from difflib import get_close_matches
from typing import Any

from plantar.errors import SceneError
from plantar.files.structured_text import parse_toml

__all__ = ["owner_of", "split_setting", "value_of"]


def split_setting(setting: str) -> tuple[str, str]:
    """Key and text of a setting "key=value".

    Raises:
        SceneError: If it is not of that form.

    Example:
        >>> split_setting("walk.steps = 4")
        ('walk.steps', '4')
    """
    key, equals, text = setting.partition("=")
    if not equals or not key.strip():
        raise SceneError(f"setting {setting!r} is not of the form key=value")
    return key.strip(), text.strip()


def owner_of(key: str, text: str, *groups: Mapping[str, Sequence[str]]) -> tuple[str, str]:
    """Table and name of a setting's key.

    Args:
        key: "table.name", or the name alone where one table of the first group that has it is the only one.
        text: Its value, for messages.
        groups: Names of each table's settings; an earlier group goes before a later one.

    Returns:
        Table and name.

    Raises:
        SceneError: If there is no such key, or it could be more than one; the message names the nearest.

    Example:
        >>> owner_of("steps", "4", {"walk": ["steps"], "push": ["step"]})
        ('walk', 'steps')
    """
    section, dot, name = key.rpartition(".")
    for known in groups:
        owners = [s for s, names in known.items() if name in names and (not dot or s == section)]
        if len(owners) > 1:
            found = ", ".join(f"{s}.{name}" for s in owners)
            raise SceneError(f"setting '{key}={text}' could be more than one key; allowed: {found}")
        if owners:
            return owners[0], name
    every = {f"{s}.{n}": n for tables in groups for s, names in tables.items() for n in names}
    near = [full for full, n in every.items() if n == name] or get_close_matches(key, every, 3)
    near = near or [full for n in get_close_matches(name, every.values(), 3) for full in every if every[full] == n]
    hint = f"nearest: {', '.join(near[:3])}; " if near else ""
    # All names of all tables would be a screenful.
    tables = list(dict.fromkeys(s for tables in groups for s in tables))
    allowed = [f"{section}.{n}" for tables in groups for n in tables.get(section, ())] or [
        "robot",
        *(f"{s}.*" for s in tables),
    ]
    raise SceneError(
        f"setting '{key}={text}': no such key; {hint}`plantar list settings` lists all; allowed: {', '.join(allowed)}"
    )


def value_of(text: str) -> Any:
    """What a setting's text means in TOML; a bare word is a text.

    Example:
        >>> value_of("4"), value_of("left")
        (4, 'left')
    """
    try:
        return parse_toml(f"v = {text}")["v"]
    except ValueError:
        return text
