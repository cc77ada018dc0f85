# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Interpreted counterpart of CPython's check for signals such as Ctrl-C."""

__all__ = ["PyErr_CheckSignals"]


def PyErr_CheckSignals():
    """No effect: the interpreter checks by itself."""
    return 0
