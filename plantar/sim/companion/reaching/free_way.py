"""Whether a tip can reach its goal without touching obstacles that are all known."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from plantar.sim.companion.reaching.layout import Post

# m: of the grid, and how far beyond start, goal and obstacles it reaches
_CELL = 0.01
_AROUND = 0.3
_UPRIGHT = 0.999  # of an axis, from which it counts as vertical


class Tip(NamedTuple):
    """A tip, and a ball inside of its link.

    `place` of the tip (3,) at first in m; `middle` of the ball (3,) at first in m; `radius` of the ball in m; `lifts`:
    whether it can leave its height.
    """

    place: NDArray[np.float64]
    middle: NDArray[np.float64]
    radius: float
    lifts: bool

    @classmethod
    def of(cls, model: Any, data: Any, link: str, point: NDArray[np.float64]) -> "Tip":
        """Returns the tip at a `point` (3,) of a `link` of `model` and `data`; its ball is 0 m without a capsule."""
        body = data.body(link)
        place = body.xpos + body.xmat.reshape(3, 3) @ point
        lifts = bool((np.abs(data.xaxis[:, 2]) < _UPRIGHT).any())
        shape = int(model.body(link).geomadr[0])
        if shape < 0 or model.geom_type[shape] != mujoco.mjtGeom.mjGEOM_CAPSULE:
            return cls(place, place, 0.0, lifts)
        radius, half, _ = model.geom_size[shape]
        axis = data.geom_xmat[shape].reshape(3, 3)[:, 2]
        origin = data.geom_xpos[shape]
        return cls(place, origin + np.clip((place - origin) @ axis, -half, half) * axis, float(radius), lifts)


def free_way(tip: Tip, goal: NDArray[np.float64], tolerance: float, posts: Sequence[Post], half: float) -> bool:
    """Returns whether the ball of `tip`, without its arm, can bring the tip within `tolerance` in m of its `goal` (3,)
    in m and touch none of `posts`, of `half` height in m, their middles at the tip's height.

    A cell counts as free if any place in it is: False is a proof for every arm that carries the ball.
    """
    free = 2 + tip.lifts
    ends = np.array([tip.place, goal, *([*post.place, tip.place[2]] for post in posts)])
    low = ends.min(axis=0) - _AROUND
    high = ends.max(axis=0) + _AROUND
    low[free:] = tip.middle[free:]
    high[free:] = tip.middle[free:]
    axes = [a + _CELL * np.arange(round((b - a) / _CELL) + 1) for a, b in zip(low, high, strict=True)]
    cells = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    within = 0.5 * _CELL * float(np.sqrt(free))
    apart = np.min([post.distance(cells, tip.place[2], half) for post in posts], axis=0)
    parts = ndimage.label(apart >= tip.radius - within, np.ones((3, 3, 3)))[0]
    first = parts[tuple(int(np.abs(axis - x).argmin()) for axis, x in zip(axes, tip.middle, strict=True))]
    arrived = float(np.linalg.norm(tip.place - tip.middle)) + tolerance + within
    there = parts[np.linalg.norm(cells - goal, axis=-1) <= arrived]
    return bool(first and (there == first).any())
