"""A beam between two platforms, along the walk (T 4.4.5.3)."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from sim.table import limits
from sim.terrain.ground import Ground, PlannedFeet, Solid, Terrain, rotation_of

__all__ = ["Beam"]

_THICK = 0.1  # m, half height of beam and platforms


@dataclass(frozen=True)
class Beam(Terrain):
    """A beam between two platforms, along the walk.

    Attributes:
        width: Width of the beam in m.
        length: Distance in m between the platforms.
        start: Distance in m from the middle of the standing feet to the beam.
        offset: Distance in m of the beam's middle line from the soles' centres, across the walk: positive to the left
            of the walking direction, which in side steps to the left is backward.
        offset_range: The seed adds an offset of up to this much in m, either way.
        yaw: Angle in degrees by which the beam is turned against the walk, about its near end.
        depth: How deep in m the floor lies below.
    """

    whole: ClassVar[bool] = False
    width: float = field(default=0.12, metadata=limits(0.005, 2.0))
    length: float = field(default=1.3, metadata=limits(0.1, 100.0))
    start: float = field(default=0.32, metadata=limits(0.0, 10.0))
    offset: float = field(default=0.0, metadata=limits(-1.0, 1.0))
    offset_range: float = field(default=0.0, metadata=limits(0.0, 1.0))
    yaw: float = field(default=0.0, metadata=limits(-45.0, 45.0))
    depth: float = field(default=0.3, metadata=limits(0.02, 10.0))

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
        near = begin + self.start * along + offset * across
        z = self.height - _THICK
        reach = self.length / math.cos(turned - heading)  # the platforms' edges stand across the walk

        def platform(first: float, last: float) -> Solid:
            middle = begin + 0.5 * (first + last) * along
            return Solid("box", (0.5 * (last - first), 0.8, _THICK), np.array([*middle, z]), rotation_of(heading))

        # The beam's ends run 50 mm into the platforms, so that no gap opens where it is turned.
        beam_middle = near + 0.5 * reach * line
        half = 0.5 * reach + 0.05
        return Ground(
            (
                platform(self.start - 1.2, self.start),
                platform(self.start + self.length, max(self.start + self.length, distance) + 1.0),
                Solid("box", (half, 0.5 * self.width, _THICK), np.array([*beam_middle, z]), rotation_of(turned)),
            ),
            self.height - self.depth,
            self.friction,
            {"beam_offset_m": round(offset, 5)},
        )
