"""What both feet stand on, and what a foot that comes down will stand on: found by their soles (T 4.4.2-4.4.3)."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plantar.gait.contact.ankle_limits import AnkleLimits
from plantar.gait.contact.ankle_reach import borne_part, loaded_middle
from plantar.gait.contact.edge_memory import EdgeMemory
from plantar.gait.contact.stance_contact import ContactSettings, StanceContact
from plantar.gait.estimate.sole_slope import SoleSlope
from plantar.gait.plan.feet_view import FeetView
from plantar.gait.plan.phases import Phase, PhaseKind
from plantar.geometry.polygon import inner_offset
from plantar.layouts.layout import SoleLayout
from plantar.mechanics.base_state import BaseState
from plantar.mechanics.rotation import level_rotation
from plantar.percepts.percept import Percept
from plantar.percepts.sole_pose import feet_support_polygon, polygon_in_world
from plantar.sides import SIDES, Side

__all__ = ["FootContacts", "FootholdFound", "FootholdSeen", "middle_of_sole"]


_FORGETS = 4  # steps after which a foothold that carried a part of the sole is no evidence of the ground ahead


def middle_of_sole(layout: SoleLayout, reach: float = math.inf) -> NDArray[np.float64]:
    """Place (2,) of the VRP over a whole foothold, in the sole frame in m (`plantar.gait.contact.ankle_reach`).

    Args:
        layout: The sole.
        reach: Distance in m from the sole frame's origin, along the sole, at which the ankle bears the robot.

    Returns:
        The place.
    """
    return loaded_middle(layout.outline, reach)


@dataclass(frozen=True)
class FootholdFound:
    """What a foot was found to stand on.

    Attributes:
        step: The step that put it down.
        side: Which foot.
        polygon: Support polygon (k, 2) in the world in m, counter-clockwise.
        area_ratio: Its share of the sole's cells.
        vrp: VRP (2,) over it in the world in m.
        middle: Its centroid (2,) in the world in m: the VRP unless the ankle bears the robot on a part of it.
        whole: Whether it carries the whole sole.
        as_planned: Whether it is whole, and no other was found before.
        seen: Whether the sole saw it before it touched; what loads alone show may change.
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


@dataclass(frozen=True)
class FootholdSeen:
    """What a foot that comes down was seen to stand on soon, where that is not the whole sole.

    Attributes:
        step: The step that puts it down.
        side: Which foot.
        vrp: VRP (2,) over it in the world in m.
    """

    step: int
    side: Side
    vrp: NDArray[np.float64]


@dataclass
class _Foot:
    """One foot: its taxels' view, its load point (2,), the parts (k, 2) of its foothold that carry, and its step."""

    contact: StanceContact
    center: NDArray[np.float64]
    borne: NDArray[np.float64]
    support: NDArray[np.float64] | None = None
    alone: NDArray[np.float64] | None = None
    step: int | None = None
    seen_partial: bool = False


class FootContacts:
    """Contacts of both feet.

    Args:
        settings: How the contact polygon is found.
        layouts: Sole layout of each side.
        reach: Distance in m from the sole frame's origin, along the sole, at which an ankle bears the robot.
        limits: Torque limits of each ankle; None for no limit.
        sensing_range: Range of the proximity sensors in m.
    """

    def __init__(
        self,
        settings: ContactSettings,
        layouts: Mapping[Side, SoleLayout],
        reach: float = math.inf,
        limits: Mapping[Side, AnkleLimits] | None = None,
        sensing_range: float = math.inf,
    ) -> None:
        self._settings = settings
        self._reach = reach
        self._limits = limits or {}
        self._middle = {side: middle_of_sole(layouts[side], reach) for side in SIDES}
        self._borne = {side: borne_part(layouts[side].outline, reach) for side in SIDES}
        self._alone = {side: self._within_limits(side, self._borne[side]) for side in SIDES}
        self._feet = {
            side: _Foot(StanceContact(layouts[side], settings, sensing_range), self._middle[side], self._borne[side])
            for side in SIDES
        }
        self._edges = EdgeMemory(settings.body)
        self._foreseen = -1
        self._part = -_FORGETS - 1
        self._region_of: list[object] = []
        self._region = np.empty((0, 2))

    def center(self, side: Side) -> NDArray[np.float64]:
        """Best place (2,) to load a foot in its sole frame in m; of the whole sole while its foothold is not known."""
        return self._feet[side].center

    def polygon(self, side: Side) -> NDArray[np.float64]:
        """The part (k, 2) of a foothold on which its ankle bears the robot, in its sole frame in m."""
        return self._feet[side].borne

    def partial(self, side: Side) -> bool:
        """Whether a foot is known to stand on a part of its sole."""
        return not self._feet[side].contact.whole or self._feet[side].seen_partial

    def firm(self, step: int) -> bool:
        """Whether the footholds of the last few steps before one were found, and seen ahead, to carry the whole
        sole.
        """
        return step > self._part + _FORGETS

    def lift_off(self, side: Side, step: int) -> None:
        """A swing begins: clear the foot's foothold.

        Args:
            side: Which foot.
            step: The step that it takes.
        """
        foot = self._feet[side]
        foot.contact.lift()
        foot.support = foot.alone = None
        foot.center, foot.borne = self._middle[side], self._borne[side]
        foot.step, foot.seen_partial = step, False
        if self._foreseen == step:  # a step that is taken once more
            self._foreseen = -1

    def touchdown(self, side: Side) -> None:
        """A foot has landed: until loads show more, it stands on the part of its sole under which it saw ground."""
        foot = self._feet[side]
        ground = foot.contact.foresee(np.zeros(2))
        if ground is not None:
            foot.center, foot.borne = self._center(side, ground), borne_part(ground, self._reach)
        foot.seen_partial = ground is not None

    def bear_inside(self, side: Side, distance: float) -> None:
        """Let a foot that has just landed carry nearer to the robot's middle.

        Args:
            side: Which foot.
            distance: Distance along the sole's y axis in m.
        """
        self._feet[side].center = self._feet[side].center + np.array([0.0, distance])

    def coming_to_carry(self, phase: Phase, time: float, feet: FeetView) -> list[Side]:
        """Sides, left first, of feet that take the weight over, or have landed and wait for it.

        Args:
            phase: Phase of the walk.
            time: Time in s.
            feet: Commanded feet.

        Returns:
            The sides.
        """
        early = phase.kind == PhaseKind.SINGLE_SUPPORT and time < phase.start + self._settings.watch
        sides: list[Side] = []
        for side in SIDES:
            step = self._feet[side].step
            taking_over = step == phase.step - 1 and (phase.kind == PhaseKind.DOUBLE_SUPPORT or early)
            if step is not None and (taking_over or (phase.swing == side and feet.landed)):
                sides.append(side)
        return sides

    def find_ahead(
        self, phase: Phase, time: float, feet: FeetView, state: BaseState, soles: Mapping[Side, Percept]
    ) -> FootholdSeen | None:
        """Returns what the swing foot will stand on, once for each step, where it is seen and not whole.

        Args:
            phase: Phase of the walk.
            time: Time in s.
            feet: Commanded feet.
            state: Estimated state.
            soles: What each sole sees.
        """
        side = phase.swing
        if side is None or feet.landed:
            return None
        contact, rules = self._feet[side].contact, self._settings
        contact.update_view(soles[side].reading)
        if self._foreseen == phase.step or math.hypot(*feet.ahead.tolist()) > rules.foresee_reach:
            return None
        if phase.end - time < rules.foresee_least:
            return None
        turn = state.rotations_sole[side][:2, :2]
        ground = contact.foresee(turn.T @ feet.ahead)
        if ground is None:
            return None
        self._foreseen = self._part = phase.step
        center = self._center(side, ground)
        return FootholdSeen(phase.step, side, state.positions_sole[side][:2] + feet.ahead + turn @ center)

    def find(
        self,
        phase: Phase,
        time: float,
        feet: FeetView,
        state: BaseState,
        soles: Mapping[Side, Percept],
        slope: SoleSlope | None = None,
    ) -> tuple[FootholdFound, ...]:
        """Returns what the feet that come to carry stand on, when it is found and when it changes.

        Args:
            phase: Phase of the walk.
            time: Time in s.
            feet: Commanded feet.
            state: Estimated state.
            soles: What each sole senses.
            slope: Turn of each sole against the ground, where that is followed.
        """
        found = []
        for side in self.coming_to_carry(phase, time, feet):
            rises = None if slope is None else slope.slope(side)
            if rises is not None and self._settings.remember:
                self._remember(side, state)
            if self._feet[side].contact.update(soles[side].reading, state.loads[side], rises):
                found.append(self._taken(side, state))
        return tuple(found)

    def _remember(self, side: Side, state: BaseState) -> None:
        """Let a foot that lands presume the edges of the foothold before."""
        foot = self._feet[side]
        if foot.step is not None and not foot.contact.settled:
            place, turn = state.positions_sole[side], state.rotations_sole[side]
            foot.contact.expect(self._edges.expected(foot.step, place, turn))

    def _taken(self, side: Side, state: BaseState) -> FootholdFound:
        foot, contact = self._feet[side], self._feet[side].contact
        assert foot.step is not None
        known = foot.support is not None
        position, rotation = state.positions_sole[side], state.rotations_sole[side]
        self._edges.update(foot.step, contact.lines, contact.center_in_sole, position, rotation)
        polygon = polygon_in_world(contact.polygon_in_sole, rotation, position)
        center = self._center(side, contact.polygon_in_sole)
        vrp, middle = ((position + rotation[:, :2] @ place)[:2] for place in (center, contact.center_in_sole))
        # Where less was seen ahead, the plan uses that; what is found now has to correct it.
        if not contact.whole:
            self._part = foot.step
        as_planned = contact.whole and not known and self._foreseen != foot.step and not foot.seen_partial
        foot.seen_partial = False
        if not as_planned:
            foot.center, foot.borne = center, borne_part(contact.polygon_in_sole, self._reach)
            every = foot.borne is contact.polygon_in_sole
            foot.support = polygon if every else polygon_in_world(foot.borne, rotation, position)
            foot.alone = polygon_in_world(self._within_limits(side, foot.borne), rotation, position)
        ratio, whole, seen = contact.area_ratio, contact.whole, contact.seen
        return FootholdFound(foot.step, side, polygon, ratio, vrp, middle, whole, as_planned, seen)

    def _within_limits(self, side: Side, polygon: NDArray[np.float64]) -> NDArray[np.float64]:
        limits = self._limits.get(side)
        return polygon if limits is None else limits.within(polygon)

    def _center(self, side: Side, polygon: NDArray[np.float64]) -> NDArray[np.float64]:
        center, limits = loaded_middle(polygon, self._reach), self._limits.get(side)
        weak = borne_part(polygon, self._reach) is not polygon  # such an ankle is loaded midway already
        return center if limits is None or weak else limits.center(polygon, center)

    def zmp_region(
        self, phase: Phase, feet: FeetView, frame_offset: Sequence[float], margin: float
    ) -> NDArray[np.float64]:
        """Returns the region of the desired ZMP: the support polygon (k, 2) in the world in m, moved inwards.

        A foot whose support is unknown counts with its whole sole; a single one within its ankle's torque limits.

        Args:
            phase: Phase of the walk.
            feet: Commanded feet.
            frame_offset: Offset (3,) of the commanded feet's frame in the world in m.
            margin: Distance in m of the desired ZMP from the edge.
        """
        standing = [s for s in SIDES if feet.landed or phase.swing != s]
        alone = len(standing) == 1
        places: list[object] = [alone]
        for side in standing:
            position, yaw = feet.footholds[side]
            support = self._feet[side].support
            places.append((side, float(position[0]), float(position[1]), yaw) if support is None else id(support))
        if places != self._region_of:
            parts = []
            for side in standing:
                foot = self._feet[side]
                support = foot.alone if alone else foot.support
                if support is None:
                    position, yaw = feet.footholds[side]
                    support = polygon_in_world(
                        (self._alone if alone else self._borne)[side],
                        level_rotation(yaw),
                        np.array([position[0], position[1], 0.0]) + np.array(frame_offset),
                    )
                parts.append(support)
            self._region = inner_offset(feet_support_polygon(parts), margin)
            self._region.flags.writeable = False
            self._region_of = places
        return self._region
