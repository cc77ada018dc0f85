"""Records that one room hands to the next at each control tick: fields by name, cheap to make, not to be changed.

A tick makes some twenty. A named tuple takes 0.24 us, a frozen dataclass 0.7 to 0.9, this 0.06.
"""

from __future__ import annotations

from typing import Any, Self

import msgspec

__all__ = ["Record"]


class Record(msgspec.Struct, frozen=True):
    """Base class of records; each names `frozen=True` again, which type checkers go by.

    Unlike a tuple it has no order to be unpacked by.

    Example:
        >>> class Place(Record, frozen=True):
        ...     x: float
        ...     y: float = 0.0
        >>> Place(0.1)
        Place(x=0.1, y=0.0)
    """

    def changed(self, **fields: Any) -> Self:
        """A copy with other values in some fields.

        Args:
            fields: Their values by name.

        Raises:
            TypeError: If there is no field of that name.
        """
        return msgspec.structs.replace(self, **fields)
