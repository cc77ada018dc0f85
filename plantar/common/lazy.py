"""Members computed at first use and kept; their arrays are read-only."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from plantar.kernels.base.member import Member

if TYPE_CHECKING:
    lazy = cached_property
else:

    class lazy(Member):
        """A `cached_property` that takes no lock, as Python 3.11's does at each first use, and is compiled: a cheap
        member costs a third of that.

        Arrays that are kept are read-only.

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

        def __init__(self, function):
            super().__init__(function)
            self.__doc__ = function.__doc__
