"""Gymnasium's classes, or stand-ins that cannot be constructed."""

from typing import Any

from plantar.common.optional_library import need_libraries

__all__ = ["Env", "ObservationWrapper", "spaces"]


class _Missing:
    def __new__(cls, *_: Any, **__: Any) -> "_Missing":
        need_libraries("gym", "gymnasium")
        return super().__new__(cls)

    def __class_getitem__(cls, _: Any) -> type:
        return cls


try:
    from gymnasium import Env, ObservationWrapper, spaces
except ImportError:
    Env = _Missing
    ObservationWrapper = _Missing
    spaces = None
