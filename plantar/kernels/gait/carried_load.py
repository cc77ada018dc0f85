"""Kernel of the loads that the taxels of a foot have carried since touchdown (C types: `carried_load.pxd`)."""

from __future__ import annotations

__all__ = ["mark_carried", "take_in"]

_INFINITE = float("inf")


def take_in(force, forgetting, share, total, mean):
    """Add a reading (n,) in N to the running `total` and `mean` (n,), in place; values that are not finite count as 0.

    Args:
        force: Normal forces (n,) in N.
        forgetting: Share of the old value in the running sum.
        share: Share of the new value in the running mean.
        total: The running sum (n,) in N.
        mean: The running mean (n,) in N.
    """
    for i in range(force.shape[0]):
        new = force[i] if -_INFINITE < force[i] < _INFINITE else 0.0
        total[i] = forgetting * total[i] + new
        mean[i] = mean[i] + share * (new - mean[i])


def mark_carried(mean, near, least, beside, carried):
    """Mark the taxels whose running mean is above a force, and above a share of their strongest neighbour's.

    Args:
        mean: Running means (n,) in N.
        near: Indices (n, k) of each taxel's neighbours, -1 where it has fewer.
        least: The force in N.
        beside: The share.
        carried: Mask (n,) of marked taxels, updated in place.
    """
    for i in range(mean.shape[0]):
        around = 0.0
        for j in range(near.shape[1]):
            if near[i, j] >= 0:
                around = max(around, mean[near[i, j]])
        if mean[i] > max(least, beside * around):
            carried[i] = True
