"""What holds the shoe on an unchanged robot: clips, strap lugs, or screws."""

import math
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import shapely

from plantar.errors import FootError
from plantar.shoes.foot.foot import Foot
from plantar.shoes.geometry.outline import grown, tidy
from plantar.shoes.geometry.surface import surface_points
from plantar.shoes.parameters import ShoeParameters
from plantar.shoes.plan.block import Block, Step, box_block
from plantar.shoes.plan.keep_out import KeepOut, keep_out
from plantar.shoes.plan.pull_off import SNAP_MOST, PullOff, pull_off
from plantar.shoes.plan.shoe_plan import ShoePlan
from plantar.shoes.plan.strength import load_case

_LUG_END = 5.0  # mm of lug before and behind a slot
_BAR = 4.0  # mm of lug above a slot
_SLOT_PLAY = 2.0  # mm of slot more than the strap, along and up
_ARM_GAP = 1.2  # mm between a clip's arm and the wall next to it
_LEAST_ARM = 8.0  # mm: a shorter arm is too stiff
_ROOT = 6.0  # mm of an arm's root within the plate
_HEAVY = 1.4e-6  # kg/mm^3: worn mass over contact face and thickness, wall and skin counted
_SAMPLES = 1.5  # mm between points on the foot
_ROUND = 8.0  # mm that a wall may bend away along a lug
_SCREW_REACH = 1.2  # of its diameter: how far a screw that fills its nut comes out of the wall
_THREADS = (2.5, 3.0, 4.0, 5.0, 6.0)  # mm: diameters of set screws that are made (ISO 4026)
_PLAY = 0.2  # mm between a clip's hook and the foot's edge


@dataclass(frozen=True)
class _Place:
    """Place on the left (+1) or right (-1) wall: middle x, and for a clip the foot edge's height."""

    x: float
    side: int
    edge: float = 0.0


@dataclass(frozen=True)
class Retention:
    """How the shoe is held.

    `width` of strap or clip, or screw's diameter in mm; `strain` of a clip's arm snapping on; 0 without clips.
    """

    kind: Literal["clips", "straps", "screws", "none"]
    places: tuple[_Place, ...]
    width: float
    strain: float
    note: str

    @property
    def straps(self) -> int:
        return len(self.places) // 2 if self.kind == "straps" else 0

    def top(self, parameters: ShoeParameters) -> float:
        """Highest part above the foot's face, in mm."""
        p = parameters
        if self.kind == "straps":
            return p.rim_height + p.strap_thickness + _SLOT_PLAY + _BAR + 1.0
        if self.kind == "clips":
            return max(place.edge for place in self.places) + _hook_height(p)
        return p.rim_height

    def pull_off(self, foot: Foot, worn: float, mass: float, parameters: ShoeParameters) -> PullOff:
        """Gives holding forces of a shoe of worn mass in kg on a foot of a robot of a mass in kg, by parameters."""
        arms = tuple((q.x, q.edge + 0.5 * _hook_height(parameters)) for q in self.places)
        return pull_off(self.kind, arms, self.width, foot.sole.bounds[0], worn, mass, parameters)


def choose_retention(foot: Foot, plan: ShoePlan, parameters: ShoeParameters) -> Retention:
    """Gives clips where a foot has edges, else strap lugs, or the parameters' kind, by left plan."""
    p = parameters
    length = plan.foot.bounds[2] - plan.foot.bounds[0]
    if p.retention == "none":
        return Retention("none", (), 0.0, 0.0, "nothing holds the shoe but the fit, as asked for")
    if p.retention == "screws":
        return _screws(foot, plan, p, "four clamping screws through the wall, as asked for")
    reason = "as asked for"
    if p.retention in ("auto", "clips"):
        clips, reason = _clips(foot, plan, p)
        if clips is not None:
            return clips
        if p.retention == "clips":
            raise FootError(f"no clips: {reason}; use straps")
    width = round(min(p.strap_width, length / 6.0), 1)
    places = _strap_places(foot, plan, width, p)
    if not places:
        reason = f"{reason}; the robot's other links leave no room for a strap"
        if p.retention == "straps":
            raise FootError(f"no straps: {reason}; use screws")
        return _screws(foot, plan, p, f"four clamping screws: {reason}")
    text = "a strap" if len(places) == 2 else "two straps"
    return Retention("straps", places, width, 0.0, f"lugs for {text} of {width:g} mm: {reason}")


def _screws(foot: Foot, plan: ShoePlan, p: ShoeParameters, note: str) -> Retention:
    places = _screw_places(plan, p)
    wide = p.screw_diameter
    if wide not in _THREADS:
        raise FootError(
            f"screw_diameter is {wide:g} mm, which no set screw has; allowed: {', '.join(f'{t:g}' for t in _THREADS)}"
        )
    middle = plan.foot.centroid.y
    if foot.triangles is not None:
        x, y, above = (surface_points(foot.triangles, _SAMPLES) - np.array([0.0, 0.0, 0.5 * p.rim_height])).T
        level = (above >= 0.25 * wide) & (above <= wide)
        for q in places:
            wall = q.side * _wall_line(plan.cavity, q.x, q.side, 0.5 * wide, middle)[0]
            gap = wall - np.max(q.side * y[level & (np.abs(x - q.x) <= wide)], initial=-math.inf)
            if gap > _SCREW_REACH * wide:
                raise FootError(
                    f"no screws: M{wide:g} screws {0.5 * p.rim_height:g} mm above the sole (half of rim_height) would "
                    "pass over the foot, or not reach it; use straps, or another rim_height"
                )
    return Retention("screws", places, wide, 0.0, note)


def _screw_places(plan: ShoePlan, p: ShoeParameters) -> tuple[_Place, ...]:
    low, _, high, _ = plan.foot.bounds
    return tuple(
        _straightest(plan, 0.5 * (low + high), high - low, share, side, p)
        for share in (-0.25, 0.25)
        for side in (1, -1)
    )


def _strap_places(foot: Foot, plan: ShoePlan, width: float, p: ShoeParameters) -> tuple[_Place, ...]:
    """Lugs at usual places, or as far apart as other links allow."""
    low, _, high, _ = plan.foot.bounds
    length = high - low
    middle = 0.5 * (low + high)
    two = length >= 6.0 * p.strap_width + 4.0 * _LUG_END
    usual = [round(middle + share * length, 3) for share in ((-0.2, 0.24) if two else (0.0,))]
    others = keep_out(foot)
    free = [x for x in usual if strap_meets(others, plan.foot, x, width, p) == 0]
    if len(free) < len(usual):
        half = 0.5 * width + _LUG_END
        y = plan.foot.centroid.y
        tries = [round(x, 3) for x in np.arange(low + half, high - half, 2.0).tolist()]
        tries = [x for x in tries if max(_wall_line(plan.foot, x, s, half, y)[1] for s in (1, -1)) < _ROUND]

        def first(order: list[float]) -> float | None:
            return next((x for x in order if strap_meets(others, plan.foot, x, width, p) == 0), None)

        apart = width + 2.0 * _LUG_END + _SLOT_PLAY
        free = [x for q in usual if (x := first(sorted(tries, key=lambda x: abs(x - q)))) is not None]
        if len(free) == 2 and free[1] - free[0] < apart:
            free = [x for order in (tries, tries[::-1]) if (x := first(order)) is not None]
            free = free if free[1] - free[0] >= apart else free[1:]
    return tuple(_Place(x, side) for x in free for side in (1, -1))


def strap_meets(others: KeepOut, outline: Any, x: float, width: float, parameters: ShoeParameters) -> int:
    """Gives number of points of others (robot links) in the way of a strap at x of a width in mm and its lugs, by foot
    outline and parameters.
    """
    p = parameters
    y = outline.centroid.y
    half = 0.5 * (width + _SLOT_PLAY) + _LUG_END
    top = p.rim_height + p.strap_thickness + _SLOT_PLAY + _BAR + 1.0
    count = 0
    ends = slot_lines(outline, x, width, p)
    for side, out in zip((-1, 1), ends, strict=True):
        edge = _wall_line(outline, x, side, half, y)[0]
        count += others.meets((x - half, min(edge, out), 0.0), (x + half, max(edge, out), top))
    return count + others.strap_meets(x, width, ends, p.rim_height + 1.0, p.strap_thickness)


def slot_lines(outline: Any, x: float, width: float, parameters: ShoeParameters) -> tuple[float, float]:
    """Gives outer y of right and left lug; outline, x, width, parameters as in `strap_meets`."""
    p = parameters
    half = 0.5 * (width + _SLOT_PLAY) + _LUG_END
    out = p.clearance + p.strap_thickness + p.rim_thickness
    right, left = (_wall_line(outline, x, side, half, outline.centroid.y)[0] for side in (-1, 1))
    return right - out, left + out


def _straightest(plan: ShoePlan, middle: float, length: float, share: float, side: int, p: ShoeParameters) -> _Place:
    tries = [middle + (share + 0.02 * k) * length for k in (0, 1, -1, 2, -2, 3, -3, 4, -4, 5, -5)]
    bends = [_wall_line(plan.rim, x, side, p.screw_diameter + 3.0, plan.foot.centroid.y)[1] for x in tries]
    return _Place(round(tries[int(np.argmin(np.round(bends, 2)))], 3), side)


def _clips(foot: Foot, plan: ShoePlan, p: ShoeParameters) -> tuple[Retention | None, str]:
    if foot.triangles is None:
        return None, "the foot's upper side is not known"
    low, _, high, _ = plan.foot.bounds
    length = high - low
    middle = 0.5 * (low + high)
    samples = surface_points(foot.triangles, _SAMPLES)
    others = keep_out(foot)
    outline = foot.passing(min(foot.height, p.clip_height_max))
    places = []
    strain = 0.0
    for share in (-0.27, 0.27):
        for side in (1, -1):
            x = middle + share * length
            edge = _edge_height(samples, outline, p, x, side)
            if edge is None:
                return None, "the foot's upper edge is not straight and free where a clip would hold"
            if edge > p.clip_height_max:
                return None, f"the foot's upper edge lies {edge:.0f} mm high, above clip_height_max"
            arm = edge + 0.5 * _hook_height(p)
            y = _wall_line(outline, x, side, 0.5 * p.clip_width, plan.foot.centroid.y)[0]
            inner, outer = sorted((y - side * p.clip_hook, y + side * (p.clearance + p.clip_thickness)))
            box = ((x - 0.5 * p.clip_width, inner, 0.0), (x + 0.5 * p.clip_width, outer, edge + _hook_height(p)))
            if others.meets(*box):
                return None, "another link of the robot passes where a clip would hold"
            if edge < _LEAST_ARM:
                return None, f"the foot's upper edge lies {edge:.0f} mm high, too low for an arm that bends"
            strain = max(strain, 1.5 * p.clip_thickness * p.clip_hook / arm**2)
            places.append(_Place(round(x, 3), side, round(edge, 3)))
    if strain > p.printed.strain:
        return None, (
            f"a clip's arm would be strained by {100 * strain:.1f} %, {p.material} takes {100 * p.printed.strain:.1f} %"
        )
    note = "four clips over the foot's upper edge: " + ", ".join(f"{q.edge:.1f}" for q in places) + " mm high"
    clips = Retention("clips", tuple(places), p.clip_width, strain, note)
    held = clips.pull_off(foot, _HEAVY * plan.contact.area * p.thickness, load_case(foot, p).mass, p)
    if held.force < held.swing:
        return None, f"four clips would hold {held.force:.0f} N, 5 g on the shoe in swing are {held.swing:.0f} N"
    if held.moment < held.scuff:
        return None, f"four clips would hold {held.moment:.2f} N m in a scuff at the toe, which takes {held.scuff:.2f}"
    if held.snap > SNAP_MOST:
        return None, f"a clip would take {held.snap:.0f} N to snap on, a person pushes with {SNAP_MOST:g} N"
    return clips, ""


def _window(x: float, side: int, half: float, y: float) -> Any:
    return (
        shapely.box(x - half, y, x + half, y + 1000.0) if side > 0 else shapely.box(x - half, y - 1000.0, x + half, y)
    )


def _wall_line(outline: Any, x: float, side: int, half: float, y: float) -> tuple[float, float]:
    """Outermost y of an outline within a window, and how much less at its ends."""
    strip = outline.intersection(_window(x, side, half, y))
    if strip.is_empty:
        return y, math.inf
    farthest = strip.bounds[3] if side > 0 else strip.bounds[1]
    ends = [outline.intersection(_window(e, side, 0.05, y)) for e in (x - half, x + half)]
    if any(e.is_empty for e in ends):
        return farthest, math.inf
    return farthest, max(abs(farthest - (e.bounds[3] if side > 0 else e.bounds[1])) for e in ends)


def _edge_height(samples: Any, outline: Any, p: ShoeParameters, x: float, side: int) -> float | None:
    """Foot's upper edge height at a place of its outline; None if not straight."""
    half = 0.5 * p.clip_width
    farthest, bend = _wall_line(outline, x, side, half, outline.centroid.y)
    if bend > 1.0:
        return None
    inside = (np.abs(samples[:, 0] - x) <= half) & (side * (farthest - samples[:, 1]) <= p.clip_hook + 1.0 + bend)
    return float(samples[inside, 2].max()) if inside.any() else None


def _hook_height(p: ShoeParameters) -> float:
    return 2.0 * (p.clip_hook + p.clearance) + 1.0


def retention_steps(
    foot: Foot, plan: ShoePlan, retention: Retention, parameters: ShoeParameters
) -> tuple[list[Block], list[Step]]:
    """Gives holders' blocks of the left shoe's body, and steps after the foot's place is cut, by foot, plan, retention
    and parameters.
    """
    if retention.kind == "straps":
        return _lugs(foot, plan, retention, parameters)
    if retention.kind == "clips":
        return [], _arms(foot, plan, retention, parameters)
    return _bosses(plan, retention, parameters) if retention.kind == "screws" else ([], [])


def _lugs(foot: Foot, plan: ShoePlan, retention: Retention, p: ShoeParameters) -> tuple[list[Block], list[Step]]:
    top = retention.top(p)
    outline = tidy(foot.passing(top).union(plan.foot))
    inner = tidy(grown(outline, p.clearance + p.strap_thickness))
    outer = tidy(grown(outline, p.clearance + p.strap_thickness + p.rim_thickness))
    middle = plan.foot.centroid.y
    half = 0.5 * (retention.width + _SLOT_PLAY) + _LUG_END
    slot_low = p.rim_top + 1.0
    slot_high = slot_low + p.strap_thickness + _SLOT_PLAY
    bevel = min(p.fillet + 1.0, _LUG_END - 1.0)
    blocks = []
    cuts = []
    for place in retention.places:
        lug = outer.intersection(_window(place.x, place.side, half, middle))
        blocks.append(Block(tidy(lug), p.bottom, p.thickness + top))
        slot = _window(place.x, place.side, 0.5 * (retention.width + _SLOT_PLAY), middle)
        bevels = (_bevel(place, end, half, bevel, middle, p.thickness + top) for end in (-1, 1))
        cuts += [Block(slot, slot_low, slot_high), *bevels]
    room = Block(inner, p.rim_top, p.thickness + top + 1.0)
    return blocks, [Step("cut", "room and slots of the straps", (room, *cuts))]


def _bevel(place: _Place, end: int, half: float, size: float, middle: float, top: float) -> Block:
    y = sorted((middle, middle + place.side * 1000.0))
    at = place.x + end * half

    def strip(inwards: float) -> Any:
        xs = sorted((at - end * inwards, at + end * 1.0))
        return shapely.box(xs[0], y[0], xs[1], y[1])

    return Block(strip(-0.02), top - size, top + 0.5, strip(size + 0.5 - 0.02))


def _arms(foot: Foot, plan: ShoePlan, retention: Retention, p: ShoeParameters) -> list[Step]:
    outline = foot.passing(min(foot.height, p.clip_height_max))
    middle = plan.foot.centroid.y
    half = 0.5 * retention.width
    gaps = []
    arms = []
    for place in retention.places:
        side = place.side
        gaps.append(Block(_window(place.x, side, half + _ARM_GAP, middle), p.thickness, p.rim_top + 100.0))
        farthest, _ = _wall_line(outline, place.x, side, half, middle)
        inner = farthest + side * p.clearance
        outer = inner + side * p.clip_thickness
        top = p.thickness + place.edge + _hook_height(p)

        def plate(start: float, end: float, x: float = place.x) -> Any:
            return shapely.box(x - half, min(start, end), x + half, max(start, end))

        root = plate(inner - side * _ROOT, outer)  # to the plate, where the foot is wider above than below
        low = p.ceiling + p.scribe  # above the pockets, which reach below the wall
        arms += [Block(root, low, p.thickness - p.mark_depth), Block(plate(inner, outer), low, top)]
        reach = p.clip_hook + p.clearance
        # The foot's edge touches the 45 degree face where it has come in by the clearance.
        low = p.thickness + place.edge + _PLAY - p.clearance
        bite = 0.5 * p.clip_thickness * side
        tip = inner - side * reach
        thin = plate(inner, inner + bite)
        thick = plate(tip, inner + bite)
        high = low + reach
        arms += [Block(thin, low, high, thick), Block(thick, high, high + 1.0)]
        arms.append(Block(thick, high + 1.0, low + 2.0 * reach + 1.0, thin))
    return [Step("cut", "windows of the clips", tuple(gaps)), Step("add", "clips", tuple(arms))]


def _bosses(plan: ShoePlan, retention: Retention, p: ShoeParameters) -> tuple[list[Block], list[Step]]:
    middle = plan.foot.centroid.y
    diameter = retention.width
    half = diameter + 3.0
    depth = 0.8 * diameter + 2.0
    nut_width = 1.8 * diameter + 0.4
    nut_height = 0.8 * diameter + 0.4
    hole_z = p.thickness + 0.5 * p.rim_height
    blocks = []
    cuts = []
    for place in retention.places:
        line, _ = _wall_line(plan.rim, place.x, place.side, half, middle)
        start, end = sorted((line - place.side * (p.rim_thickness + 1.0), line + place.side * depth))
        blocks.append(box_block((place.x - half, start, p.bottom), (place.x + half, end, p.rim_top)))
        cuts += _hole(place, middle, 0.5 * (diameter + 0.3), hole_z)
        at = sorted((line - place.side * 0.2, line + place.side * (nut_height - 0.2)))
        cuts.append(
            box_block(
                (place.x - 0.5 * nut_width, at[0], hole_z - 0.5 * nut_width),
                (place.x + 0.5 * nut_width, at[1], p.rim_top + 1.0),
            )
        )
    return blocks, [Step("cut", "holes and nuts of the clamping screws", tuple(cuts))]


def _hole(place: _Place, middle: float, radius: float, height: float) -> list[Block]:
    """Eight-sided, so that the roof supports itself."""
    y = sorted((middle, middle + place.side * 1000.0))
    narrow = radius * math.tan(math.pi / 8.0)

    def strip(half: float) -> Any:
        return shapely.box(place.x - half, y[0], place.x + half, y[1])

    return [
        Block(strip(narrow), height - radius, height - narrow, strip(radius)),
        Block(strip(radius), height - narrow, height + narrow),
        Block(strip(radius), height + narrow, height + radius, strip(narrow)),
    ]
