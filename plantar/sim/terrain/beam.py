"""A beam between platforms, along the walk (T 4.4.5.3)."""

import math

import numpy as np

from plantar.common.settings.schema import number, share
from plantar.sim.terrain.ground import Ground, PlannedFeet, Terrain
from plantar.sim.terrain.way import Way, way_of


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

    def ground(self, feet: PlannedFeet, rng: np.random.Generator) -> Ground:
        way = way_of(feet)
        offset = self.offset + float(rng.uniform(-1.0, 1.0)) * self.offset_range
        start = max(self.start, way.reach(tuple(feet.standing.values()))[1])
        near = way.begin + start * way.along + offset * np.array([-way.along[1], way.along[0]])
        # The platforms' edges run across the walk; the beam's ends run 50 mm into them, so that no gap opens where it
        # is turned.
        turned = way.heading + math.radians(self.yaw)
        length = self.length / math.cos(math.radians(self.yaw))
        beam = Way(near, turned, length).piece((-0.05, self.height), (length + 0.05, self.height), 0.5 * self.width)
        end = start + self.length
        platforms = ((start - 1.2, start), (end, max(end, way.length) + 1.0))
        return Ground(
            (*(way.piece((a, self.height), (b, self.height)) for a, b in platforms), beam),
            self.height - self.depth,
            self.friction,
            {"beam_offset_m": round(offset, 5)},
        )
