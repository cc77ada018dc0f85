"""Force from which a sole's readings are a contact and not noise."""

import math
from functools import lru_cache
from statistics import NormalDist
from typing import NamedTuple

FALSE_CONTACTS = 1e-4
"""Share of a swing foot's samples that noise may make a contact: one in 40 s at 250 Hz. Chosen: the level of a cell
grows by half a sigma for a tenth of it."""

# derived: 0.01 to 6.5: from ten thousand cells to one; by 3 %, which changes the least of a flat minimum by a
# thousandth
_TILTS = tuple(0.01 * 1.03**k for k in range(220))


class ContactLevels(NamedTuple):
    """A sole is in contact above either, in N: `cell`, of its most loaded one; `sole`, of its positive forces' sum."""

    cell: float
    sole: float


def contact_levels(noise: float, cells: int) -> ContactLevels:
    """Levels that a sole in the air crosses in fewer than `FALSE_CONTACTS` of its samples, whatever its other readings.

    White noise of standard deviation sigma, read as it is or clipped at zero, and half of the share p for each level.
    One of n cells exceeds z sigma, with

        1 - P(z)^n = p / 2,

    P the normal distribution. The sum of the positive parts exceeds s sigma with at most p / 2 where

        s = min over t > 0 of (n ln(1/2 + exp(t^2 / 2) P(t)) + ln(2 / p)) / t    (Chernoff),

    for any n. A load on few cells crosses the first, one spread evenly the second.

    `noise`: sigma of a cell in N; `cells`: n. Returns levels in N; 0 without noise or cells: any force is a contact.

    Example:
        >>> [round(level, 1) for level in contact_levels(1.0, 42)]
        [4.7, 36.4]
    """
    if not (noise > 0.0 and cells > 0):
        return ContactLevels(0.0, 0.0)
    cell, sole = _in_sigma(cells)
    return ContactLevels(noise * cell, noise * sole)


@lru_cache(maxsize=64)
def _in_sigma(cells: int) -> tuple[float, float]:
    share = 0.5 * FALSE_CONTACTS
    cell = -NormalDist().inv_cdf(-math.expm1(math.log1p(-share) / cells))
    spare = -math.log(share)
    normal = NormalDist().cdf
    sole = min((cells * math.log(0.5 + math.exp(0.5 * t * t) * normal(t)) + spare) / t for t in _TILTS)
    return cell, sole
