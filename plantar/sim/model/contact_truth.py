"""MuJoCo's own contacts of the feet, for skins and judges alone.

MjData is read after a step; wrenches are [fx, fy, fz, tx, ty, tz] BY the world ON the robot.
"""

import math
from collections.abc import Collection, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plantar.kernels.contacts.foot_contacts import FootContacts
from plantar.kernels.contacts.ground_reaction import GroundReaction
from plantar.kernels.geometry.hull import convex_hull
from plantar.mujoco.contacts import REACH, ContactReader

__all__ = [
    "REACH",
    "ContactReader",
    "ContactSet",
    "FootContacts",
    "GroundTruth",
    "contact_wrench_in_frame",
    "contact_wrench_in_world",
    "feet_contacts",
    "foot_contacts",
    "ground_truth",
    "support_polygon_of_contacts",
]


class ContactSet(NamedTuple):
    """The k contacts of one foot with everything else.

    `own_geoms`: geom ids (k,) of the foot; `other_geoms`, -1 for a flex; `positions` (k, 3) in the world in m; `forces`
    on the foot (k, 3) in the world in N; `torques` in N m; `distances`: gap (k,) in m, negative in penetration;
    `carries`: mask (k,): the solver may put a force there; False within `gap` only.
    """

    own_geoms: NDArray[np.int32]
    other_geoms: NDArray[np.int32]
    positions: NDArray[np.float64]
    forces: NDArray[np.float64]
    torques: NDArray[np.float64]
    distances: NDArray[np.float64]
    carries: NDArray[np.bool_]

    @property
    def size(self) -> int:
        return len(self.distances)


def _set_of(foot: FootContacts) -> ContactSet:
    k = foot.size
    ids = np.array(foot.ids[:k])
    vectors = np.array(foot.vectors[: 3 * k])
    return ContactSet(
        own_geoms=ids[:, 0],
        other_geoms=ids[:, 1],
        positions=vectors[::3],
        forces=vectors[1::3],
        torques=vectors[2::3],
        distances=np.array(foot.gaps[:k]),
        carries=np.array(foot.carries[:k]).view(np.bool_),
    )


class GroundTruth(NamedTuple):
    """What the ground does to all feet, world frame.

    `wrench` (6,) about the world's origin; `zmp`: True ZMP (2,) in m; None below the minimum force; `ring`: corners (x,
    y) in m of the true support polygon, counter-clockwise, or empty; `margin`: ZMP's distance in m to its edge,
    positive inside, or None; `points`: each foot's (x, y) in m that carry or could.
    """

    wrench: NDArray[np.float64]
    zmp: NDArray[np.float64] | None
    ring: list[tuple[float, float]]
    margin: float | None
    points: tuple[list[tuple[float, float]], ...] = ()

    @property
    def polygon(self) -> NDArray[np.float64]:
        """True support polygon (m, 2) in m."""
        return np.array(self.ring).reshape(-1, 2)


def foot_contacts(model: Any, data: Any, geom_ids: Collection[int]) -> ContactSet:
    """Returns one foot's `feet_contacts`, by its `geom_ids`, from `model` and `data`."""
    return feet_contacts(model, data, (geom_ids,))[0]


def feet_contacts(model: Any, data: Any, feet: Sequence[Collection[int]]) -> tuple[ContactSet, ...]:
    """Returns contacts and forces for each of `feet`, given by geom ids.

    MuJoCo's force acts on geom 2; where the foot is geom 1 the sign changes. Contacts within a foot are left out; one
    between feet belongs to both. `model` and `data` are MuJoCo's after a step.
    """
    return tuple(_set_of(foot) for foot in ContactReader(model, data, feet).read())


def contact_wrench_in_world(contacts: ContactSet, point: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the wrench (6,) in N, N m of `contacts` about a `point` (3,) in m, world axes."""
    moments = np.cross(contacts.positions - point, contacts.forces) + contacts.torques
    return np.concatenate([contacts.forces.sum(axis=0), moments.sum(axis=0)])


def contact_wrench_in_frame(
    contacts: ContactSet, position: NDArray[np.float64], rotation_to_world: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Returns the wrench (6,) in N, N m of `contacts` about `position` (3,) in m, along columns of `rotation_to_world`
    (3, 3) or (9,).
    """
    world = contact_wrench_in_world(contacts, position)
    return (world.reshape(2, 3) @ rotation_to_world.reshape(3, 3)).reshape(6)


def support_polygon_of_contacts(feet: Sequence[ContactSet], reach: float = REACH) -> NDArray[np.float64]:
    """Returns the true support polygon (m, 2) in m of all `feet`, counter-clockwise.

    The hull of points that carry or could, with a gap up to `reach` in m, as rubber stays pressed.
    """
    points: list[tuple[float, float]] = []
    for contacts in feet:
        if contacts.size:
            near = (contacts.carries | (contacts.distances <= reach)).tolist()
            points += [(x, y) for (x, y, _), n in zip(contacts.positions.tolist(), near, strict=True) if n]
    return np.asarray(convex_hull(np.array(points).reshape(-1, 2)))


def ground_truth(
    feet: Sequence[FootContacts], plane_height: float | None = None, minimum_force: float = 1.0, reach: float = REACH
) -> GroundTruth:
    """Wrench, ZMP, support polygon and margin of all feet together (T 4.5-4.8), in the world frame.

    `plane_height` of the ZMP in m; None: force-weighted contact height; `minimum_force`: vertical in N, below which
    there is no ZMP; `reach`: largest gap in m of a point that could carry.
    """
    height = math.nan if plane_height is None else plane_height
    reaction = GroundReaction(height, minimum_force, reach)
    reaction.update(feet)
    return GroundTruth(*reaction.found_now())
