"""What a skin says at one instant, and the wrenches on links that follow from it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from wholebody.skin.patch import BodySkin

__all__ = ["LinkWrench", "SkinReading", "link_wrenches"]


@dataclass(frozen=True)
class SkinReading:
    """One reading of a `BodySkin`, in its order of taxels. A taxel that delivers nothing reads NaN, and is silent.

    Attributes:
        time: Time in s.
        force: Normal force (N,) on each taxel in N, 0 or more.
        distance: Distance (N,) to what each taxel sees in m; inf where nothing is in range.
        temperature: Temperature (N,) of each taxel in degC; None for a skin that does not measure it.
    """

    time: float
    force: NDArray[np.float64]
    distance: NDArray[np.float64]
    temperature: NDArray[np.float64] | None = None


class LinkWrench(NamedTuple):
    """What the active taxels of one link say together.

    Attributes:
        link: Name of the link.
        wrench: Wrench (6,) about the link's origin in the link's frame, exerted by the world on the robot.
        taxels: Their indices.
    """

    link: str
    wrench: NDArray[np.float64]
    taxels: NDArray[np.int64]


def link_wrenches(skin: BodySkin, signal: NDArray[np.float64], active: NDArray[np.bool_]) -> list[LinkWrench]:
    """Sum what active taxels feel, a wrench a link (T 3.16-3.18); links without any are left out (T 3.23-3.24).

    Args:
        skin: The skin.
        signal: Force (N,) along each taxel's z in N, measured or virtual.
        active: Mask (N,) of the taxels that count.

    Returns:
        A wrench for each link that has an active taxel, in the order of `skin.links`.
    """
    taxels = active.nonzero()[0]
    if not len(taxels):
        return []
    owners = skin.link_of[taxels]
    ends = [*((owners[1:] != owners[:-1]).nonzero()[0] + 1).tolist(), len(taxels)]
    found = []
    for begin, end in zip([0, *ends], ends, strict=False):
        own = taxels[begin:end]
        found.append(LinkWrench(skin.links[owners[begin]], signal[own] @ skin.unit_wrenches[own], own))
    return found
