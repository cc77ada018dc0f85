"""Compiled descriptor behind `plantar.common.lazy`."""

from . import memory

__all__ = ["Member", "close_all"]


class Member:
    """Calls a function at first use, and keeps the value in the instance's `__dict__`."""

    def __init__(self, function):
        self.function = function
        self.name = ""

    def __set_name__(self, owner, name):
        self.name = name

    def __get__(self, instance, owner):
        if instance is None:
            return self
        value = self.function(instance)
        if type(value) is not float:
            close_all(value)
        instance.__dict__[self.name] = value  # where Python looks first from then on
        return value


def close_all(value):
    """Close an array, and those in nested tuples, to writing."""
    if memory.is_array(value):
        memory.close(value)
    elif isinstance(value, tuple):
        for item in value:
            close_all(item)
