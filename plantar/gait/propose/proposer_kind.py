"""Proposers of other packages: their settings, and the entry points "plantar.proposers"."""

from collections.abc import Mapping
from functools import cache
from typing import Any

from plantar.common.extensions import extensions
from plantar.common.settings.part import Part
from plantar.common.settings.schema import switch
from plantar.common.sides import Side
from plantar.gait.propose.proposer import Proposer
from plantar.layouts.layout import SoleLayout


class ProposerKind(Part):
    """Settings of a proposer of another package, which runs where a scene or robot file sets `on` in its table.

    Attributes:
        on: Whether it proposes.

    Example:
        >>> class Further(ProposerKind, table="further"): ...
        >>> Further.needs
        {'further.on': (True,)}
    """

    on: bool = switch(False)

    def __init_subclass__(cls, table: str = "", **options: Any) -> None:
        super().__init_subclass__(table=table, needs={f"{table or cls.table}.on": (True,)}, **options)

    def begin(self, layouts: Mapping[Side, SoleLayout], period: float) -> Proposer:
        """Returns a proposer for one walk.

        Args:
            layouts: Of each side.
            period: Of control in s.
        """
        raise NotImplementedError


@cache
def proposer_kinds() -> tuple[type[ProposerKind], ...]:
    """Installed kinds.

    Example:
        >>> all(issubclass(kind, ProposerKind) for kind in proposer_kinds())
        True
    """
    return tuple(extensions("plantar.proposers", ProposerKind).values())
