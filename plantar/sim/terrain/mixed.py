"""A mixed course: the seed draws the ground under each step."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from plantar.common.settings.schema import number
from plantar.common.settings.schema import share as share_of_body
from plantar.mechanics.rotation import rotation_from_angles
from plantar.sim.terrain.ground import Footprint, PlannedFeet, Solid
from plantar.sim.terrain.stones import Laid, drawn_slope, overlapping, stone_under

_PIECES = ("level", "part", "height", "slope", "slab", "beam")
_PARTS = ("rear", "front", "inner", "outer")


class Mixed(Laid):
    """Level stones, partial, higher and lower ones, slopes, slabs and pieces of a beam across the walk.

    Level are standing feet, the last two steps, and stones that would overlap these or the same foot's last.

    Attributes:
        share_min: Smallest share of the sole on a partial stone.
        height_range: Largest in m from expected ground.
        slope_range: Largest in degrees, any direction.
        slab: Height in m.
        beam_width: Width in m along the foot.
        beam_offset: Largest in m from the sole's middle, either way.
    """

    share_min: float = number(0.5, "1", 0.02, 1)
    height_range: float = share_of_body(0.025, "leg", 0, 0.1)
    slope_range: float = number(5.0, "deg", 0, 20)
    slab: float = share_of_body(0.05, "leg", 0, 0.1)
    beam_width: float = share_of_body(0.52, "sole", 0.02, 1)
    beam_offset: float = share_of_body(0.15, "sole", 0, 0.3)

    def _drawn(self, rng: np.random.Generator, foot: Footprint) -> Any:
        return _PIECES[int(rng.integers(len(_PIECES)))], np.random.default_rng(int(rng.integers(2**32)))

    def _under(self, foot: Footprint, k: int, feet: PlannedFeet, drawn: Any) -> Sequence[Solid]:
        before = [other for other in feet.steps[: max(k, 0)] if other.side == foot.side][-1:]
        near = [other for other in (*feet.steps[-2:], *feet.standing.values(), *before) if other.side == foot.side]
        if k < 0 or k >= len(feet.steps) - 2 or any(overlapping(foot, other) for other in near):
            return [stone_under(foot, feet, self.height, self.depth)]
        return [self._piece(drawn[0], foot, feet, drawn[1])]

    def _piece(self, piece: str, foot: Footprint, feet: PlannedFeet, rng: np.random.Generator) -> Solid:
        if piece == "part":
            share = float(rng.uniform(self.share_min, 1.0))
            part = _PARTS[int(rng.integers(len(_PARTS)))]
            return stone_under(foot, feet, self.height, self.depth, share, part)
        if piece == "slope":
            pitch, roll = drawn_slope(rng, self.slope_range)
            return stone_under(foot, feet, self.height, self.depth, pitch=pitch, roll=roll)
        if piece == "beam":
            return self._beam(stone_under(foot, feet, self.height, self.depth), foot, rng)
        rise = {"height": float(rng.uniform(-1.0, 1.0)) * self.height_range, "slab": self.slab}.get(piece, 0.0)
        return stone_under(foot, feet, self.height + rise, self.depth + rise)

    def _beam(self, stone: Solid, foot: Footprint, rng: np.random.Generator) -> Solid:
        away = float(rng.uniform(-1.0, 1.0)) * self.beam_offset
        forward = rotation_from_angles(foot.yaw)[:, 0]
        middle = np.array([*foot.center, stone.position[2]])
        across = stone.position - middle - forward * float(forward @ (stone.position - middle))
        size = (0.5 * self.beam_width, stone.size[1], stone.size[2])
        return Solid("box", size, middle + across + away * forward, stone.rotation)
