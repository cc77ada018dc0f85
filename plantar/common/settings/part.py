"""Settings of a program part that files can switch on."""

from collections.abc import Mapping
from typing import Any, ClassVar

from plantar.common.settings.schema import Settings


class Part(Settings):
    """Settings of a part: a robot file's or scene's table.

    Attributes:
        table: Name of the table.
        needs: Values of settings by dotted name with which the part runs.
        given_by: Names by which a scene sets some of its settings instead.

    Example:
        >>> class Sway(Part, table="sway", needs={"control.feedback": (True,), "control.feel": ("skin", "soles")}):
        ...     gain: float = 1.0
        >>> Sway.unmet({"control.feedback": True, "control.feel": "off"}.__getitem__)
        "control.feedback = true and control.feel = 'skin' or 'soles'"
    """

    table: ClassVar[str] = ""
    needs: ClassVar[Mapping[str, tuple[str | bool, ...]]] = {}
    given_by: ClassVar[Mapping[str, str]] = {}

    def __init_subclass__(
        cls,
        table: str = "",
        needs: Mapping[str, tuple[str | bool, ...]] | None = None,
        given_by: Mapping[str, str] | None = None,
        **options: Any,
    ) -> None:
        super().__init_subclass__(**options)
        cls.table = table or cls.table
        cls.needs = cls.needs if needs is None else needs
        cls.given_by = cls.given_by if given_by is None else given_by

    @classmethod
    def unmet(cls, value_of: Any) -> str | None:
        """Unmet needs of the part as a text, None if it runs, by a function from a dotted name to a setting's value."""
        if all(value_of(name) in values for name, values in cls.needs.items()):
            return None
        return " and ".join(f"{name} = {' or '.join(map(_shown, values))}" for name, values in cls.needs.items())


def _shown(value: str | bool) -> str:
    return repr(value) if isinstance(value, str) else str(value).lower()
