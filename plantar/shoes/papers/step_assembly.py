"""Shoe parts in place, as named bodies of a STEP assembly. In mm."""

import numpy as np
import shapely
from numpy.typing import NDArray

from plantar.shoes.build import Shoe, ShoeBuild
from plantar.shoes.checks.printability import BOARD_UP
from plantar.shoes.geometry.outline import ring
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.block import Block, Step
from plantar.shoes.plan.keep_out import keep_out, strap_path
from plantar.shoes.plan.shoe_plan import ShoePlan, pad_rim
from plantar.shoes.solid.kernel import build_solid
from plantar.shoes.solid.pad import land_top, taxel_blocks
from plantar.shoes.solid.polyhedron import Polyhedron
from plantar.shoes.solid.retention import slot_lines
from plantar.shoes.solid.step_model import StepPart

_SAME = 1e-3  # mm: bodies whose corners lie nearer are one product
_DETAIL = 0.1  # mm of the pad's rim that is dropped
_HERE = (0.0, 0.0, 0.0)


def assembly_parts(shoe: Shoe, build: ShoeBuild) -> list[StepPart]:
    """Gives parts of a build's shoe, printed first, taxels, pad, board, straps; in the sole frame."""
    assert shoe.solid is not None
    plan = shoe.plan
    p = build.parameters
    name = f"{build.kind} {shoe.side}"
    parts = [StepPart(f"{shoe.layout.name} {name}", shoe.solid, {name: _HERE}), *_taxels(plan, p)]
    if p.pad_thickness > 0.0:
        parts.append(StepPart("pad", _pad(plan, p), {"pad": _HERE}))
    if plan.heel.board:
        gap = p.board_gap + p.made_by.slide
        half = 0.5 * p.board_length
        face = plan.heel.placed(shapely.box(-gap - p.board_thickness, -half, -gap, half))
        board = _solid(Block(face, p.thickness, p.thickness + BOARD_UP))
        parts.append(StepPart("connection board", board, {"connection board": _HERE}))
    return parts + _straps(shoe, build)


def _solid(*blocks: Block) -> Polyhedron:
    return build_solid([Step("add", "body", blocks)])


def _taxels(plan: ShoePlan, p: ShoeParameters) -> list[StepPart]:
    """Taxels as in the layout; equal shapes are one product in several places."""
    what = "taxel" if not plan.lands else "sheet" if plan.lines is not None else "cell"
    shapes: dict[bytes, tuple[list[Block], dict[str, tuple[float, float, float]]]] = {}
    for number, blocks in zip(plan.layout.ids.tolist(), taxel_blocks(plan, p), strict=False):  # or one sheet
        x, y = np.array(blocks[-1].low.centroid.coords[0]).round(4).tolist()
        own = [Block(shapely.affinity.translate(b.low, -x, -y), b.z_low, b.z_high) for b in blocks]
        key = b"".join(_from_lowest(ring(b.low), _SAME).tobytes() for b in own)
        shapes.setdefault(key, (own, {}))[1][what if len(plan.pockets) == 1 else f"{what} {number}"] = (x, y, 0.0)
    return [
        StepPart(what if len(shapes) == 1 else f"{what} shape {n}", _solid(*blocks), places)
        for n, (blocks, places) in enumerate(shapes.values(), start=1)
    ]


def _from_lowest(points: NDArray[np.float64], grid: float) -> NDArray[np.int64]:
    places = np.rint(points / grid).astype(np.int64)
    return np.roll(places, -int(np.lexsort(places.T)[0]), axis=0)


def _pad(plan: ShoePlan, p: ShoeParameters) -> Polyhedron:
    low = 0.5 * p.pad_thickness
    high = p.pad_thickness + p.pad_rim_height
    within = pad_rim(plan, p).buffer(-2.0 * _DETAIL, join_style="mitre").buffer(_DETAIL, join_style="mitre")
    rim = [Block(q, low, high) for q in shapely.get_parts(within.simplify(_DETAIL)) if not q.is_empty]
    lands = [Block(q, low, land_top(plan, p)) for q in plan.lands]
    return _solid(Block(plan.contact, 0.0, p.pad_thickness), *rim, *lands)


def _straps(shoe: Shoe, build: ShoeBuild) -> list[StepPart]:
    retention = build.retention
    p = build.parameters
    if retention is None or retention.kind != "straps":
        return []
    out = []
    foot = keep_out(build.foot)
    flip = 1.0 if shoe.side == "left" else -1.0
    for n, x in enumerate(dict.fromkeys(q.x for q in retention.places), start=1):
        right, left = slot_lines(build.foot.passing(p.rim_height), x, retention.width, p)
        # it comes up between lug and foot
        slot = p.rim_height + 1.0
        lug = p.rim_thickness + 0.5 * p.strap_thickness
        over = strap_path(foot.surface, x, retention.width, (right + lug, left - lug), slot)
        path = np.vstack([[right, slot], over, [left, slot]]) + np.array([0.0, p.thickness + 0.5 * p.strap_thickness])
        line = shapely.LineString(path).simplify(0.5)
        band = line.buffer(0.5 * p.strap_thickness, cap_style="flat", join_style="mitre")
        flat = _solid(Block(band, 0.0, retention.width))
        y, z, along = flat.corners.T
        turned = np.column_stack([x - 0.5 * retention.width + along, y * flip, z])
        faces = flat.faces if flip > 0.0 else tuple(tuple(loop[::-1] for loop in f) for f in flat.faces)
        out.append(StepPart(f"strap {n}", Polyhedron(turned, faces), {f"strap {n}": _HERE}))
    return out
