"""Members of an object that are computed when they are first asked for, and kept; arrays among them read-only."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

from plantar.arrays import read_only

__all__ = ["lazy"]

if TYPE_CHECKING:
    lazy = cached_property
else:

    class lazy(cached_property):
        """`cached_property` without the lock that Python 3.11 takes at each first use, half of a cheap member.

        What is kept is handed out again: an array, also one in a tuple, is closed to writing.

        Example:
            >>> class Squares:
            ...     @lazy
            ...     def first(self):
            ...         print("computed")
            ...         return [0, 1, 4]
            >>> squares = Squares()
            >>> squares.first is squares.first
            computed
            True
        """

        def __get__(self, instance: Any, owner: Any = None) -> Any:
            """Compute the member and keep it in the instance, which is where Python looks first from then on."""
            if instance is None:
                return self
            value = self.func(instance)
            if type(value) is not float:
                read_only(value)
            instance.__dict__[self.attrname] = value
            return value
