"""`key=value` settings: a key's table, and its text's meaning."""

import textwrap
from collections.abc import Iterable, Mapping, Sequence
from difflib import get_close_matches
from typing import Any

from plantar.common.files.structured_text import parse_toml
from plantar.common.settings.schema import Setting
from plantar.errors import SceneError


def split_setting(setting: str) -> tuple[str, str]:
    """Key and text of a setting "key=value"."""
    key, equals, text = str(setting).partition("=")
    if not equals or not key.strip():
        raise SceneError(f"setting {setting!r} is not of the form key=value, such as steps=4")
    return key.strip(), text.strip()


def owner_of(key: str, text: str, *groups: Mapping[str, Sequence[str]]) -> tuple[str, str]:
    """Table and name of a setting's key.

    `key`: "table.name", or the name alone if only one table of the first group with it has it.

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


def put_settings(
    tables: dict[str, Any],
    settings: Iterable[tuple[str, str]],
    own: Mapping[str, str],
    *groups: Mapping[str, Sequence[str]],
) -> None:
    """Put `settings` of `split_setting` into a scene's `tables`; `own` are fields outside of them, `groups` as of
    `owner_of`.
    """
    for key, text in settings:
        if key in own:
            tables[own[key]] = text
            continue
        owner, name = owner_of(key, text, *groups)
        table = tables.setdefault(owner, {})
        if not isinstance(table, dict):
            raise SceneError(f"scene section '{owner}' is not a table")
        table[name] = value_of(text)


def value_of(text: str) -> Any:
    """A setting's text as TOML; a bare word is a text."""
    try:
        return parse_toml(f"v = {text}")["v"]
    except ValueError:
        return text


def setting_text(found: Mapping[str, Setting]) -> str:
    """Each setting's default, share, unit and range in a line, then its meaning; settings by dotted names."""
    lines = []
    for full, told in found.items():
        unit = f" {told.unit}" if told.unit not in ("", "1") else ""
        share = f" = {told.share}" if told.share else ""
        lines.append(f"{full} = {told.default}{unit}{share}  ({told.allowed})")
        lines += [f"    {line}" for line in textwrap.wrap(told.meaning, 100)]
    return "\n".join(lines)


def setting_rows(found: Mapping[str, Setting]) -> list[dict[str, Any]]:
    """Settings by dotted names as plain JSON values."""
    return [{**told._asdict(), "name": full} for full, told in found.items()]
