"""Ground across the whole way of a walk: stairs, slopes, and a height field."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import number, share
from plantar.errors import SceneError
from plantar.mechanics.rotation import level_rotation, rotation_from_angles
from plantar.sim.terrain.ground import Footprint, Ground, PlannedFeet, Solid, Terrain

_THICK = 0.1  # m, half height of a piece
_HALF_WIDTH = 0.8  # m, of a piece
_BEYOND = 1.2  # m of ground behind the start and ahead of the end
_CELL = 0.25  # of the length of a bump, so that the field is smooth
_WAVES = 40
_Place = tuple[float, float]  # distance along a way and height in m


@dataclass(frozen=True)
class Way:
    """Line of a walk: `begin` (2,) and `length` in m, `heading` in rad."""

    begin: NDArray[np.float64]
    heading: float
    length: float

    @property
    def along(self) -> NDArray[np.float64]:
        """Unit vector (2,)."""
        return np.array([math.cos(self.heading), math.sin(self.heading)])

    def reach(self, feet: tuple[Footprint, ...]) -> tuple[float, float]:
        """Least and largest distance in m of soles along the way."""
        corners = [foot.place(a * foot.half[0], b * foot.half[1]) for foot in feet for a in (-1, 1) for b in (-1, 1)]
        distances = [float((corner - self.begin) @ self.along) for corner in corners]
        return min(distances), max(distances)

    def piece(self, first: _Place, last: _Place, half_width: float = _HALF_WIDTH) -> Solid:
        """Returns a box, its upper face from `first` to `last`, `half_width` in m."""
        x, z = first
        length = last[0] - first[0]
        rise = last[1] - first[1]
        rotation = rotation_from_angles(self.heading, -math.atan2(rise, length))
        face = np.array([*(self.begin + (x + 0.5 * length) * self.along), z + 0.5 * rise])
        size = (0.5 * math.hypot(length, rise), half_width, _THICK)
        return Solid("box", size, face - _THICK * rotation[:, 2], rotation)


def way_of(feet: PlannedFeet) -> Way:
    """The line of a walk with these footprints."""
    begin = feet.middle()
    way = feet.middle(last=True) - begin
    length = float(np.hypot(*way))
    return Way(begin, math.atan2(way[1], way[0]) if length > 1e-6 else feet.standing["left"].yaw, length)


def _places(way: Way, feet: PlannedFeet) -> tuple[list[float], NDArray[np.float64]]:
    """Edges half way between places of steps along a way, and planned rises at them, in m."""
    places = [(0.0, feet.standing["left"].z)]
    for foot in feet.steps:
        place = float((foot.center - way.begin) @ way.along)
        if place > places[-1][0] + 1e-3:
            places.append((place, foot.z))
    edges = [0.5 * (a + b) for (a, _), (b, _) in pairwise(places)]
    return edges, np.diff([z for _, z in places])


def _across(terrain: Terrain, way: Way, pieces: Sequence[tuple[_Place, _Place]]) -> Ground:
    """Ground of boxes across a way, each between two places."""
    heights = [z for piece in pieces for _, z in piece]
    facts = {"climb_m": round(max(heights) - min(heights), 5)}
    return Ground(tuple(way.piece(*piece) for piece in pieces), min(heights) - 2.0 * _THICK, terrain.friction, facts)


class Stairs(Terrain):
    """A tread under each place of a step, as high as planned (`walk.climb`), or otherwise.

    Attributes:
        rise: Of each tread, unplanned, in m, up to the middle of the walk, then down; negative: first down.
        spread: Largest seeded change of each rise in m, either way.
    """

    rise: float = share(0.0, "leg", -0.5, 0.5)
    spread: float = share(0.0, "leg", 0, 0.1)

    def ground(self, feet: PlannedFeet, rng: np.random.Generator) -> Ground:
        way = way_of(feet)
        edges, planned = _places(way, feet)
        sole = max((2.0 * foot.half[0] for foot in feet.steps), default=0.0)
        tread = min((b - a for a, b in pairwise(edges)), default=math.inf)
        if tread <= sole:
            raise SceneError(
                f"steps of {tread:.3f} m make treads that are shorter than the sole of {sole:.3f} m; allowed: a longer "
                'walk.length, and walk.pattern="closing" for both feet on each tread'
            )
        ways = np.where(2 * np.arange(len(edges)) < len(edges), 1.0, -1.0)
        rises = planned + self.rise * ways + self.spread * rng.uniform(-1.0, 1.0, len(ways))
        ends = pairwise([-_BEYOND, *edges, way.length + _BEYOND])
        heights = np.cumsum([self.height, *rises]).tolist()
        return _across(self, way, [((a, z), (b, z)) for (a, b), z in zip(ends, heights, strict=True)])


class Slopes(Terrain):
    """Level, up, level, down and level, with edges between places of steps.

    Attributes:
        slope: In degrees; negative: first down, then up.
    """

    slope: float = number(10.0, "deg", -30, 30)

    def ground(self, feet: PlannedFeet, rng: np.random.Generator) -> Ground:
        way = way_of(feet)
        edges, _ = _places(way, feet)
        if len(edges) < 6:
            raise SceneError(f"slopes have {len(edges)} places of steps; allowed: 6 or more, by more walk.steps")
        up = (len(edges) - 4) // 2
        knots = [edges[1], edges[1 + up], edges[2 + up], edges[2 + 2 * up]]
        ends = [-_BEYOND, *knots, way.length + _BEYOND]
        rises = math.tan(math.radians(self.slope)) * np.array([0.0, 1.0, 0.0, -1.0, 0.0]) * np.diff(ends)
        heights = np.cumsum([self.height, *rises]).tolist()
        return _across(self, way, list(pairwise(zip(ends, heights, strict=True))))


class Relief(Terrain):
    """A sum of random waves, level under the standing feet.

    Attributes:
        unevenness: Between lowest and highest place in m.
        bump: Shortest waves in m; the longest have three times that.
    """

    unevenness: float = share(1 / 15, "leg", 0, 0.3)
    bump: float = share(2.0, "sole", 0.05, 5)

    def ground(self, feet: PlannedFeet, rng: np.random.Generator) -> Ground:
        way = way_of(feet)
        _, foremost = way.reach(tuple(feet.standing.values()))
        half_length = 0.5 * way.length + foremost + 0.5
        cell = _CELL * self.bump
        counts = [2 * int(np.ceil(half / cell)) + 1 for half in (half_length, _HALF_WIDTH)]
        x, y = (cell * (np.arange(n) - (n - 1) / 2) for n in counts)
        heights = self._waves(x[None, :], y[:, None], rng)
        heights *= self.unevenness / max(float(np.ptp(heights)), 1e-12)
        begin = 0.5 * way.length  # of the walk, behind the field's middle
        level = np.clip((x + begin - foremost - 0.5 * self.bump) / self.bump, 0.0, 1.0)
        heights *= level**2 * (3.0 - 2.0 * level)
        lowest = float(heights.min())
        size = (0.5 * float(np.ptp(x)), 0.5 * float(np.ptp(y)), float(heights.max()) - lowest)
        place = np.array([*(way.begin + begin * way.along), self.height + lowest])
        field = Solid("field", size, place, level_rotation(way.heading), heights=heights - lowest)
        return Ground((field,), self.height + lowest - 0.1, self.friction, {"unevenness_m": round(size[2], 5)})

    def _waves(self, x: np.ndarray, y: np.ndarray, rng: np.random.Generator) -> np.ndarray:
        """Sum of waves of random way, length and phase over a grid (n, m)."""
        angles, phases = rng.uniform(0.0, 2.0 * np.pi, (2, _WAVES))
        numbers = 2.0 * np.pi / (self.bump * rng.uniform(1.0, 3.0, _WAVES))
        waves = (
            np.sin(k * (np.cos(a) * x + np.sin(a) * y) + p)
            for k, a, p in zip(numbers.tolist(), angles.tolist(), phases.tolist(), strict=True)
        )
        return np.asarray(sum(waves, np.zeros((y.size, x.size))))
