"""What the feet stand on, found by their soles, and the plan moved onto it (T 4.4.2-4.4.3)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gait.command_frame import CommandFrame
from gait.estimator import BaseState
from gait.foot_motion import FootMotion
from gait.footsteps import level_rotation
from gait.landing_compliance import LandingCompliance
from gait.phases import Phase, PhaseKind
from gait.stance_contact import ContactSettings, StanceContact
from gait.support_strip import SupportStrip
from gait.walk_plan import WalkPlan, vrp_of_step
from plantar.layout import Side, SoleLayout
from plantar.percept import Percept
from plantar.polygon import centroid, inner_offset
from plantar.reading import Reading
from plantar.support import feet_support_polygon, polygon_in_world

__all__ = ["FootholdFelt", "Footholds", "middle_of_sole"]

_SIDES: tuple[Side, Side] = ("left", "right")


def middle_of_sole(layout: SoleLayout) -> NDArray[np.float64]:
    """Centroid (2,) of a sole's outline in the sole frame in m: where the VRP lies over a whole foothold."""
    middle = centroid(layout.outline)
    assert middle is not None  # a layout's outline has an area
    return middle


@dataclass(frozen=True)
class FootholdFelt:
    """What a foot was found to stand on.

    Attributes:
        step: The step that put it down.
        side: Which foot.
        polygon: Support polygon (k, 2) in the world in m, counter-clockwise.
        area_ratio: Its share of the sole's cells.
        vrp: VRP (2,) over it in the world in m.
    """

    step: int
    side: Side
    polygon: NDArray[np.float64]
    area_ratio: float
    vrp: NDArray[np.float64]


@dataclass
class _Foot:
    """One foot of the walk: its taxels' view, its turn, the middle (2,) of its foothold in the sole, the foothold
    (k, 2) in the world where it is known, and the step that put it down."""

    contact: StanceContact
    turning: LandingCompliance
    center: NDArray[np.float64]
    support: NDArray[np.float64] | None = None
    step: int | None = None


class Footholds:
    """Footholds of both feet.

    Args:
        settings: How a foothold is found from the taxels.
        layouts: Sole layout of each side.
        middles: Middle (2,) of each sole in its frame in m, see `middle_of_sole`.
        plan: Plan of the walk, which it moves together with its schedule.
        motion: Motion of the feet.
        frame: Frame of the commanded footholds.
        strip: Where the ground goes on.
        period: Control period in s.
        minimum_load: Vertical force in N from which a foot's centre of pressure means something.
        zmp_offset: Distance in m that the desired ZMP keeps from the edge of what the feet stand on.
    """

    def __init__(
        self,
        settings: ContactSettings,
        layouts: Mapping[Side, SoleLayout],
        middles: Mapping[Side, NDArray[np.float64]],
        plan: WalkPlan,
        motion: FootMotion,
        frame: CommandFrame,
        strip: SupportStrip,
        *,
        period: float,
        minimum_load: float,
        zmp_offset: float,
    ) -> None:
        self.felt: list[FootholdFelt] = []
        self.replans = 0
        self._settings = settings
        self._plan = plan
        self._schedule = plan.schedule
        self._motion = motion
        self._frame = frame
        self._strip = strip
        self._minimum_load = minimum_load
        self._zmp_offset = zmp_offset
        self._middle = middles
        self._outline = {side: layouts[side].outline for side in _SIDES}
        self._feet = {
            side: _Foot(StanceContact(layouts[side], settings), LandingCompliance(period), self._middle[side])
            for side in _SIDES
        }
        self._foreseen = -1
        self._replanned, self._replanned_step = -math.inf, -1
        self._region_of: list[object] = []
        self._region = np.empty((0, 2))

    def center(self, side: Side) -> NDArray[np.float64]:
        """Middle (2,) of a foot's foothold in its sole frame in m; of the sole while the foothold is not known."""
        return self._feet[side].center

    def turn(self, side: Side) -> NDArray[np.float64]:
        """Turn (2,) about a sole's x and y axes in rad by which it yielded to the ground."""
        return self._feet[side].turning.turn

    def polygon(self, side: Side) -> NDArray[np.float64]:
        """Foothold (k, 2) of a foot in its sole frame in m; the sole's outline while it is not known."""
        foot = self._feet[side]
        return self._outline[side] if foot.support is None else foot.contact.polygon_in_sole

    def lift(self, phase: Phase) -> None:
        """A swing begins: what its foot stood on no longer counts, where it will stand is not known."""
        side = phase.swing
        assert side is not None
        foot = self._feet[side]
        foot.contact.lift()
        foot.turning.reset()
        foot.support = None
        foot.center = self._middle[side]
        foot.step = phase.step

    def let_turn(self, side: Side, load: float, center_of_pressure: NDArray[np.float64]) -> None:
        """Let a landed foot yield to the ground for one tick.

        Args:
            side: Which foot.
            load: Vertical force on it in N.
            center_of_pressure: Where that acts (2,) in its sole frame in m.
        """
        foot = self._feet[side]
        foot.turning.update(load, center_of_pressure, foot.center)

    def update(
        self,
        phase: Phase,
        time: float,
        readings: Mapping[Side, Reading],
        state: BaseState,
        percepts: Mapping[Side, Percept],
    ) -> bool:
        """Look at what the feet stand on; where a foothold is not what was planned, move the plan (T 4.4.2).

        Args:
            phase: Phase of the walk.
            time: Time in s.
            readings: Latest reading of each sole.
            state: Estimated state.
            percepts: What each sole feels.

        Returns:
            Whether the plan has changed.
        """
        changed = False
        for side in _SIDES:
            foot = self._feet[side]
            if phase.swing == side and not self._motion.landed:
                foot.contact.see(readings[side])
                changed |= self._foresee(side, phase, time, state)
            # Only while the foot takes the weight over: later its load wanders, and the ground under it stays.
            early = phase.kind == PhaseKind.SINGLE_SUPPORT and time < phase.start + self._settings.watch
            taking_over = foot.step == phase.step - 1 and (phase.kind == PhaseKind.DOUBLE_SUPPORT or early)
            if foot.step is None or not (taking_over or (phase.swing == side and self._motion.landed)):
                continue
            load, cop = state.loads[side], percepts[side].position_cop_in_sole
            if cop is not None and load > self._minimum_load:
                self.let_turn(side, load, cop)
            if foot.contact.update(readings[side], load):
                changed |= self._take(side, foot.step, phase, time, state)
        return changed

    def move_inward(self, side: Side, step: int, distance: float, phase: Phase, time: float) -> None:
        """Let a foot that has just landed carry nearer to the robot's middle.

        Args:
            side: Which foot.
            step: The step that put it down.
            distance: How far along the sole's y axis in m.
            phase: Phase of the walk.
            time: Time in s.
        """
        self._feet[side].center = self._middle[side] + np.array([0.0, distance])
        turn = level_rotation(self._motion.footholds[side][1] + self._frame.turn)
        self._move(step, self._plan.stance(step) + turn[:2, 1] * distance, phase, time)

    def zmp_region(self, phase: Phase) -> NDArray[np.float64]:
        """Where the desired ZMP may lie: the support polygon of the feet that the plan stands on, moved inwards.

        A foot whose support is not known counts with its whole sole at its commanded place. The region is made anew
        only when a foot comes, goes or moves, or another support is found.

        Args:
            phase: Phase of the walk.

        Returns:
            Convex polygon (k, 2) in the world in m, counter-clockwise.
        """
        standing = [s for s in _SIDES if self._motion.landed or phase.swing != s]
        places: list[object] = []
        for side in standing:
            position, yaw = self._motion.footholds[side]
            support = self._feet[side].support
            places.append((side, float(position[0]), float(position[1]), yaw) if support is None else id(support))
        if places != self._region_of:
            parts = []
            for side in standing:
                support = self._feet[side].support
                if support is None:
                    position, yaw = self._motion.footholds[side]
                    support = polygon_in_world(
                        self._outline[side],
                        level_rotation(yaw),
                        np.array([position[0], position[1], 0.0]) + self._frame.offset,
                    )
                parts.append(support)
            self._region = inner_offset(feet_support_polygon(parts), self._zmp_offset)
            self._region_of = places
        return self._region

    def _take(self, side: Side, step: int, phase: Phase, time: float, state: BaseState) -> bool:
        """Take over what a landed foot has found; where it is not what was planned, move the plan."""
        foot, contact = self._feet[side], self._feet[side].contact
        known = foot.support is not None
        position, rotation = state.positions_sole[side], state.rotations_sole[side]
        polygon = polygon_in_world(contact.polygon_in_sole, rotation, position)
        point = (position + rotation[:, :2] @ contact.center_in_sole)[:2]
        self.felt.append(FootholdFelt(step, side, polygon, contact.area_ratio, point))
        if contact.whole:
            self._strip.clear()
            if not known:
                return False  # as planned
        foot.support = polygon
        foot.center = contact.center_in_sole
        if not contact.whole:
            self._strip.add(step, side, point)
        rules = self._settings
        if time < self._replanned + rules.replan_pause and self._replanned_step == step:
            return False
        later = self._follow_strip(step, phase)
        if max(math.dist(point, self._plan.stance(step)), math.hypot(*later.tolist())) < rules.least_move:
            return False
        self._replanned, self._replanned_step = time, step
        self._move(step, point, phase, time, later)
        return True

    def _foresee(self, side: Side, phase: Phase, time: float, state: BaseState) -> bool:
        """Plan once with the foothold that is seen before the foot is on it: the stance foot has most room then."""
        ahead = self._motion.ahead
        if self._foreseen == phase.step or math.hypot(*ahead.tolist()) > self._settings.foresee_reach:
            return False
        if phase.end - time < self._settings.foresee_least:
            return False
        turn = state.rotations_sole[side][:2, :2]
        center = self._feet[side].contact.foresee(turn.T @ ahead)
        if center is None:
            return False
        self._foreseen = phase.step
        point = state.positions_sole[side][:2] + ahead + turn @ center
        if math.dist(point, self._plan.stance(phase.step)) < self._settings.least_move:
            return False
        self._move(phase.step, point, phase, time)
        return True

    def _follow_strip(self, step: int, phase: Phase) -> NDArray[np.float64]:
        """Move the footsteps to come onto the strip that the ground goes on as; returns by how much (2,) in m the VRPs
        over them move."""
        upcoming = step + 1
        begun = phase.step == upcoming and phase.kind == PhaseKind.SINGLE_SUPPORT
        if not self._strip.known or begun or upcoming >= len(self._schedule.steps):
            return np.zeros(2)
        strip, foot = self._strip, self._schedule.steps[upcoming]
        center = vrp_of_step(foot, self._middle[foot.side])
        place, lateral = strip.coordinates(center)
        missing = strip.lateral(place) - lateral
        reach = self._settings.largest_shift
        shift = min(reach, max(-reach, missing)) * strip.across
        self._schedule.shift_steps(upcoming, shift)
        return np.asarray(center + missing * strip.across - self._plan.stance(upcoming))

    def _move(
        self, step: int, point: NDArray[np.float64], phase: Phase, time: float, later: ArrayLike = (0.0, 0.0)
    ) -> None:
        """Move the plan's VRP over a step to a point (2,), and those after it by `later` (2,), in m."""
        self._plan.move(step, point, time, self.zmp_region(phase), later)
        self.replans += 1
