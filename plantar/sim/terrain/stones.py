"""Stones, one under each planned footprint: partial, uneven or bumpy."""

import math
from abc import abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import choice, fixed, number, whole
from plantar.common.settings.schema import share as share_of_body
from plantar.common.sides import SIDES
from plantar.errors import SceneError
from plantar.mechanics.rotation import rotation_from_angles
from plantar.sim.terrain.ground import Footprint, Ground, Motion, PlannedFeet, Solid, Terrain

_MARGIN = 0.433  # of the half length of the sole that a whole stone is larger than it, on each end: 54 mm of 250
_GAP = 0.002  # m between the stones of two lanes
_PARTS = ("rear", "front", "inner", "outer")


class Laid(Terrain):
    """Solids under footholds, over a floor.

    Attributes:
        depth: Floor below in m.
    """

    depth: float = share_of_body(0.25, "leg", 0.01, 10)

    def ground(self, feet: PlannedFeet, rng: np.random.Generator) -> Ground:
        solids: list[Solid] = []
        before: list[Footprint] = []
        for k, foot in enumerate([*(feet.standing[side] for side in SIDES), *feet.steps], -len(SIDES)):
            # Drawn in any case: what chance gives to one step does not depend on the steps before it.
            drawn = self._drawn(rng, foot) if k >= 0 else None
            if not any(same_place(foot, other) for other in before):
                solids += self._under(foot, k, feet, drawn)
            before.append(foot)
        return Ground(tuple(solids), self.height - self.depth, self.friction)

    def _drawn(self, rng: np.random.Generator, foot: Footprint) -> Any:
        """A step's random choices."""

    @abstractmethod
    def _under(self, foot: Footprint, k: int, feet: PlannedFeet, drawn: Any) -> Sequence[Solid]:
        """Solids under step `k`, below 0 of standing feet."""
        raise NotImplementedError


class Partial(Laid):
    """Stones, one of which carries only part of the sole.

    Attributes:
        step: Step (from 0) on the partial foothold.
        share: Carried share of the sole's rectangle.
        part: Carried part of the sole.
        rise: Its height in m above the others.
    """

    step: int = whole(2, "step", 0, 100000)
    share: float = number(0.5, "1", 0.02, 1)
    part: str = choice(*_PARTS)
    rise: float = number(0.0, "m", -0.1, 0.1)

    def _under(self, foot: Footprint, k: int, feet: PlannedFeet, drawn: Any) -> Sequence[Solid]:
        if self.step >= len(feet.steps):
            raise SceneError(f"terrain.step is {self.step}; allowed: 0 to {len(feet.steps) - 1}, the steps of the walk")
        if not same_place(foot, feet.steps[self.step]):
            return [stone_under(foot, feet, self.height, self.depth)]
        height = self.height + self.rise
        depth = self.depth + self.rise
        return [stone_under(feet.steps[self.step], feet, height, depth, self.share, self.part)]


class Stones(Laid):
    """Stones that carry random parts of soles; all at the first and last two.

    Attributes:
        share_min: Smallest carried share of the sole's rectangle.
        share_max: Largest share.
    """

    share_min: float = number(0.3, "1", 0.02, 1)
    share_max: float = number(1.0, "1", 0.02, 1)

    def _drawn(self, rng: np.random.Generator, foot: Footprint) -> Any:
        if self.share_min > self.share_max:
            raise SceneError(f"terrain.share_min is {self.share_min:g}; allowed: up to share_max, {self.share_max:g}")
        return float(rng.uniform(self.share_min, self.share_max)), _PARTS[int(rng.integers(len(_PARTS)))]

    def _under(self, foot: Footprint, k: int, feet: PlannedFeet, drawn: Any) -> Sequence[Solid]:
        whole = k < 0 or k >= len(feet.steps) - 2
        return [stone_under(foot, feet, self.height, self.depth, *(() if whole else drawn))]


class Uneven(Terrain):
    """Stones of random height; for steps in place they move while the foot is in the air.

    A footprint that overlaps the same foot's last has its height.

    Attributes:
        height_range: Largest in m from expected ground.
        slope_range: Largest in degrees, any direction, of fixed stones.
        gap: Free width in m between both feet's stones, as dead reckoning drifts sideways.
        depth: Floor below in m.
    """

    height_range: float = share_of_body(0.025, "leg", 0, 0.1)
    slope_range: float = number(0.0, "deg", 0, 20)
    gap: float = share_of_body(1 / 12, "leg", 0, 0.2)
    depth: float = share_of_body(0.25, "leg", 0.02, 10)

    def ground(self, feet: PlannedFeet, rng: np.random.Generator) -> Ground:
        solids = {
            side: [stone_under(feet.standing[side], feet, self.height, self.depth, gap=self.gap)] for side in SIDES
        }
        place = dict(feet.standing)
        height = dict.fromkeys(SIDES, 0.0)
        for foot in feet.steps:
            rise = float(rng.uniform(-1.0, 1.0)) * self.height_range
            pitch, roll = drawn_slope(rng, self.slope_range)
            if overlapping(foot, place[foot.side]) and not same_place(foot, place[foot.side]):
                rise = height[foot.side]
                pitch = 0.0
                roll = 0.0
            height[foot.side] = rise
            if same_place(foot, place[foot.side]):
                stone = solids[foot.side][-1]
                now = np.array([*stone.position[:2], self.height + rise - stone.size[2]])
                middle = foot.lift_off + 0.45 * (foot.touchdown - foot.lift_off)
                solids[foot.side][-1] = replace(stone, motions=(*stone.motions, Motion(middle, 0.0, now)))
            else:
                solids[foot.side].append(
                    stone_under(foot, feet, self.height + rise, self.depth + rise, pitch=pitch, roll=roll, gap=self.gap)
                )
            place[foot.side] = foot
        return Ground((*solids["left"], *solids["right"]), self.height - self.depth, self.friction)


class Pebbles(Laid):
    """Sloping stones with bumps; level under standing feet, the last two steps, and overlapping ones.

    Attributes:
        bump_min: Smallest height in m.
        bump_max: Largest height.
        bumps: Number on a stone.
        slope_range: Largest in degrees, any direction.
    """

    bump_min: float = share_of_body(1 / 120, "leg", 0, 0.05)
    bump_max: float = share_of_body(0.025, "leg", 0, 0.05)
    bump_radius: float = fixed(0.05, "leg")  # Radius in m of the sphere whose cap it is
    bumps: int = whole(8, "bumps", 0, 200)
    slope_range: float = number(8.0, "deg", 0, 20)

    def _drawn(self, rng: np.random.Generator, foot: Footprint) -> Any:
        if self.bump_min > self.bump_max:
            raise SceneError(f"terrain.bump_min is {self.bump_min:g} m; allowed: up to bump_max, {self.bump_max:g} m")
        slope = drawn_slope(rng, self.slope_range)
        places = rng.uniform(-1.0, 1.0, (self.bumps, 2)) * foot.half
        return slope, places, rng.uniform(self.bump_min, self.bump_max, self.bumps)

    def _under(self, foot: Footprint, k: int, feet: PlannedFeet, drawn: Any) -> Sequence[Solid]:
        level = [*feet.standing.values(), *feet.steps[-2:]]
        if any(foot.side == other.side and overlapping(foot, other) for other in level):
            return [stone_under(foot, feet, self.height, self.depth)]
        (pitch, roll), places, heights = drawn
        stone = stone_under(foot, feet, self.height, self.depth, pitch=pitch, roll=roll)
        return [stone, *self._bumps(stone, foot, places, heights)]

    def _bumps(
        self, stone: Solid, foot: Footprint, places: NDArray[np.float64], heights: NDArray[np.float64]
    ) -> Iterator[Solid]:
        normal = stone.rotation[:, 2]
        face = stone.position + stone.size[2] * normal
        for (along, across), height in zip(places.tolist(), heights.tolist(), strict=True):
            x, y = foot.place(along, across)
            z = face[2] - (normal[0] * (x - face[0]) + normal[1] * (y - face[1])) / normal[2]
            yield Solid(
                "sphere", (self.bump_radius, 0.0, 0.0), np.array([x, y, z]) + (height - self.bump_radius) * normal
            )


def drawn_slope(rng: np.random.Generator, largest: float) -> tuple[float, float]:
    """Returns pitch and roll in rad of a slope up to `largest` degrees, direction by `rng`."""
    size = math.radians(largest) * float(rng.uniform())
    way = float(rng.uniform(0.0, 2.0 * math.pi))
    return size * math.cos(way), size * math.sin(way)


def same_place(foot: Footprint, other: Footprint) -> bool:
    """Returns whether `foot` and `other`, of one foot, coincide to a millimetre."""
    return foot.side == other.side and bool(np.hypot(*(foot.center - other.center)) < 1e-3)


def overlapping(foot: Footprint, other: Footprint) -> bool:
    """Returns whether stones of `foot` and `other`, of one foot, overlap along the feet."""
    return bool(abs(_way(foot, other)[0]) < (1.0 + _MARGIN) * (foot.half[0] + other.half[0]))


def _way(foot: Footprint, other: Footprint) -> tuple[float, float]:
    """Forward and left in m from a footprint's centre to another's, along the first."""
    dx, dy = (other.center - foot.center).tolist()
    c = math.cos(foot.yaw)
    s = math.sin(foot.yaw)
    return c * dx + s * dy, c * dy - s * dx


def _lane(foot: Footprint, feet: PlannedFeet, gap: float) -> float:
    """Distance in m from a footprint's centre half way to the other foot's."""
    inward = -1.0 if foot.side == "left" else 1.0
    near = (o for o in (*feet.standing.values(), *feet.steps) if o.side != foot.side and overlapping(foot, o))
    nearest = min((inward * _way(foot, other)[1] for other in near), default=None)
    return foot.half[1] + _MARGIN * foot.half[0] if nearest is None else 0.5 * nearest - 0.5 * gap


def stone_under(
    foot: Footprint,
    feet: PlannedFeet,
    height: float,
    depth: float,
    share: float = 1.0,
    part: str = "rear",
    *,
    pitch: float = 0.0,
    roll: float = 0.0,
    gap: float = _GAP,
) -> Solid:
    """Returns a box that carries a footprint with a margin, or part of it.

    `height` of the upper face in m; `depth` of the box in m; `share`: carried share; `part`: "rear", "front", "inner"
    or "outer"; `pitch`: along the foot in rad; `roll` across it; `gap`: between both feet's boxes in m.
    """
    outward = 1.0 if foot.side == "left" else -1.0
    half_length, half_width = foot.half
    margin = _MARGIN * half_length
    rear = -half_length - margin
    front = half_length + margin
    inner = -min(_lane(foot, feet, gap), half_width + margin)
    outer = half_width + margin
    if share < 1.0:
        along = half_length * (2.0 * share - 1.0)
        across = half_width * (2.0 * share - 1.0)
        rear = -along if part == "front" else rear
        front = along if part == "rear" else front
        inner = -across if part == "outer" else inner
        outer = across if part == "inner" else outer
    center = foot.place(0.5 * (rear + front), outward * 0.5 * (inner + outer))
    rotation = rotation_from_angles(foot.yaw, pitch, roll)
    half = 0.5 * max(depth, 0.02)
    # A slope turns about the middle of the footprint, which keeps its height there.
    level = np.array([*center, height])
    pivot = np.array([*foot.center, height])
    upper = pivot + rotation @ rotation_from_angles(foot.yaw).T @ (level - pivot)
    return Solid("box", (0.5 * (front - rear), 0.5 * (outer - inner), half), upper - half * rotation[:, 2], rotation)
