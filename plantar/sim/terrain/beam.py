"""A beam between platforms, along the walk (T 4.4.5.3)."""

from __future__ import annotations

import math

import numpy as np

from plantar.mechanics.rotation import level_rotation
from plantar.settings.schema import number, share
from plantar.sim.terrain.ground import Ground, PlannedFeet, Solid, Terrain

__all__ = ["Beam"]

_THICK = 0.1  # m, half height of beam and platforms
_CORNERS = ((-1, -1), (1, -1), (1, 1), (-1, 1))


class Beam(Terrain):
    """A beam between two platforms, along the walk (T 4.4.5.3).

    Attributes:
        width: In m.
        length: In m, between platforms.
        start: Distance in m from the standing feet's middle, longer where a foot would be on it.
        offset: In m from the soles' centres, positive left.
        offset_range: Largest seeded offset in m, either way.
        yaw: In degrees to the walk, about the near end.
        depth: Floor below in m.
    """

    width: float = share(0.52, "sole", 0.005, 2)
    length: float = share(13 / 6, "leg", 0.1, 100)
    start: float = share(8 / 15, "leg", 0, 10)
    offset: float = number(0.0, "m", -1, 1)
    offset_range: float = number(0.0, "m", 0, 1)
    yaw: float = number(0.0, "deg", -45, 45)
    depth: float = share(0.5, "leg", 0.02, 10)

    def _laid_out(self, feet: PlannedFeet, rng: np.random.Generator) -> Ground:
        begin, end = feet.middle(), feet.middle(last=True)
        way = end - begin
        distance = float(np.hypot(*way))
        heading = math.atan2(way[1], way[0]) if distance > 1e-6 else feet.standing["left"].yaw
        along = np.array([math.cos(heading), math.sin(heading)])
        across = np.array([-along[1], along[0]])
        offset = self.offset + float(rng.uniform(-1.0, 1.0)) * self.offset_range
        turned = heading + math.radians(self.yaw)
        line = np.array([math.cos(turned), math.sin(turned)])
        start = max(self.start, _foremost(feet, begin, along))
        near = begin + start * along + offset * across
        z = self.height - _THICK
        reach = self.length / math.cos(turned - heading)  # the platforms' edges run across the walk

        def platform(first: float, last: float) -> Solid:
            middle = begin + 0.5 * (first + last) * along
            return Solid("box", (0.5 * (last - first), 0.8, _THICK), np.array([*middle, z]), level_rotation(heading))

        # The beam's ends run 50 mm into the platforms, so that no gap opens where it is turned.
        beam_middle = near + 0.5 * reach * line
        half = 0.5 * reach + 0.05
        return Ground(
            (
                platform(start - 1.2, start),
                platform(start + self.length, max(start + self.length, distance) + 1.0),
                Solid("box", (half, 0.5 * self.width, _THICK), np.array([*beam_middle, z]), level_rotation(turned)),
            ),
            self.height - self.depth,
            self.friction,
            {"beam_offset_m": round(offset, 5)},
        )


def _foremost(feet: PlannedFeet, begin: np.ndarray, along: np.ndarray) -> float:
    """Largest distance in m of standing soles from a point (2,) along a direction (2,)."""
    corners = [foot.place(a * foot.half[0], b * foot.half[1]) for foot in feet.standing.values() for a, b in _CORNERS]
    return float(max((corner - begin) @ along for corner in corners))
