"""Interpreted counterpart of `addresses_in_c.pxd`: memory of another library."""

import ctypes

__all__ = ["at"]


def at(address):
    """Float64 numbers from a memory address on, in place."""
    return ctypes.cast(address, ctypes.POINTER(ctypes.c_double))
