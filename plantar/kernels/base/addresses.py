"""What interpreted kernels call where compiled ones use another library's memory (`addresses_in_c.pxd`)."""

from __future__ import annotations

import ctypes

__all__ = ["at"]


def at(address):
    """The float64 numbers from an address of memory on, in place."""
    return ctypes.cast(address, ctypes.POINTER(ctypes.c_double))
