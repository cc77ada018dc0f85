"""Classes whose constructor is a kernel's: no Python runs where what is handed over comes as it should."""

from __future__ import annotations

import inspect
from typing import TypeVar

__all__ = ["constructed_by_kernel"]

_Class = TypeVar("_Class")


def constructed_by_kernel(cls: type[_Class]) -> type[_Class]:
    """Leave the construction to the kernel that a class inherits from, with the signature of its own `__init__`.

    Args:
        cls: The class; its `__init__` has parameters with types, and no body.

    Returns:
        The class.

    Example:
        >>> class Fields:
        ...     def __init__(self, time):
        ...         self.time = time
        >>> @constructed_by_kernel
        ... class Instant(Fields):
        ...     def __init__(self, time: float) -> None: ...
        >>> Instant(0.5).time, str(inspect.signature(Instant))
        (0.5, "(time: 'float') -> 'None'")
    """
    told = inspect.signature(vars(cls)["__init__"])
    parameters = list(told.parameters.values())[1:]
    cls.__signature__ = told.replace(parameters=parameters)  # type: ignore[attr-defined]
    del cls.__init__
    return cls
