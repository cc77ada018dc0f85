"""Net wrench about a point of all that touches a body, or is about to (K 2-5).

A taxel counts if it measures force OR proximity (K 2, corrected: printed AND). Its pseudo-force is its force plus a
share of its proximity (K 3), which answers a push early.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from plantar.common.arrays import array
from plantar.common.settings.part import Part
from plantar.common.settings.schema import number, share
from plantar.errors import ReadingError
from plantar.sensing.body_skin import active_cells, pseudo_force
from plantar.sensing.link_skin import BodySkin, link_wrenches
from plantar.sensing.reading import Reading


class NetWrenchRules(Part, table="push_felt", needs={"control.push_estimate": ("skin",)}):
    """What counts as a push, with force thresholds.

    Attributes:
        near: theta_prox: share of range, from its end, that counts as near (K Table 1).
        proximity_force: w_prox: force in N of taxel at distance 0: 1 N in K Table 1, at 86 kg; 0 counts contact alone.
    """

    near: float = number(0.05, "1", 0, 1)  # nature: K Table 1
    proximity_force: float = share(0.00119, "weight", 0, 100)  # nature: K Table 1


class NetWrench(NamedTuple):
    """Wrench (6,) of all pushes about the point in world axes in N and N m, and the taxels' indices."""

    wrench: NDArray[np.float64]
    taxels: NDArray[np.int64]


def net_wrench(
    skin: BodySkin,
    reading: Reading,
    poses: Mapping[str, tuple[NDArray[np.float64], NDArray[np.float64]]],
    point: ArrayLike,
    rules: NetWrenchRules,
) -> NetWrench:
    """Sum the signals of all taxels (K 2-5, corrected).

    `reading`: one reading of it; NaN for a silent taxel; `poses`: origin (3,) in m and rotation (3, 3) to world of each
    measuring link; `point`: point (3,) in world in m for moments; in K the CoM.

    Returns wrench; zeros without a push; ReadingError: point not finite.

    Example:
        >>> from plantar.sensing.link_skin import SkinPatch
        >>> inward = np.array([[[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]])  # z into the body: back to front
        >>> skin = BodySkin([SkinPatch("back", "torso", np.array([[-0.1, 0.0, 0.3]]), inward, np.array([1e-3]))])
        >>> torso = {"torso": (np.array([0.0, 0.0, 1.0]), np.eye(3))}
        >>> pushed = Reading(0.0, np.array([40.0]), np.array([np.inf]))
        >>> net_wrench(skin, pushed, torso, [0.0, 0.0, 0.9], NetWrenchRules()).wrench.tolist()
        [-40.0, 0.0, 0.0, 0.0, -16.0, 0.0]
    """
    about = array(point, "point", (3,), ReadingError, finite=True)
    if reading.force.shape != (len(skin),) or reading.distance.shape != (len(skin),):
        raise ReadingError(
            f"reading has forces {reading.force.shape} and distances {reading.distance.shape}; the skin has "
            f"{len(skin)} taxels"
        )
    # 0 at the end of its range or beyond, 1 at contact; a patch that does not see has no range.
    seen = np.isfinite(reading.distance) & (skin.ranges > 0.0)
    near = np.zeros(len(skin))
    near[seen] = np.clip(1.0 - reading.distance[seen] / skin.ranges[seen], 0.0, 1.0)
    active = active_cells(reading.force - skin.thresholds, near, 0.0, rules.near)
    signal = pseudo_force(reading.force, near, 1.0, rules.proximity_force, active)
    force = np.zeros(3)
    moment = np.zeros(3)
    for link, wrench, _ in link_wrenches(skin, signal, active):
        if link not in poses:
            raise ReadingError(f"link '{link}' feels something and has no pose; given: {', '.join(poses) or 'none'}")
        origin, rotation = poses[link]
        push = rotation @ wrench[:3]
        force += push
        # np.cross takes longer than all the rest
        x, y, z = (origin - about).tolist()
        fx, fy, fz = push.tolist()
        moment += rotation @ wrench[3:] + (y * fz - z * fy, z * fx - x * fz, x * fy - y * fx)
    return NetWrench(np.concatenate([force, moment]), active.nonzero()[0])
