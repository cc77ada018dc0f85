"""Immutable records, cheap to make at each tick.

A named tuple takes 0.24 us, a frozen dataclass 0.7 to 0.9, this 0.06.
"""

import inspect
from typing import Any, Self, TypeVar

import msgspec


class Record(msgspec.Struct, frozen=True):
    """Base class of records; each repeats `frozen=True` for type checkers.

    Example:
        >>> class Place(Record, frozen=True):
        ...     x: float
        ...     y: float = 0.0
        >>> Place(0.1)
        Place(x=0.1, y=0.0)
    """

    def changed(self, **fields: Any) -> Self:
        """Copy with other values of some fields; TypeError for an unknown one.

        Args:
            fields: Their values by name.
        """
        return msgspec.structs.replace(self, **fields)


_Class = TypeVar("_Class")


def constructed_by_kernel(cls: type[_Class]) -> type[_Class]:
    """Construct a class by its base kernel, with its own `__init__`'s signature.

    Example:
        >>> class Fields:
        ...     def __init__(self, time):
        ...         self.time = time
        >>> @constructed_by_kernel
        ... class Instant(Fields):
        ...     def __init__(self, time: float) -> None: ...
        >>> Instant(0.5).time, str(inspect.signature(Instant))
        (0.5, '(time: float) -> None')
    """
    signature = inspect.signature(vars(cls)["__init__"])
    parameters = list(signature.parameters.values())[1:]
    cls.__signature__ = signature.replace(parameters=parameters)  # type: ignore[attr-defined]
    del cls.__init__
    return cls
