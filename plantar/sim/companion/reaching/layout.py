"""Random layouts of obstacles between a tip and its goal, each solvable by pushing."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from plantar.mechanics.lip import GRAVITY
from plantar.sim.body_skin.surface import OBSTACLE_GROUP

__all__ = ["KINDS", "Layout", "Post", "random_layout"]

KINDS = ("movable", "goal", "beside")
"""Movable things on the way, one where the goal is, and a fixed one next to movable ones (T Figures 24-27)."""

_SPACING = 0.155  # m between the middles of neighbours in the bow, along it


@dataclass(frozen=True)
class Post:
    """An upright cylinder.

    Attributes:
        name: Of its body and geom.
        place: (2,) at first in m.
        radius: In m.
        friction: Force in N below which it does not slide; 0 if fixed.
    """

    name: str
    place: NDArray[np.float64]
    radius: float
    friction: float = 0.0

    def add_to(self, spec: Any, height: float, half: float) -> None:
        """Add it to a `mujoco.MjSpec` `spec`, middle at `height`, half height `half`, in m."""
        body = spec.worldbody.add_body(name=self.name, pos=[*self.place, height])
        size = [self.radius, half, 0.0]
        shape = body.add_geom(name=self.name, type=mujoco.mjtGeom.mjGEOM_CYLINDER, size=size)
        shape.group, shape.rgba = OBSTACLE_GROUP, [0.85, 0.35, 0.3, 1.0]
        if self.friction:
            shape.rgba = [0.35, 0.6, 0.85, 1.0]
            shape.mass = self.friction / (0.4 * GRAVITY)  # a coefficient of 0.4 on the table
            for i, axis in enumerate(np.eye(3)[:2]):
                slide = body.add_joint(name=f"{self.name}_{'xy'[i]}", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=axis)
                slide.frictionloss = self.friction
                slide.damping = [2.0, 0.0, 0.0]


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
    """A layout whose fixed posts leave the straight way free.

    Three posts in a bow are a pocket in which a potential field has its minimum. An outer one is fixed in the second
    kind.

    Args:
        rng: Random numbers.
        kind: One of `KINDS`.
        tip: First place of tip (2,) in m.
        reach: Ranges of the goal's distance from tip in m, and direction in rad.
        friction: Range of force in N that moves a post.

    Returns:
        The layout.
    """
    (near, far), (low, high) = reach
    length, angle = rng.uniform(near, far), rng.uniform(low, high)
    way = np.array([math.cos(angle), math.sin(angle)])
    side = np.array([-way[1], way[0]]) * rng.choice([-1.0, 1.0])
    goal = tip + length * way

    def post(name: str, along: float, beside: float, fixed: bool = False) -> Post:
        force = 0.0 if fixed else rng.uniform(*friction)
        return Post(name, tip + along * way + beside * side, rng.uniform(0.055, 0.065), force)

    if kind == "goal":
        return Layout(kind, goal, [post("movable1", length + rng.uniform(-0.02, 0.02), rng.uniform(-0.02, 0.02))])
    middle, bow = rng.uniform(0.5, 0.65) * length, rng.uniform(0.16, 0.22)
    posts = []
    for i, angle in enumerate((-_SPACING / bow, 0.0, _SPACING / bow)):
        fixed = kind == "beside" and i == 2
        name = "fixed" if fixed else f"movable{i + 1}"
        along = middle - bow * (1.0 - math.cos(angle)) + rng.uniform(-0.005, 0.005)
        posts.append(post(name, along, bow * math.sin(angle) + rng.uniform(-0.005, 0.005), fixed))
    return Layout(kind, goal, posts)
