"""Whether the print has the seats of its bill and assembly, by sections. In mm."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.shoes.build import Shoe, ShoeBuild
from plantar.shoes.geometry.section import section
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.heel import LIP, POST, holder_depth
from plantar.shoes.plan.shoe_plan import ShoePlan
from plantar.shoes.plan.wiring import cable_outlines, channel_lines, hole_outline
from plantar.shoes.solid.retention import Retention

# share of a place that print must fill, and may
_FULL = 0.90
_FREE = 0.02
_CABLE = 1.0  # mm: a cable that has to pass
_EPS = 1.7e-3  # mm next to a level at which corners lie

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Feature:
    """Feature of the print: the part that needs it, and its present share, 0..1."""

    name: str
    part: str
    share: float

    @property
    def holds(self) -> bool:
        return self.share >= _FULL


class _Print:
    def __init__(self, surface: Array) -> None:
        self._at = cache(lambda height: section(surface, height))

    def filled(self, place: Any, *heights: float) -> float:
        return min(float(self._at(round(h, 4) + _EPS).intersection(place).area / place.area) for h in heights)

    def free(self, place: Any, *heights: float) -> float:
        """1 where every section leaves a place free, 0 where filled."""
        most = max(float(self._at(round(h, 4) + _EPS).intersection(place).area / place.area) for h in heights)
        return 1.0 if most <= _FREE else 1.0 - most

    def cut(self, height: float) -> Any:
        return self._at(round(height, 4) + _EPS)


def printed_features(shoe: Shoe, build: ShoeBuild, surface: Array) -> tuple[Feature, ...]:
    """Returns every feature in the papers of a `shoe` of its `build`, looked for in its `surface`, STL triangles
    (n, 3, 3) in mm.
    """
    solid = _Print(surface)
    p = build.parameters
    plan = shoe.plan
    found = [*_seats(solid, plan, p), *_cable(solid, plan, p)]
    if plan.heel.board:
        found += _rails(solid, plan, p)
    if build.retention is not None and build.retention.places:
        found += _holders(solid, shoe, build, build.retention)
    return tuple(found)


def _seats(solid: _Print, plan: ShoePlan, p: ShoeParameters) -> Iterator[Feature]:
    part = "taxel" if plan.cell is None else "cell"
    hole = hole_outline(plan, p)
    ways = shapely.union_all(cable_outlines(plan, p))
    free = []
    roofs = []
    ribs = []
    walls = shapely.union_all([q.buffer(0.45 * p.rib, join_style="mitre") for q in plan.pockets])
    walls = walls.difference(shapely.union_all([*(q.buffer(0.05) for q in plan.pockets), ways.buffer(p.wall_min)]))
    walls = walls.difference(hole)
    for pocket in plan.pockets:
        inner = pocket.buffer(-0.05)
        free.append(solid.free(inner, p.bottom + 0.5 * p.pocket_depth, p.ceiling - 0.1))
        roofs.append(solid.filled(inner.difference(hole.buffer(0.1)), p.ceiling + 0.1))
        own = walls.intersection(pocket.buffer(0.45 * p.rib, join_style="mitre"))
        if own.area > 1.0:
            ribs.append(solid.filled(own, p.bottom + max(p.scribe, 0.5 * p.pocket_depth) + 0.05))
    yield Feature("pocket of each", part, min(free))
    yield Feature("ceiling over each pocket", part, min(roofs))
    if ribs:
        yield Feature("ribs around each pocket", part, min(ribs))


def _cable(solid: _Print, plan: ShoePlan, p: ShoeParameters) -> Iterator[Feature]:
    if not plan.connectors:
        return
    height = p.bottom + max(p.scribe, 0.5 * p.pocket_depth) + 0.05
    channel = channel_lines(plan, p)[0]  # behind a slanted heel it goes on beside the contact face
    around = plan.contact.buffer(3.0).union(shapely.LineString(channel).buffer(0.5 * p.channel_width + 2.0))
    open_ = around.difference(solid.cut(height)).buffer(-0.5 * _CABLE)
    end = channel[-1]
    out = hole_outline(plan, p) if plan.heel.board else around.difference(plan.contact.buffer(1.0))
    start = out if not plan.heel.board else shapely.Point(end).buffer(0.3)
    ways = [q for q in getattr(open_, "geoms", [open_]) if q.intersects(start)]
    reached = [any(w.intersects(q) for w in ways) for q in plan.pockets]
    yield Feature("way from each pocket to the heel", "cable", float(np.mean(reached)))
    if plan.heel.board:
        levels = np.linspace(p.bottom + 0.1, p.thickness - 0.1, 5).tolist()
        yield Feature("hole behind the wall", "cable", solid.free(out.buffer(-0.05), *levels))


def _rails(solid: _Print, plan: ShoePlan, p: ShoeParameters) -> Iterator[Feature]:
    half = 0.5 * p.board_length
    gap = p.made_by.slide
    back = -holder_depth(p)
    levels = np.linspace(p.thickness + 0.3, p.rim_top - 0.3, 4).tolist()

    def place(x: tuple[float, float], y: tuple[float, float]) -> Any:
        return plan.heel.placed(shapely.box(x[0] + 0.05, y[0] + 0.05, x[1] - 0.05, y[1] - 0.05))

    slot = (back + LIP, -p.board_gap)
    board = place((slot[0], slot[1]), (-half - gap, half + gap))
    yield Feature("slot for the board", "connection board", solid.free(board, *levels))
    stops = []
    for side in (-1.0, 1.0):
        ends = sorted((side * (half + gap), side * (half + gap + POST)))
        over = sorted((side * half, side * (half - POST)))
        rails = ((slot, ends), ((back, slot[0]), over), ((slot[1], 0.0), over))
        stops += [solid.filled(place(along, (across[0], across[1])), *levels) for along, across in rails]
    yield Feature("rails at both ends of the board", "connection board", min(stops))
    shelf = place((back, -p.board_gap), (-half - POST, half + POST)).difference(hole_outline(plan, p).buffer(0.05))
    yield Feature("shelf below the board", "connection board", solid.filled(shelf, p.thickness - 0.5))


def _holders(solid: _Print, shoe: Shoe, build: ShoeBuild, retention: Retention) -> Iterator[Feature]:
    p = build.parameters
    width = retention.width
    middle = shoe.plan.foot.centroid.y
    flip = 1.0 if shoe.side == "left" else -1.0

    def area(place: Any, start: float, end: float, height: float) -> float:
        ends = sorted((middle, middle + flip * place.side * 1e3))
        window = shapely.box(place.x + min(start, end), ends[0], place.x + max(start, end), ends[1])
        return float(solid.cut(height).intersection(window).area)

    def least(shares: list[float]) -> float:
        return min(1.0, min(shares))

    places = retention.places
    half = 0.5 * width
    if retention.kind == "straps":
        low = p.rim_top + 1.0
        top = p.thickness + retention.top(p)
        high = low + p.strap_thickness + 2.0
        post = 4.0 * p.rim_thickness
        heights = (low + 0.2, 0.5 * (low + high), high - 0.2)
        free = [1.0 - area(q, -half, half, h) / (width * p.rim_thickness) for q in places for h in heights]
        bars = [area(q, -half, half, h) / (width * p.rim_thickness) for q in places for h in (high + 0.2, top - 2.0)]
        ends = [area(q, e * (half + 1.0), e * (half + 6.0), h) / post
                for q in places for e in (-1.0, 1.0) for h in heights]  # fmt: skip
        yield Feature("slot of each lug", "strap", least(free))
        yield Feature("bar above each slot", "strap", least(bars))
        yield Feature("posts beside each slot", "strap", least(ends))
    elif retention.kind == "clips":
        reach = p.clip_hook + p.clearance
        hooks = []
        free = []
        for q in places:
            arm, hook = (area(q, -half, half, p.thickness + q.edge + z) for z in (-1.5, reach - 0.05))
            hooks.append((hook - arm) / (width * reach))
            sides = (area(q, e * (half + 0.1), e * (half + 1.0), p.rim_top - 0.3) for e in (-1.0, 1.0))
            free += [1.0 - v / p.rim_thickness for v in sides]
        yield Feature("hook of each clip", "clip", least(hooks))
        yield Feature("room beside each arm to bend", "clip", least(free))
    else:
        holes = [1.0 - area(q, -0.3 * width, 0.3 * width, p.thickness + 0.5 * p.rim_height) / width for q in places]
        yield Feature("hole of each screw", "set screw", least(holes))
        nuts = []
        for q in places:
            line = shapely.LineString([(q.x, middle), (q.x, middle + flip * q.side * 1e3)])
            walls = sorted(g.bounds[1::2] for g in shapely.get_parts(line.intersection(solid.cut(p.rim_top - 0.3))))
            nuts.append(max((b[0] - a[1] for a, b in pairwise(walls)), default=0.0) / (0.8 * width))
        yield Feature("slot of each nut, between two walls", "nut", least(nuts))
