# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""What the interpreted kernels call where the compiled ones call CPython's own function of this name.

Compiled code sees a signal, as that of Ctrl-C, only when it asks; the interpreter looks by itself.
"""

from __future__ import annotations

__all__ = ["PyErr_CheckSignals"]


def PyErr_CheckSignals():
    """Nothing: the interpreter looks for signals by itself."""
    return 0
