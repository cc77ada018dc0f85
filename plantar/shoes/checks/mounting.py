"""Whether the exported shoe goes onto the foot. Lengths in mm."""

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.layouts.layout import Side
from plantar.shoes.foot.foot import Foot
from plantar.shoes.geometry.outline import cut_below, ring
from plantar.shoes.geometry.section import cut_segments, section
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.keep_out import keep_out
from plantar.shoes.solid.body import LEVELS
from plantar.shoes.solid.retention import Retention, strap_meets

_ABOVE = 9  # sections above the wall
_BESIDE = 8.0  # mm next to a clip or screw, where its window or boss is
_SLICE = 2.0  # mm of height in which links are held against one section
_SLIVER = 0.05  # mm that a wall may lean over
_WALL_SHARE = 0.1  # of a section's area: what is smaller is a clip, no wall

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Mounting:
    """Foot in the shoe.

    Attributes:
        play: Largest gap at the wall's edge.
        gap_above: Smallest, foot to lugs or clips.
        gap_on_the_way: Smallest, foot to rigid parts while pushed on.
        support_share: Share of the touching area over the floor, 0..1.
        undercut: Unprintable wall area in mm^2 over the foot's place.
        links: Places where other robot links meet print or strap.
        links_known: Whether from the robot's model.
    """

    gap: float
    play: float
    gap_above: float
    gap_on_the_way: float
    floor_gap: float
    support_share: float
    undercut: float
    links: int
    links_known: bool


def check_mounting(
    foot: Foot, side: Side, surface: Array, retention: Retention, parameters: ShoeParameters
) -> Mounting:
    """Gives left foot's gaps in an exported surface (n, 3, 3) in mm of a side, by retention and parameters."""
    p = parameters
    flip = np.array([1.0, 1.0, 1.0]) if side == "left" else np.array([1.0, -1.0, 1.0])
    shoe = surface * flip  # the left foot is put into either
    shoe = shoe if side == "left" else shoe[:, ::-1]
    floor = p.thickness
    lowest = float(foot.triangles[..., 2].min()) if foot.triangles is not None else 0.0
    # On a flat foot the hooks of clips begin below the wall's upper edge: from there on they are what is near the foot.
    hooks = min((q.edge for q in retention.places), default=0.0) if retention.kind == "clips" else math.inf
    hooks -= p.clearance
    walls = [share * p.rim_height - 0.011 for share in LEVELS] + [p.rim_height - p.lead_in - 0.011]
    walls = [height for height in walls if height < hooks]
    gap = math.inf
    way = math.inf
    for height in walls:
        solid = section(shoe, floor + height)
        gap = min(gap, _gap(foot, height, solid))
        way = min(way, _gap_on_the_way(foot, height + 0.011, solid))
    play = _play(foot.passing(p.rim_height), section(shoe, floor + p.rim_height - p.lead_in - 0.011))
    above = math.inf
    top = retention.top(p)
    start = min(p.rim_height, hooks)
    for i in range(_ABOVE if retention.places else 0):
        height = start + (top - start) * (i + 0.47) / _ABOVE
        solid = section(shoe, floor + height)
        if solid.is_empty:
            continue
        above = min(above, _gap(foot, height, solid))
        if height < hooks:
            way = min(way, float(foot.passing(top).distance(solid)))
    touching = foot.support if foot.support is not None and not foot.support.is_empty else foot.sole
    share = float(touching.intersection(section(shoe, floor - p.mark_depth - 0.05)).area / touching.area)
    others = keep_out(foot)
    met = _links_met(others.links, shoe, p)
    if retention.kind == "straps":
        met += sum(
            strap_meets(others, foot.passing(p.rim_height), q.x, retention.width, p)
            for q in retention.places
            if q.side > 0
        )
    return Mounting(gap, play, above, way, abs(lowest), share, _undercut(shoe, retention, p), met, others.known)


def _links_met(links: Array, shoe: Array, p: ShoeParameters) -> int:
    heights = links[:, 2] + p.thickness
    count = 0
    for low in np.arange(0.0, float(shoe[..., 2].max()), _SLICE).tolist():
        near = links[(heights > low) & (heights <= low + _SLICE)]
        if len(near):
            count += int(shapely.contains_xy(section(shoe, low + 0.5 * _SLICE + 1.3e-4), near[:, 0], near[:, 1]).sum())
    return count


def _undercut(shoe: Array, retention: Retention, p: ShoeParameters) -> float:
    half = 0.5 * retention.width + _BESIDE
    kept = [shapely.box(q.x - half, 0.0, q.x + half, q.side * 1e3) for q in retention.places]
    levels = np.unique(shoe[..., 2].round(3))
    levels = levels[(levels > p.thickness - 1e-3) & (levels < p.rim_top + 1e-3)]
    below = None
    area = 0.0
    for low, high in pairwise(levels.tolist()):
        if high - low < 0.02:
            continue
        solid = section(shoe, 0.5 * (low + high) + 1.3e-4)
        if below is not None:
            area += float(solid.difference(below.buffer(_SLIVER)).difference(shapely.union_all(kept)).area)
        below = solid
    return round(area, 2)


def _gap(foot: Foot, height: float, solid: Any) -> float:
    if foot.triangles is None:
        return float(foot.sole.distance(solid))
    segments, _ = cut_segments(foot.triangles, height + 1e-5)
    if not len(segments):
        return math.inf
    shapely.prepare(solid)
    return float(shapely.distance(shapely.multilinestrings(segments), solid))


def _gap_on_the_way(foot: Foot, height: float, solid: Any) -> float:
    """Smallest distance from above of the foot up to a height from a section."""
    if foot.triangles is None:
        return float(foot.passing(height).distance(solid))
    flat = cut_below(foot.triangles, height)[..., :2]
    if not len(flat):
        return math.inf
    shapely.prepare(solid)
    return float(shapely.distance(shapely.polygons(np.concatenate([flat, flat[:, :1]], axis=1)), solid).min())


def _play(outline: Any, solid: Any) -> float:
    holes = [shapely.Polygon(h) for part in getattr(solid, "geoms", [solid]) for h in part.interiors]
    around = [h for h in holes if h.covers(outline)]
    if around:
        return float(max(outline.distance(shapely.points(ring(around[0])))))
    # The wall is open where clips stand: measured where it is, clips left out.
    parts = [p for p in getattr(solid, "geoms", [solid]) if p.area > _WALL_SHARE * solid.area]
    return float(max((p.distance(outline) for p in parts), default=math.inf))
