"""Stones, one under each planned footprint: partial, uneven or bumpy."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from plantar.errors import SceneError
from plantar.mechanics.rotation import rotation_from_angles
from plantar.settings.schema import choice, number, whole
from plantar.settings.schema import share as share_of_body
from plantar.sides import SIDES
from plantar.sim.terrain.ground import Footprint, Ground, Motion, PlannedFeet, Solid, Terrain

__all__ = ["Partial", "Pebbles", "Stones", "Uneven", "drawn_slope", "overlapping", "same_place", "stone_under"]

_MARGIN = 0.433  # of the half length of the sole that a whole stone is larger than it, on each end: 50 mm of 231
_GAP = 0.002  # m between the stones of two lanes
_PARTS = ("rear", "front", "inner", "outer")


class Partial(Terrain):
    """Stones, one of which carries only part of the sole.

    Attributes:
        step: Step (from 0) on the partial foothold.
        share: Carried share of the sole's rectangle.
        part: Carried part of the sole.
        rise: Its height in m above the others.
        depth: Floor below in m.
    """

    step: int = whole(2, "step", 0, 100000)
    share: float = number(0.5, "1", 0.02, 1)
    part: str = choice(*_PARTS)
    rise: float = number(0.0, "m", -0.1, 0.1)
    depth: float = share_of_body(0.25, "leg", 0.01, 10)

    def _laid_out(self, feet: PlannedFeet, rng: np.random.Generator) -> Ground:
        if self.step >= len(feet.steps):
            raise SceneError(f"terrain.step is {self.step}; allowed: 0 to {len(feet.steps) - 1}, the steps of the walk")
        prints = _distinct(feet)
        partial = feet.steps[self.step]
        solids = [stone_under(foot, feet, self.height, self.depth) for foot in prints if not same_place(foot, partial)]
        height, depth = self.height + self.rise, self.depth + self.rise
        solids.append(stone_under(partial, feet, height, depth, self.share, self.part))
        return Ground(tuple(solids), self.height - self.depth, self.friction)


class Stones(Terrain):
    """Stones that carry random parts of soles; all at the first and last two.

    Attributes:
        share_min: Smallest carried share of the sole's rectangle.
        share_max: Largest share.
        depth: Floor below in m.
    """

    share_min: float = number(0.3, "1", 0.02, 1)
    share_max: float = number(1.0, "1", 0.02, 1)
    depth: float = share_of_body(0.25, "leg", 0.01, 10)

    def _laid_out(self, feet: PlannedFeet, rng: np.random.Generator) -> Ground:
        if self.share_min > self.share_max:
            raise SceneError(f"terrain.share_min is {self.share_min:g}; allowed: up to share_max, {self.share_max:g}")
        solids = [stone_under(feet.standing[side], feet, self.height, self.depth) for side in SIDES]
        for k, foot in enumerate(feet.steps):
            share = float(rng.uniform(self.share_min, self.share_max))
            part = _PARTS[int(rng.integers(len(_PARTS)))]
            if k >= len(feet.steps) - 2:
                share = 1.0
            if any(same_place(foot, other) for other in [*feet.standing.values(), *feet.steps[:k]]):
                continue
            solids.append(stone_under(foot, feet, self.height, self.depth, share, part))
        return Ground(tuple(solids), self.height - self.depth, self.friction)


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

    def _laid_out(self, feet: PlannedFeet, rng: np.random.Generator) -> Ground:
        standing = feet.standing
        solids = {side: [stone_under(standing[side], feet, self.height, self.depth, gap=self.gap)] for side in SIDES}
        place, height = dict(feet.standing), dict.fromkeys(SIDES, 0.0)
        for foot in feet.steps:
            rise = float(rng.uniform(-1.0, 1.0)) * self.height_range
            pitch, roll = drawn_slope(rng, self.slope_range)
            if overlapping(foot, place[foot.side]) and not same_place(foot, place[foot.side]):
                rise, pitch, roll = height[foot.side], 0.0, 0.0
            height[foot.side] = rise
            if same_place(foot, place[foot.side]):
                stone = solids[foot.side][-1]
                now = stone.position.copy()
                now[2] = self.height + rise - stone.size[2]
                middle = foot.lift_off + 0.45 * (foot.touchdown - foot.lift_off)
                solids[foot.side][-1] = replace(stone, motions=(*stone.motions, Motion(middle, 0.0, now)))
            else:
                solids[foot.side].append(
                    stone_under(foot, feet, self.height + rise, self.depth + rise, pitch=pitch, roll=roll, gap=self.gap)
                )
            place[foot.side] = foot
        return Ground((*solids["left"], *solids["right"]), self.height - self.depth, self.friction)


class Pebbles(Terrain):
    """Sloping stones with bumps; level under standing feet, the last two steps, and overlapping ones.

    Attributes:
        bump_min: Smallest height in m.
        bump_max: Largest height.
        bump_radius: Sphere radius in m of its cap.
        bumps: Number on a stone.
        slope_range: Largest in degrees, any direction.
        depth: Floor below in m.
    """

    bump_min: float = share_of_body(1 / 120, "leg", 0, 0.05)
    bump_max: float = share_of_body(0.025, "leg", 0, 0.05)
    bump_radius: float = share_of_body(0.05, "leg", 0.005, 0.2)
    bumps: int = whole(8, "bumps", 0, 200)
    slope_range: float = number(8.0, "deg", 0, 20)
    depth: float = share_of_body(0.25, "leg", 0.02, 10)

    def _laid_out(self, feet: PlannedFeet, rng: np.random.Generator) -> Ground:
        if self.bump_min > self.bump_max:
            raise SceneError(f"terrain.bump_min is {self.bump_min:g} m; allowed: up to bump_max, {self.bump_max:g} m")
        solids = [stone_under(feet.standing[side], feet, self.height, self.depth) for side in SIDES]
        level = [*feet.standing.values(), *feet.steps[-2:]]
        for k, foot in enumerate(feet.steps):
            # Drawn in any case: what chance gives to one step does not depend on the steps before it.
            pitch, roll = drawn_slope(rng, self.slope_range)
            places = rng.uniform(-1.0, 1.0, (self.bumps, 2)) * foot.half
            heights = rng.uniform(self.bump_min, self.bump_max, self.bumps)
            if any(same_place(foot, other) for other in [*feet.standing.values(), *feet.steps[:k]]):
                continue
            if any(foot.side == other.side and overlapping(foot, other) for other in level):
                solids.append(stone_under(foot, feet, self.height, self.depth))
                continue
            stone = stone_under(foot, feet, self.height, self.depth, pitch=pitch, roll=roll)
            solids += [stone, *self._bumps(stone, foot, places, heights)]
        return Ground(tuple(solids), self.height - self.depth, self.friction)

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
    size, way = math.radians(largest) * float(rng.uniform()), float(rng.uniform(0.0, 2.0 * math.pi))
    return size * math.cos(way), size * math.sin(way)


def same_place(foot: Footprint, other: Footprint) -> bool:
    """Returns whether `foot` and `other`, of one foot, coincide to a millimetre."""
    return foot.side == other.side and bool(np.hypot(*(foot.center - other.center)) < 1e-3)


def overlapping(foot: Footprint, other: Footprint) -> bool:
    """Returns whether stones of `foot` and `other`, of one foot, overlap along the feet."""
    dx, dy = (other.center - foot.center).tolist()
    along = math.cos(foot.yaw) * dx + math.sin(foot.yaw) * dy
    return bool(abs(along) < (1.0 + _MARGIN) * (foot.half[0] + other.half[0]))


def _distinct(feet: PlannedFeet) -> list[Footprint]:
    found: list[Footprint] = []
    for foot in [*feet.standing.values(), *feet.steps]:
        if not any(same_place(foot, other) for other in found):
            found.append(foot)
    return found


def _lane(foot: Footprint, feet: PlannedFeet, gap: float) -> float:
    """Distance in m from a footprint's centre half way to the other foot's."""
    inward = -1.0 if foot.side == "left" else 1.0
    gaps = []
    others: Sequence[Footprint] = [*feet.standing.values(), *feet.steps]
    c, s = math.cos(foot.yaw), math.sin(foot.yaw)
    for other in others:
        if other.side != foot.side:
            dx, dy = (other.center - foot.center).tolist()
            if abs(c * dx + s * dy) < (1.0 + _MARGIN) * (foot.half[0] + other.half[0]):
                gaps.append(inward * (-s * dx + c * dy))
    return 0.5 * min(gaps) - 0.5 * gap if gaps else foot.half[1] + _MARGIN * foot.half[0]


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
    """A box that carries the footprint with a margin, or a part.

    Args:
        foot: The footprint.
        feet: All footprints, to keep clear of.
        height: Of the upper face in m.
        depth: Of the box in m.
        share: Carried share of the footprint.
        part: "rear", "front", "inner" or "outer".
        pitch: Slope along the foot in rad.
        roll: Slope across it in rad.
        gap: Between both feet's boxes in m.

    Returns:
        The box.
    """
    outward = 1.0 if foot.side == "left" else -1.0
    half_length, half_width = foot.half
    margin = _MARGIN * half_length
    rear, front = -half_length - margin, half_length + margin
    inner, outer = -min(_lane(foot, feet, gap), half_width + margin), half_width + margin
    if share < 1.0:
        if part == "rear":
            front = -half_length + 2.0 * half_length * share
        elif part == "front":
            rear = half_length - 2.0 * half_length * share
        elif part == "inner":
            outer = -half_width + 2.0 * half_width * share
        else:
            inner = half_width - 2.0 * half_width * share
    center = foot.place(0.5 * (rear + front), outward * 0.5 * (inner + outer))
    rotation = rotation_from_angles(foot.yaw, pitch, roll)
    half = 0.5 * max(depth, 0.02)
    # A slope turns about the middle of the footprint, which keeps its height there.
    level = np.array([*center, height])
    pivot = np.array([*foot.center, height])
    upper = pivot + rotation @ rotation_from_angles(foot.yaw).T @ (level - pivot)
    return Solid("box", (0.5 * (front - rear), 0.5 * (outer - inner), half), upper - half * rotation[:, 2], rotation)
