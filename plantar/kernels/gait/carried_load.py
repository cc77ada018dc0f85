"""Kernel of what the taxels of a foot have carried since it touched down.

Plain Python that also compiles ahead of time (`carried_load.pxd` gives the C types).
"""

from __future__ import annotations

__all__ = ["mark_carried", "take_in"]

_INFINITE = float("inf")


def take_in(force, forgetting, share, total, mean):
    """Take a reading into the running sum and mean; a dead taxel is one without load. Exactly the formulas.

    Args:
        force: Normal forces (n,) in N; what is not finite counts as 0.
        forgetting: Share of the old in the running sum.
        share: Share of the new in the running mean.
        total: The running sum (n,) in N, which is changed.
        mean: The running mean (n,) in N, which is changed.
    """
    for i in range(force.shape[0]):
        new = force[i] if -_INFINITE < force[i] < _INFINITE else 0.0
        total[i] = forgetting * total[i] + new
        mean[i] = mean[i] + share * (new - mean[i])


def mark_carried(mean, near, least, beside, carried):
    """Mark the taxels whose running mean is above a force, and above a share of their strongest neighbour's.

    Args:
        mean: Running means (n,) in N.
        near: Numbers (n, k) of each taxel's neighbours, -1 where it has fewer.
        least: The force in N.
        beside: The share.
        carried: Mask (n,) of the taxels that have carried, to which those are added.
    """
    for i in range(mean.shape[0]):
        around = 0.0
        for j in range(near.shape[1]):
            if near[i, j] >= 0:
                around = max(around, mean[near[i, j]])
        if mean[i] > max(least, beside * around):
            carried[i] = True
