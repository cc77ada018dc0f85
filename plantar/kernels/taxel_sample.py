"""Kernel of one sample of taxels: what their electronics make of the forces on them."""

from __future__ import annotations

import numpy as np

__all__ = ["taxel_sample"]

_NONE = float("nan")


def taxel_sample(force, noise, least, most, dead):
    """What taxels read.

    Args:
        force: Force (n,) on each taxel in N.
        noise: What is added to it (n,) in N.
        least: Least force in N that they tell.
        most: Largest one.
        dead: Indices of taxels that tell nothing.

    Returns:
        Readings (n,) in N, NaN of a dead taxel.
    """
    out = np.empty(force.shape[0])
    _fill(force, noise, least, most, dead, out)
    return out


def _fill(force, noise, least, most, dead, out):
    """The readings into an array."""
    for i in range(force.shape[0]):
        value = force[i] + noise[i]
        if value < least:
            value = least
        elif value > most:
            value = most
        out[i] = value
    for i in range(dead.shape[0]):
        out[dead[i]] = _NONE
