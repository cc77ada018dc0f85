"""Printed body as added and cut blocks."""

from typing import Any

import numpy as np
import shapely

from plantar.layouts.layout import Side
from plantar.shoes.foot.foot import Foot
from plantar.shoes.geometry.outline import apart, grown, joined_corners, ring, tidy
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.block import Block, Groove, Step, moved_edges, tapered
from plantar.shoes.plan.shoe_plan import ShoePlan
from plantar.shoes.plan.wiring import pocket_outlines, wiring_steps
from plantar.shoes.solid.lettering import lettering
from plantar.shoes.solid.retention import Retention, retention_steps

LEVELS = (0.06, 0.14, 0.25, 0.4, 0.6, 1.0)  # shares of the wall's height at which the foot's outline is taken

_STEP = 0.3  # mm by which two levels must differ to be two
_WIDER = (0.0, 0.1, 0.2, 0.3)  # mm
_LOSS = 0.045  # mm of the foot's place that joining corners may take
_PLACE = "the foot's place"  # name of the step that cuts it
_TRIM = 0.8  # mm: bevel of the wall's upper outer edge
_MARK_MOST = 10  # letters
_MARK_OFF = 4.0  # mm from walls and from what rises below an arch


def shoe_steps(foot: Foot, plan: ShoePlan, retention: Retention, parameters: ShoeParameters) -> tuple[Step, ...]:
    """Gives body steps of the left shoe by foot, plan, retention and parameters, without mark; the first adds."""
    p = parameters
    holding, after = retention_steps(foot, plan, retention, p)
    holder, holes = wiring_steps(plan, p)
    body = (Block(plan.contact, p.bottom, p.thickness), *_wall(plan, p), *holding, *holder)
    levels = cavity_levels(foot, plan, p)
    place = [Block(outline, p.thickness + low, p.thickness + high) for low, high, outline in levels]
    place.append(Block(levels[-1][2], p.rim_top - 0.5, p.rim_top + 1.0))
    bevel = tapered(levels[-1][2], -0.02, p.lead_in, p.rim_top - p.lead_in, p.rim_top + 0.02) if p.lead_in > 0 else None
    if bevel is not None:
        place.append(bevel)
    return (
        Step("add", "plate, wall and what stands on them", body),
        Step("add", "fillet between wall and plate", tuple(_fillet(plan, p)), within=plan.contact),
        Step("cut", _PLACE, tuple(place)),
        *_cell_steps(plan, p),
        *after,
        *holes,
    )


def insole_steps(plan: ShoePlan, parameters: ShoeParameters) -> tuple[Step, ...]:
    """Gives body steps of the left insole by plan and parameters, without mark; the first adds."""
    plate = Block(plan.contact, parameters.bottom, parameters.thickness)
    return (Step("add", "plate", (plate,)), *_cell_steps(plan, parameters))


def _cell_steps(plan: ShoePlan, p: ShoeParameters) -> tuple[Step, Step]:
    pockets = [Block(outline, p.bottom - 1.0, p.ceiling) for outline in pocket_outlines(plan, p)]
    return (
        Step("cut", "pockets", tuple(pockets)),
        Step("cut", "border of the cells", tuple(_scribe(c, p) for c in plan.cells) if p.scribe > 0.0 else ()),
    )


def cavity_levels(foot: Foot, plan: ShoePlan, parameters: ShoeParameters) -> list[tuple[float, float, Any]]:
    """Gives lower and upper heights above the foot's face and outlines of the foot's place in a plan, from below, by
    parameters: the foot's outline to each level, grown by the clearance.
    """
    p = parameters
    outlines = [plan.cavity]
    for share in LEVELS[-2::-1]:  # each within the one above it: nothing about the wall hangs over
        outline = tidy(grown(foot.passing(share * p.rim_height), p.clearance))
        outlines.append(_within(outlines[-1], outline))
    out: list[tuple[float, float, Any]] = []
    low = 0.0
    for share, outline in zip(LEVELS, outlines[::-1], strict=True):
        high = share * p.rim_height
        if out and outline.hausdorff_distance(out[-1][2]) < _STEP:
            # About the same as below: one level with the larger of the two.
            start = out.pop()[0]
            out.append((start, high, outline))
        else:
            out.append((low, high, outline))
        low = high
    return out


def _within(above: Any, outline: Any) -> Any:
    """Outline within the one above, identical wherever nearly so, wider where joining corners would take of it."""
    needed = outline.intersection(above)
    for more in _WIDER:
        wider = grown(outline, more)
        lower = above.difference(apart(above, wider).difference(wider))
        largest = max(getattr(lower, "geoms", [lower]), key=lambda g: float(g.area))
        joined = joined_corners(largest, above)
        if needed.difference(joined.buffer(_LOSS)).is_empty and joined.difference(above).area < _LOSS**2:
            return joined
    return largest


def _wall(plan: ShoePlan, p: ShoeParameters) -> list[Block]:
    trim = min(_TRIM, 0.3 * p.rim_thickness, 0.3 * p.rim_height)
    cap = tapered(plan.rim, 0.0, -trim, p.rim_top - trim, p.rim_top)
    return [Block(plan.rim, p.bottom, p.rim_top - (trim if cap else 0.0)), *([cap] if cap else [])]


def _fillet(plan: ShoePlan, p: ShoeParameters) -> list[Block]:
    """Three facets of a quarter circle; smaller where the wall bends tightly."""
    angles = np.radians([0.0, 30.0, 60.0, 90.0])
    for radius in min(p.fillet, 0.5 * p.rim_height) * np.array([1.0, 0.5, 0.25]):
        out = radius * (1.0 - np.sin(angles))
        up = p.thickness + radius * (1.0 - np.cos(angles))
        facets = [tapered(plan.rim, out[i], out[i + 1], up[i], up[i + 1]) for i in range(3)] if radius > 0.0 else []
        if all(f is not None for f in facets):
            return [f for f in facets if f is not None]
    return []


def _scribe(cell: Any, p: ShoeParameters) -> Block | Groove:
    for width in p.scribe * np.array([1.0, 0.5, 0.25, 0.125]):  # narrower in a cut cell with a short edge
        inner = moved_edges(ring(cell), -width)
        if inner is not None:
            return Groove(cell, shapely.Polygon(inner), p.bottom, p.bottom + p.scribe)
    hole = cell.buffer(-0.1 * p.scribe, join_style="mitre")
    return Block(shapely.Polygon(ring(cell), [ring(hole)[::-1]]), p.bottom - 0.5, p.bottom + p.scribe)


def bare_floor(steps: tuple[Step, ...]) -> Any | None:
    """Shapely floor without what rises below the arch; None if all is bare."""
    place = (b for s in steps if s.name == _PLACE for b in s.blocks)  # from below: the first stands on the floor
    return next((b.low for b in place if isinstance(b, Block)), None)


def mark_outline(plan: ShoePlan, parameters: ShoeParameters, side: Side, floor: Any | None = None) -> Any:
    """Gives letters of the mark, L or R and name, on a plan of a side, by parameters, within its bare floor or
    everywhere: shapely, read with toes to the right.
    """
    from shapely.ops import polylabel

    name = "".join(c if c.isascii() and (c.isalnum() or c in "-_./") else " " for c in plan.layout.name)
    text = f"{side[0].upper()} {name[:_MARK_MOST]}".strip()
    between = plan.cavity.buffer(-_MARK_OFF)
    room = between if floor is None else between.intersection(floor.buffer(-_MARK_OFF))
    if parameters.mark_height <= 0.0 or room.is_empty:
        return shapely.MultiPolygon()
    widest = max(getattr(room, "geoms", [room]), key=lambda g: g.area)
    middles = (between.centroid, widest.centroid, polylabel(widest, 1.0))
    for line in (text, text[0]):
        height = parameters.mark_height
        while height >= 4.0:
            letters = lettering(line, height)
            for middle in middles:
                x = middle.x - letters.centroid.x
                y = middle.y - letters.centroid.y
                placed = shapely.affinity.translate(letters, round(x, 3), round(y, 3))
                if room.covers(placed):
                    return placed
            height -= 1.0
    return shapely.MultiPolygon()
