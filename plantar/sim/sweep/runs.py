"""The runs of a table and their keys."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

__all__ = ["Key", "Rows", "Run", "key_of", "settings_of"]

Key = tuple[tuple[str, ...], int]
"""Values of the axes, and the seed."""

Run = tuple[tuple[str, ...], int]
"""Settings "name=value" of the axes, and the seed."""

Rows = Mapping[Key, Mapping[str, str]]
"""Rows of the runs that ended."""


def settings_of(point: Sequence[str]) -> dict[str, str]:
    """Values of a point's settings "name=value" by name.

    Example:
        >>> settings_of(("friction=0.7", "lean=true"))
        {'friction': '0.7', 'lean': 'true'}
    """
    return {name: value for name, _, value in (setting.partition("=") for setting in point)}


def key_of(point: Sequence[str], seed: int) -> Key:
    """Returns the key of a run of a `point`, settings "name=value", with a `seed`.

    Example:
        >>> key_of(("friction=0.7",), 3)
        (('0.7',), 3)
    """
    return tuple(settings_of(point).values()), seed
