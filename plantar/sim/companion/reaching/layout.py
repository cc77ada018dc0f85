"""Random layouts of obstacles between a tip and its goal."""

import math
from dataclasses import dataclass, field
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.mechanics.lip import GRAVITY
from plantar.sim.body_skin.surface import OBSTACLE_GROUP

KINDS = ("movable", "goal", "beside", "ring")
"""One where the goal is, also behind three on the way, of which one may be fixed (T Figures 24-27); a closed ring."""

_SPACING = 0.155  # m between the middles of neighbours in the bow, along it
_RING = 9  # posts about the goal, three of which, on the tip's side, can be moved


@dataclass(frozen=True)
class Post:
    """An upright cylinder.

    `place` (2,) at first in m; `radius` in m; `friction`: force in N below which it does not slide; 0 if fixed.
    """

    name: str
    place: NDArray[np.float64]
    radius: float
    friction: float = 0.0

    def distance(self, points: NDArray[np.float64], height: float, half: float) -> NDArray[np.float64]:
        """Returns distances (...) in m of `points` (..., 3), 0 inside; `height` and `half` as of `add_to`."""
        away = points - [*self.place, height]
        beside = np.hypot(away[..., 0], away[..., 1]) - self.radius
        return np.asarray(np.hypot(np.maximum(beside, 0.0), np.maximum(np.abs(away[..., 2]) - half, 0.0)))

    def add_to(self, spec: Any, height: float, half: float) -> None:
        """Add it to a `mujoco.MjSpec` `spec`, middle at `height`, half height `half`, in m."""
        body = spec.worldbody.add_body(name=self.name, pos=[*self.place, height])
        shape = body.add_geom(
            name=self.name,
            type=mujoco.mjtGeom.mjGEOM_CYLINDER,
            size=[self.radius, half, 0.0],
            group=OBSTACLE_GROUP,
            rgba=[0.85, 0.35, 0.3, 1.0],
        )
        if self.friction:
            shape.rgba = [0.35, 0.6, 0.85, 1.0]
            shape.mass = self.friction / (0.4 * GRAVITY)  # a coefficient of 0.4 on the table
            for i, axis in enumerate(np.eye(3)[:2]):
                body.add_joint(
                    name=f"{self.name}_{'xy'[i]}",
                    type=mujoco.mjtJoint.mjJNT_SLIDE,
                    axis=axis,
                    frictionloss=self.friction,
                    damping=[2.0, 0.0, 0.0],
                )


@dataclass(frozen=True)
class Layout:
    """A `goal` (2,) in m and the posts in its way."""

    kind: str
    goal: NDArray[np.float64]
    posts: list[Post] = field(default_factory=list)


def random_layout(
    rng: np.random.Generator,
    kind: str,
    tip: NDArray[np.float64],
    reach: tuple[tuple[float, float], tuple[float, float]],
    friction: tuple[float, float],
) -> Layout:
    """Returns a layout of a `kind` of `KINDS`, drawn by `rng`, whose fixed posts leave the straight way free.

    Three posts in a bow are a pocket in which a potential field has its minimum; an outer one is fixed in the third
    kind. `reach` has ranges of the goal's distance from the `tip` (2,) in m and its direction in rad, `friction` is the
    range of force in N that moves a post.
    """
    (near, far), (low, high) = reach
    length = rng.uniform(near, far)
    angle = rng.uniform(low, high)
    way = np.array([math.cos(angle), math.sin(angle)])
    side = np.array([-way[1], way[0]]) * rng.choice([-1.0, 1.0])
    goal = tip + length * way

    def post(number: int, along: float, beside: float, fixed: bool = False) -> Post:
        force = 0.0 if fixed else rng.uniform(*friction)
        name = f"{'fixed' if fixed else 'movable'}{number}"
        return Post(name, tip + along * way + beside * side, rng.uniform(0.055, 0.065), force)

    if kind == "ring":
        size = rng.uniform(0.225, 0.24)
        turns = 2.0 * math.pi / _RING * np.arange(_RING)
        places = [(length - size * math.cos(turn), size * math.sin(turn)) for turn in turns]
        return Layout(kind, goal, [post(i, *place, 1 < i < _RING - 1) for i, place in enumerate(places)])
    posts = [post(0, length + rng.uniform(-0.02, 0.02), rng.uniform(-0.02, 0.02))]
    if kind == "goal":
        return Layout(kind, goal, posts)
    middle = rng.uniform(0.5, 0.6) * length
    bow = rng.uniform(0.16, 0.22)
    for i, angle in enumerate((-_SPACING / bow, 0.0, _SPACING / bow), 1):
        along = middle - bow * (1.0 - math.cos(angle)) + rng.uniform(-0.005, 0.005)
        posts.append(post(i, along, bow * math.sin(angle) + rng.uniform(-0.005, 0.005), kind == "beside" and i == 3))
    return Layout(kind, goal, posts)
