"""What feet stand on, or will when they land, by their soles (T 4.4.2-4.4.3)."""

import math
import operator
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import SIDES, Side
from plantar.gait.contact.ankle_limits import UPRIGHT, AnkleLimits
from plantar.gait.contact.ankle_reach import borne_part, loaded_middle
from plantar.gait.contact.edge_memory import EdgeMemory
from plantar.gait.contact.stance_contact import ContactSettings, StanceContact
from plantar.gait.estimate.sole_slope import SoleSlope
from plantar.gait.plan.feet_view import FeetView
from plantar.gait.plan.phases import Phase, PhaseKind
from plantar.geometry.inscribed import inscribed_circle
from plantar.geometry.polygon import area, convex_hull, inner_offset, signed_margin
from plantar.kernels.base.vectors import vector
from plantar.kernels.geometry.convex import seen_from_above
from plantar.layouts.layout import SoleLayout
from plantar.mechanics.base_state import BaseState
from plantar.mechanics.rotation import level_rotation
from plantar.percepts.percept import Percept
from plantar.percepts.sole_pose import feet_support_polygon, polygon_in_world

# chosen: steps after which a foothold that carried a part of the sole is no evidence of the ground ahead; two steps of
# each foot
REMEMBERED = 4
# chosen: rad from which a sole on a slope moves its ankle by more than encoders err; ten times the largest error of an
# encoder's zero
_LEANS = 0.05
# chosen: of the room around the best place by torques in which a whole sole keeps its middle; bounded by 0, where any
# sole is moved, and 1, where its edge holds it
_ASIDE = 0.5
_STANDING: dict[Side | None, tuple[Side, ...]] = {None: SIDES, "left": ("right",), "right": ("left",)}  # by swing
# chosen: of a support's inscribed circle that the margin takes at most: all of it leaves one ZMP; bounded by 0, where
# noise reaches the edge, and 1
_NARROW = 0.5


def middle_of_sole(
    layout: SoleLayout, reach: float = math.inf, limits: AnkleLimits | None = None, outward: float = 0.0
) -> NDArray[np.float64]:
    """Returns the VRP (2,) over a whole foothold of a `layout`, sole frame, in m
    (`plantar.gait.contact.ankle_reach`).

    `reach` is the distance in m along the sole at which the ankle bears the robot, `limits` by torques; `outward` the
    share of the way from there to the outer edge where a sole carries that leans.
    """
    outline = _carrying_outline(layout)
    middle = loaded_middle(outline, reach)
    best = _loaded(outline, reach, limits)
    near = limits is not None and math.dist(middle, best) <= _ASIDE * signed_margin(limits.within(outline), best)
    place = middle if near else best
    return place if outward == 0.0 else place + outward * (_outer_edge(outline, layout.side, place) - place)


def _outer_edge(outline: NDArray[np.float64], side: Side, place: NDArray[np.float64]) -> NDArray[np.float64]:
    """Point (2,) of a convex outline (k, 2) beside a `place` in it, away from the other foot."""
    x = place[0]
    ends = np.roll(outline, -1, axis=0)
    crossed = (outline[:, 0] <= x) != (ends[:, 0] <= x)
    start = outline[crossed]
    way = ends[crossed] - start
    y = start[:, 1] + way[:, 1] * (x - start[:, 0]) / way[:, 0]
    return np.array([x, y.max() if side == "left" else y.min()])


def _loaded(
    polygon: NDArray[np.float64],
    reach: float,
    limits: AnkleLimits | None,
    lean: NDArray[np.float64] = UPRIGHT,
    part: bool = False,
) -> NDArray[np.float64]:
    """Best place (2,) to load a polygon (k, 2), which may be a part of the sole."""
    center = loaded_middle(polygon, reach)
    weak = borne_part(polygon, reach) is not polygon  # such an ankle is loaded midway already
    return center if limits is None or weak else limits.center(polygon, center, lean, part)


def on_its_hull(layout: SoleLayout) -> SoleLayout:
    """Returns the `layout` with its outline's convex hull, which carries a rigid sole."""
    outline = _carrying_outline(layout)
    return layout if outline is layout.outline else replace(layout, outline=outline)


def _carrying_outline(layout: SoleLayout) -> NDArray[np.float64]:
    """Convex hull (k, 2) of a layout's outline in m; the outline itself where it is convex."""
    hull = convex_hull(layout.outline)
    # nature: floating point, far above an area's roundings
    return layout.outline if area(layout.outline) >= (1.0 - 1e-9) * area(hull) else hull


@dataclass(frozen=True)
class FootholdFound:
    """Foothold as found.

    Attributes:
        polygon: Support (k, 2), world frame, in m, counter-clockwise.
        area_ratio: Share of the sole's cells.
        vrp: (2,), world frame, in m.
        middle: Centroid (2,), world frame, in m: the VRP unless the ankle bears only a part.
        whole: Whether the whole sole carries.
        as_planned: Whether whole, and none other was found before.
        seen: Whether seen before touchdown; what loads alone show can change.
        rise: How much higher in m the robot stands over it.
    """

    step: int
    side: Side
    polygon: NDArray[np.float64]
    area_ratio: float
    vrp: NDArray[np.float64]
    middle: NDArray[np.float64]
    whole: bool = False
    as_planned: bool = False
    seen: bool = True
    rise: float = 0.0


@dataclass(frozen=True)
class FootholdSeen:
    """Partial foothold that a descending foot sees. `vrp`: VRP (2,), world frame, in m."""

    step: int
    side: Side
    vrp: NDArray[np.float64]


@dataclass
class _Foot:
    """A foot: taxels' view, load point (2,), carrying parts (k, 2) of its foothold, step; `rise` of the CoM in m."""

    contact: StanceContact
    center: NDArray[np.float64]
    borne: NDArray[np.float64]
    support: NDArray[np.float64] | None = None
    alone: NDArray[np.float64] | None = None
    step: int | None = None
    seen_partial: bool = False
    rise: float = 0.0


class FootContacts:
    """Contacts of both feet.

    Attributes `parts`: best place (2,) to load each foot that is known to stand on a part of its sole, sole frame, in
    m; `rise`: how much higher in m the robot has to stand over those; `mass_ratio`: its mass over the model's.

    `reach`: distance in m along the sole, from its origin, at which an ankle bears the robot; `limits`: each ankle's
    torque limits, or None; `sensing_range` of proximity, in m.
    """

    def __init__(
        self,
        settings: ContactSettings,
        layouts: Mapping[Side, SoleLayout],
        reach: float = math.inf,
        limits: Mapping[Side, AnkleLimits] | None = None,
        sensing_range: float = math.inf,
        outward: float = 0.0,
    ) -> None:
        self._settings = settings
        self._reach = reach
        self._limits = limits or {}
        self._middle = {side: middle_of_sole(layouts[side], reach, self._limits.get(side), outward) for side in SIDES}
        self._borne = {side: borne_part(layouts[side].outline, reach) for side in SIDES}
        self._alone = {side: self._within_limits(side, self._borne[side], UPRIGHT) for side in SIDES}
        self._feet = {
            side: _Foot(StanceContact(layouts[side], settings, sensing_range), self._middle[side], self._borne[side])
            for side in SIDES
        }
        self._edges = EdgeMemory(settings.body)
        self.parts: dict[Side, NDArray[np.float64]] = {}
        self.rise = 0.0
        self.mass_ratio = 1.0
        self._foreseen = -1
        self._part = -REMEMBERED - 1
        self._region_of: tuple[object, ...] = ()
        self._region_at: list[object] = []
        self._region = np.empty((0, 2))

    def center(self, side: Side) -> NDArray[np.float64]:
        """Best place (2,) to load a foot, sole frame, in m; of the whole sole while unknown."""
        return self._feet[side].center

    def polygon(self, side: Side) -> NDArray[np.float64]:
        """Part (k, 2) of a foothold that its ankle bears, sole frame, in m."""
        return self._feet[side].borne

    def firm(self, step: int) -> bool:
        """Whether the last footholds before a step were found, and seen ahead, whole."""
        return step > self._part + REMEMBERED

    def lift_off(self, side: Side, step: int) -> None:
        """Clear the foothold of a `side`'s swinging foot in a `step`."""
        foot = self._feet[side]
        foot.contact.lift()
        foot.support = None
        foot.alone = None
        foot.center = self._middle[side]
        foot.borne = self._borne[side]
        foot.step = step
        foot.seen_partial = False
        self._stand_on_part(side, False)
        if self._foreseen == step:  # a step that is taken once more
            self._foreseen = -1

    def touchdown(self, side: Side) -> None:
        """Landed: the foot stands on what it saw until loads show more."""
        foot = self._feet[side]
        ground = foot.contact.foresee(np.zeros(2))
        if ground is not None:
            foot.center = _loaded(ground, self._reach, self._limits.get(side), part=True)
            foot.borne = borne_part(ground, self._reach)
        foot.seen_partial = ground is not None
        self._stand_on_part(side, foot.seen_partial)

    def coming_to_carry(self, phase: Phase, time: float, feet: FeetView) -> Sequence[Side]:
        """Returns sides of `feet` (commanded), left first, that take weight over in a `phase` at a `time` in s, or
        landed and wait for it.
        """
        swing = phase.swing
        carrying = phase.kind == PhaseKind.DOUBLE_SUPPORT
        if phase.kind == PhaseKind.SINGLE_SUPPORT:
            carrying = time < phase.start + self._settings.watch
        landed = feet.landed
        if not carrying and not (landed and swing is not None):
            return ()
        sides: list[Side] = []
        for side, foot in self._feet.items():
            step = foot.step
            if step is not None and ((carrying and step == phase.step - 1) or (landed and swing == side)):
                sides.append(side)
        return sides

    def find_ahead(
        self, phase: Phase, time: float, feet: FeetView, state: BaseState, soles: Mapping[Side, Percept]
    ) -> FootholdSeen | None:
        """Returns the swing foot's coming foothold, once a step, if seen and not whole.

        In a walk's `phase` at a `time` in s, by commanded `feet`, the estimated `state` and the view of each sole,
        `soles`.
        """
        side = phase.swing
        if side is None or feet.landed:
            return None
        contact = self._feet[side].contact
        rules = self._settings
        contact.update_view(soles[side].reading)
        if self._foreseen == phase.step or math.hypot(*feet.ahead.tolist()) > rules.foresee_reach:
            return None
        if phase.end - time < rules.foresee_least:
            return None
        turn = state.rotations_sole[side][:2, :2]
        ground = contact.foresee(turn.T @ feet.ahead)
        if ground is None:
            return None
        self._foreseen = phase.step
        self._part = phase.step
        center = _loaded(ground, self._reach, self._limits.get(side), -state.rotations_sole[side][2, :2], part=True)
        return FootholdSeen(phase.step, side, state.positions_sole[side][:2] + feet.ahead + turn @ center)

    def find(
        self,
        coming: Sequence[Side],
        state: BaseState,
        soles: Mapping[Side, Percept],
        slope: SoleSlope | None = None,
    ) -> tuple[FootholdFound, ...]:
        """Returns footholds of feet `coming` to carry (`coming_to_carry`), when found or changed.

        By the estimated `state`, the percept of each sole, `soles`, and its `slope` against the ground, where followed.
        """
        found = []
        for side in coming:
            rises = None if slope is None else slope.slope(side)
            if rises is not None and self._settings.remember:
                self._remember(side, state)
            if self._feet[side].contact.update(soles[side].reading, state.loads[side], rises):
                found.append(self._taken(side, state))
        return tuple(found)

    def _remember(self, side: Side, state: BaseState) -> None:
        """Let a landing foot presume the last foothold's edges."""
        foot = self._feet[side]
        if foot.step is not None and not foot.contact.settled:
            place = state.positions_sole[side]
            turn = state.rotations_sole[side]
            foot.contact.expect(self._edges.expected(foot.step, place, turn))

    def _taken(self, side: Side, state: BaseState) -> FootholdFound:
        foot = self._feet[side]
        contact = self._feet[side].contact
        assert foot.step is not None
        known = foot.support is not None
        position = state.positions_sole[side]
        rotation = state.rotations_sole[side]
        self._edges.update(foot.step, contact.lines, contact.center_in_sole, position, rotation)
        polygon = polygon_in_world(contact.polygon_in_sole, rotation, position)
        lean = -rotation[2, :2]
        leans = side in self._limits and math.hypot(*lean.tolist()) > _LEANS
        part = not contact.whole
        center = _loaded(contact.polygon_in_sole, self._reach, self._limits.get(side), lean, part)
        vrp, middle = ((position + rotation[:, :2] @ place)[:2] for place in (center, contact.center_in_sole))
        # Where less was seen ahead, the plan uses that; what is found now has to correct it.
        if part:
            self._part = foot.step
        as_planned = contact.whole and not known and self._foreseen != foot.step and not (foot.seen_partial or leans)
        foot.seen_partial = False
        if not as_planned:
            foot.center = center
            foot.borne = borne_part(contact.polygon_in_sole, self._reach)
            every = foot.borne is contact.polygon_in_sole
            foot.support = polygon if every else polygon_in_world(foot.borne, rotation, position)
            foot.alone = polygon_in_world(self._within_limits(side, foot.borne, lean, part), rotation, position)
        self._stand_on_part(side, part)
        ratio = contact.area_ratio
        whole = contact.whole
        seen = contact.seen
        return FootholdFound(foot.step, side, polygon, ratio, vrp, middle, whole, as_planned, seen, foot.rise)

    def _stand_on_part(self, side: Side, part: bool) -> None:
        """Keep whether a foot stands on a part of its sole, and how high over it."""
        foot = self._feet[side]
        limits = self._limits.get(side)
        foot.rise = 0.0
        self.parts.pop(side, None)
        if part:
            self.parts[side] = foot.center
            foot.rise = 0.0 if limits is None else limits.rise(foot.center, self.mass_ratio)
        self.rise = max(foot.rise for foot in self._feet.values())

    def _within_limits(
        self, side: Side, polygon: NDArray[np.float64], lean: NDArray[np.float64], part: bool = False
    ) -> NDArray[np.float64]:
        limits = self._limits.get(side)
        return polygon if limits is None else limits.within(polygon, lean, part)

    def zmp_region(
        self, phase: Phase, feet: FeetView, frame_offset: Sequence[float], margin: float
    ) -> NDArray[np.float64]:
        """Returns the desired ZMP's region: support polygon (k, 2), world frame, in m, moved in by a `margin` in m.

        Unknown support counts as the whole sole; a single foot within its ankle's torques. `phase` is the walk's,
        `feet` the commanded, `frame_offset` (3,) of the command frame in the world in m.
        """
        standing = SIDES if feet.landed else _STANDING[phase.swing]
        alone = len(standing) == 1
        first = standing[0]
        last = standing[-1]
        now = (
            alone,
            feet.footholds[first],
            self._feet[first].support,
            feet.footholds[last],
            self._feet[last].support,
        )
        # Mostly the same objects as a tick ago; a foothold of another height has the same region.
        if self._region_of and all(map(operator.is_, self._region_of, now)):
            return self._region
        self._region_of = now
        places: list[object] = [alone]
        for side in standing:
            position, yaw = feet.footholds[side]
            support = self._feet[side].support
            places.append((side, float(position[0]), float(position[1]), yaw) if support is None else id(support))
        if places != self._region_at:
            parts = []
            for side in standing:
                foot = self._feet[side]
                support = foot.alone if alone else foot.support
                if support is None:
                    position, yaw = feet.footholds[side]
                    x, y, _ = frame_offset
                    place = vector(position.item(0) + x, position.item(1) + y, 0.0)
                    # By the kernel itself: what is checked of a caller's polygon takes four times as long.
                    support = seen_from_above((self._alone if alone else self._borne)[side], level_rotation(yaw), place)
                parts.append(support)
            support = feet_support_polygon(parts)
            circle = inscribed_circle(support)
            self._region = inner_offset(support, 0.0 if circle is None else min(margin, _NARROW * circle.radius))
            self._region.flags.writeable = False
            self._region_at = places
        return self._region
