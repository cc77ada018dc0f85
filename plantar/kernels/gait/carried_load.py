"""Loads that a foot's taxels have carried since touchdown."""

__all__ = ["mark_carried", "take_in"]

_INFINITE = float("inf")


def take_in(force, forgetting, share, total, mean):
    """Add a reading `force` (n,) in N to running sum and mean; not finite counts as 0.

    `forgetting`: share of old value in sum `total` (n,) in N; `share`: share of new value in `mean` (n,) in N.
    """
    for i in range(force.shape[0]):
        new = force[i] if -_INFINITE < force[i] < _INFINITE else 0.0
        total[i] = forgetting * total[i] + new
        mean[i] = mean[i] + share * (new - mean[i])


def mark_carried(mean, near, least, beside, carried):
    """Mark in `carried` (n,) taxels whose `mean` (n,) in N exceeds `least`, and a share `beside` of their strongest
    neighbour's; `near` (n, k), padded with -1.
    """
    for i in range(mean.shape[0]):
        around = 0.0
        for j in range(near.shape[1]):
            if near[i, j] >= 0:
                around = max(around, mean[near[i, j]])
        if mean[i] > max(least, beside * around):
            carried[i] = True
