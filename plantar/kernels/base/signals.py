# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, initializedcheck=False
"""Interpreted counterpart of CPython's function that checks for signals such as Ctrl-C."""

__all__ = ["PyErr_CheckSignals"]


def PyErr_CheckSignals():
    """Does not do anything: the interpreter checks for signals by itself."""
    return 0
