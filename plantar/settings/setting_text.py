"""Settings in words, and as JSON values."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping
from typing import Any

from plantar.settings.schema import Setting

__all__ = ["setting_rows", "setting_text"]


def setting_text(found: Mapping[str, Setting]) -> str:
    """Returns each setting's default, share, unit and range in a line, and below it its meaning.

    Args:
        found: Settings by their dotted names.

    Example:
        >>> stiffness = Setting("stiffness", "100", "N/m", "a number 1 to 500", "How stiff.")
        >>> print(setting_text({"spring.stiffness": stiffness}))
        spring.stiffness = 100 N/m  (a number 1 to 500)
            How stiff.
    """
    lines = []
    for full, told in found.items():
        unit = f" {told.unit}" if told.unit not in ("", "1") else ""
        share = f" = {told.share}" if told.share else ""
        lines.append(f"{full} = {told.default}{unit}{share}  ({told.allowed})")
        lines += [f"    {line}" for line in textwrap.wrap(told.meaning, 100)]
    return "\n".join(lines)


def setting_rows(found: Mapping[str, Setting]) -> list[dict[str, Any]]:
    """The settings by their dotted names as plain JSON values."""
    return [{**told._asdict(), "name": full} for full, told in found.items()]
