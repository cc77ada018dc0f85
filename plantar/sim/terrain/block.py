"""An obstacle on level ground under a planned step."""

import math

import numpy as np

from plantar.common.settings.schema import choice, number, share, whole
from plantar.errors import SceneError
from plantar.mechanics.rotation import rotation_from_angles
from plantar.sim.terrain.ground import Footprint, Ground, Motion, PlannedFeet, Solid, Terrain

_WAYS = ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0))


class Block(Terrain):
    """A slab, wedge, small block or pebbles under one step.

    Attributes:
        step: Step (from 0) above it.
        top: Height in m of its upper face's middle.
        length: In m along the foot.
        width: In m across the foot.
        along: Its middle in m, forward.
        across: The same, outward.
        pitch: In degrees along the foot; positive falls to the front.
        roll: In degrees across the foot; positive rises to the left.
        slope: Degrees that the seed adds forward, backward, inward or outward.
        shape: "box", or "spheres": three in a triangle of that size.
        at: Origin of `along` and `across`: the sole's "center" or the "ankle".
        clear: Distance in m from the foot's neighbouring footholds, by shortening; 0: not shortened.
        slide: Distance in m it slides in from outside during the swing; 0: fixed.
        height_range: Largest seeded change of `top` in m, either way.
    """

    step: int = whole(2, "step", 0, 100000)
    top: float = share(0.05, "leg", 0.001, 0.3)
    length: float = share(1.52, "sole", 0.005, 5)
    width: float = share(1, "sole_width", 0.005, 5)
    along: float = number(0.0, "m", -1, 1)
    across: float = number(0.0, "m", -1, 1)
    pitch: float = number(0.0, "deg", -30, 30)
    roll: float = number(0.0, "deg", -30, 30)
    slope: float = number(0.0, "deg", 0, 30)
    shape: str = choice("box", "spheres")
    at: str = choice("center", "ankle")
    clear: float = number(0.0, "m", 0, 1)
    slide: float = number(0.0, "m", 0, 2)
    height_range: float = number(0.0, "m", 0, 0.1)

    def ground(self, feet: PlannedFeet, rng: np.random.Generator) -> Ground:
        if self.step >= len(feet.steps):
            raise SceneError(f"terrain.step is {self.step}; allowed: 0 to {len(feet.steps) - 1}, the steps of the walk")
        foot = feet.steps[self.step]
        top = max(0.001, self.top + float(rng.uniform(-1.0, 1.0)) * self.height_range)
        box = self.shape == "box"
        pitch = self.pitch
        roll = self.roll
        if self.slope > 0.0:
            way = _WAYS[int(rng.integers(len(_WAYS)))]
            pitch = pitch + way[0] * self.slope
            roll = roll + way[1] * self.slope
        solids = (self._box(foot, top, self._room(foot, feet), pitch, roll),) if box else self._spheres(foot, top)
        return Ground(
            solids,
            self.height,
            self.friction,
            {"block_top_m": round(top, 5), "block_pitch_deg": pitch, "block_roll_deg": roll},
        )

    def _middle(self, foot: Footprint) -> np.ndarray:
        outward = 1.0 if foot.side == "left" else -1.0
        place = foot.place(self.along, outward * self.across)
        return place + (foot.ankle - foot.center if self.at == "ankle" else 0.0)

    def _room(self, foot: Footprint, feet: PlannedFeet) -> float:
        if self.clear == 0.0:
            return self.length
        forward = np.array([math.cos(foot.yaw), math.sin(foot.yaw)])
        middle = self._middle(foot)
        others = (feet.standing[foot.side], *(f for f in feet.steps if f.side == foot.side))
        gaps = [abs(float((f.center - middle) @ forward)) - f.half[0] - self.clear for f in others]
        return min([self.length, *(2.0 * gap for gap in gaps if gap > 0.0)])  # those at its own place have none

    def _box(self, foot: Footprint, top: float, length: float, pitch: float, roll: float) -> Solid:
        rotation = rotation_from_angles(foot.yaw, math.radians(pitch), math.radians(roll))
        # Thick enough to reach the floor at its lowest corner, whatever the slope.
        half = 0.5 * (top + 0.5 * length * abs(rotation[2, 0]) + 0.5 * self.width * abs(rotation[2, 1])) + 0.01
        upper = np.array([*self._middle(foot), self.height + top])
        position = upper - half * rotation[:, 2]
        return self._sliding(Solid("box", (0.5 * length, 0.5 * self.width, half), position, rotation), foot)

    def _spheres(self, foot: Footprint, top: float) -> tuple[Solid, ...]:
        radius = max(0.01, 0.5 * top)
        solids = []
        for along, across in ((0.5, 0.0), (-0.5, 0.5), (-0.5, -0.5)):
            place = self._middle(foot) - foot.center + foot.place(along * self.length, across * self.width)
            center = np.array([*place, self.height + top - radius])
            solids.append(self._sliding(Solid("sphere", (radius, 0.0, 0.0), center), foot))
        return tuple(solids)

    def _sliding(self, solid: Solid, foot: Footprint) -> Solid:
        if self.slide == 0.0:
            return solid
        outward = np.array([-math.sin(foot.yaw), math.cos(foot.yaw), 0.0]) * (1.0 if foot.side == "left" else -1.0)
        swing = foot.touchdown - foot.lift_off
        motion = Motion(foot.lift_off + 0.25 * swing, 0.35 * swing, solid.position)
        return Solid(solid.shape, solid.size, solid.position + self.slide * outward, solid.rotation, (motion,))
