"""Which pieces of the ground carried the robot."""

from typing import TYPE_CHECKING

import numpy as np

from plantar.kernels.judging.piece_loads import PieceLoads
from plantar.sim.model.world import World
from plantar.sim.terrain import CORNERS, FLAT

if TYPE_CHECKING:
    from plantar.sim.terrain import Ground, PlannedFeet

_ROUND = ("sphere", "ellipsoid")  # bumps on what is stepped on


class GroundPieces:
    """Follows the pieces of a `ground` in a `world`; one carries from `least` in N.

    Attributes:
        loads: Takes both feet's contacts each physics step.
        count: Number of pieces.
    """

    def __init__(self, world: World, ground: "Ground", least: float) -> None:
        self._ground = ground
        self._period = world.period
        self.count = len(ground.solids)
        numbers = np.full(world.model.ngeom, -1, dtype=np.intp)
        for piece, solid in enumerate(ground.solids):
            touched = f"ground_{piece}{CORNERS}" if solid.shape in FLAT else f"ground_{piece}"
            numbers[world.model.geom(touched).id] = piece
        self.loads = PieceLoads(numbers, least)

    def carried(self, piece: int) -> bool:
        """Whether a `piece` has carried the robot."""
        return bool(self.loads.longest[piece] > 0)

    def longest(self, piece: int) -> float:
        """Longest time in s in a row for which a `piece` carried."""
        return float(self.loads.longest[piece]) * self._period

    def largest(self, piece: int) -> float:
        """Largest vertical force in N on a `piece`."""
        return float(self.loads.largest[piece])

    def under(self, planned: "PlannedFeet", share: float) -> list[int]:
        """Returns pieces, round ones apart, below `share` of a `planned` step's footprint, where they come to lie."""
        import shapely

        corners = ((1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0))
        soles = [
            shapely.Polygon([foot.place(a * foot.half[0], b * foot.half[1]) for a, b in corners])
            for foot in planned.steps
        ]
        found = []
        for piece, (solid, ring) in enumerate(zip(self._ground.solids, self._ground.seen_from_above(), strict=True)):
            moved = solid.at(np.inf)[:2] - solid.position[:2]
            face = shapely.Polygon(np.array(ring) + moved).convex_hull
            if solid.shape not in _ROUND and any(face.intersection(s).area >= share * s.area for s in soles):
                found.append(piece)
        return found
