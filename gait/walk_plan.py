"""From footsteps and timing to the VRP plan (T 4.1.3, steps 2 and 3), and how felt footholds change it (T 4.4.2).

A foothold that carries only a part of the sole moves the VRP of its stance to the part's centroid. The plan goes on
from where its DCM and CoM are: a sudden move of the DCM waypoint is bridged by the VRP of the double support, which
swings to the other side for a moment and so pushes the CoM to where the new waypoint wants it. Where the support
polygon does not allow that, the double support is made longer.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gait.footsteps import Footstep
from gait.phases import Phase, PhaseKind, WalkSchedule
from gait.vrp_plan import LipReference, VrpPlan
from plantar.layout import Side
from plantar.polygon import closest_point

__all__ = ["Replan", "WalkPlan", "vrp_of_step"]

_RAMP = 0.15  # of the bridge's time at both ends, in which the VRP moves to where it bridges and back
_DELAY = 0.05  # s by which a double support that is too short grows at a time
_MOST_DELAY = 0.3  # s in all
_SHORT = 0.012  # m of the DCM that the feedback is left to deal with
_STANCE_BRIDGE = 0.4  # s in which a change that comes in single support is bridged
_FORESIGHT = 0.06  # s before touchdown from which a foothold that is seen coming is bridged on the stance foot
_REBUILT = 4  # stances that a replan builds anew; later ones keep what they have
_LEAST_BRIDGE = 0.05  # s: with less time left nothing is bridged


def vrp_of_step(step: Footstep, vrp_in_sole: ArrayLike) -> NDArray[np.float64]:
    """VRP over a footstep (T 4.13).

    Args:
        step: The footstep.
        vrp_in_sole: Its place (2,) in the sole frame in m.

    Returns:
        VRP (2,) in the world frame in m.
    """
    return np.asarray(step.position[:2] + step.rotation_sole_to_world[:2, :2] @ np.asarray(vrp_in_sole, dtype=float))


@dataclass(frozen=True)
class Replan:
    """What a change of the plan did.

    Attributes:
        shift: How far the VRP of the stance moved (2,) in m.
        gap: DCM (2,) in m by which the reference jumps, because the support polygon does not let it be bridged.
        delay: By how much the double support became longer in s.
    """

    shift: NDArray[np.float64]
    gap: NDArray[np.float64]
    delay: float


class WalkPlan:
    """VRP plan of a walk: still in single support, linear from foot to foot in double support.

    Args:
        feet: Where the feet stand at the start.
        schedule: The footsteps with their phases; a replan may delay it.
        vrp_in_sole: VRP (2,) in each sole's frame in m, usually the sole's centroid.
        omega: Pendulum frequency in rad/s.
        com: CoM (2,) at the start in m; between the feet where None.
    """

    def __init__(
        self,
        feet: Mapping[Side, Footstep],
        schedule: WalkSchedule,
        vrp_in_sole: Mapping[Side, NDArray[np.float64]],
        omega: float,
        com: ArrayLike | None = None,
    ) -> None:
        self.schedule = schedule
        self._omega = omega
        self._standing = {s: vrp_of_step(feet[s], vrp_in_sole[s]) for s in feet}
        self._points = np.array([vrp_of_step(step, vrp_in_sole[step.side]) for step in schedule.steps]).reshape(-1, 2)
        first = schedule.phases[0].end
        start = self._between(0)
        times, points = self._knots(-math.inf, len(schedule.steps))
        if times and times[0] <= first:  # no step at all
            del times[0], points[0]
        self.vrps = VrpPlan([first - 1.0, first, *times], [start, start, *points], omega, com)

    def at(self, time: float) -> LipReference:
        """The plan at a time in s (see `VrpPlan.at`)."""
        return self.vrps.at(time)

    @property
    def end(self) -> NDArray[np.float64]:
        """Where the CoM comes to rest (2,) in m."""
        return np.asarray(self.vrps.vrps[-1])

    def stance(self, step: int) -> NDArray[np.float64]:
        """VRP (2,) in m over the foothold of a step."""
        return np.asarray(self._points[step].copy())

    def move(
        self,
        step: int,
        point: ArrayLike,
        time: float,
        region: NDArray[np.float64],
        shift_later: ArrayLike = (0.0, 0.0),
    ) -> Replan:
        """Move the VRP over a foothold that has been felt, and the later footholds with it.

        Args:
            step: The step that put the foot down.
            point: Its VRP (2,) in the world in m: the centroid of what carries.
            time: Now in s.
            region: Convex polygon (k, 2) in the world in m in which the VRP may be while it bridges: in what is left of
                the single support where that is enough, else in the double support that follows; counter-clockwise,
                empty does not limit it.
            shift_later: By how much (2,) in m the footholds after this one move.

        Returns:
            What it did.
        """
        place, later = np.asarray(point, dtype=float), np.asarray(shift_later, dtype=float)
        moved = place - self._points[step]
        self._points[step] = place
        self._points[step + 1 :] += later
        now = self.vrps.at(time)
        phase = self.schedule.at(time)
        takes_over = phase.step == step + 1 and phase.kind == PhaseKind.DOUBLE_SUPPORT
        if phase.step == step and phase.kind == PhaseKind.SINGLE_SUPPORT and phase.end - time >= _FORESIGHT:
            self.vrps, gap = self._bridged(time, now, (time, phase.end), region, later, 0.0)
            return Replan(moved, gap, 0.0)
        if takes_over or phase.step == step:
            following = phase if takes_over else self._next(phase)
            window, delay = (max(time, following.start), following.end), 0.0
            while True:
                plan, gap = self._bridged(time, now, window, region, later, delay)
                if float(np.hypot(*gap)) <= _SHORT or delay > _MOST_DELAY:
                    break
                delay += _DELAY
                window = (window[0], following.end + delay)
            if delay > 0.0:
                self.schedule.delay(following, delay)
            self.vrps = plan
            return Replan(moved, gap, delay)
        window = (time, min(phase.end, time + _STANCE_BRIDGE))
        self.vrps, gap = self._bridged(time, now, window, region, later, 0.0)
        return Replan(moved, gap, 0.0)

    def stop_after(self, step: int) -> None:
        """Leave out all steps after one; call `hold` next, which plans what is left.

        Args:
            step: Index of the last step.
        """
        self.schedule.stop_after(step)
        self._points = self._points[: step + 1].copy()

    def hold(
        self,
        time: float,
        by: float,
        region: NDArray[np.float64],
        point: ArrayLike | None = None,
        shift_later: ArrayLike = (0.0, 0.0),
    ) -> NDArray[np.float64]:
        """Make the current single support longer: the DCM comes back over the stance foot and leaves it later.

        Args:
            time: Now in s.
            by: How much longer in s.
            region: Convex polygon (k, 2) in the world in m in which the VRP may be meanwhile, counter-clockwise.
            point: VRP (2,) in m over the foothold of the step that is being taken, where that has moved.
            shift_later: By how much (2,) in m the footholds after it move.

        Returns:
            DCM (2,) in m by which the reference jumps.
        """
        now, phase = self.vrps.at(time), self.schedule.at(time)
        if point is not None:
            self._points[phase.step] = np.asarray(point, dtype=float)
        later = np.asarray(shift_later, dtype=float)
        self._points[phase.step + 1 :] += later
        self.schedule.delay(phase, by)
        window = (time, min(phase.end + by, time + _STANCE_BRIDGE))
        self.vrps, gap = self._bridged(time, now, window, region, later, 0.0, late=by)
        return gap

    def _bridged(
        self,
        time: float,
        now: LipReference,
        window: tuple[float, float],
        region: NDArray[np.float64],
        shift: NDArray[np.float64],
        delay: float,
        late: float = 0.0,
    ) -> tuple[VrpPlan, NDArray[np.float64]]:
        """The plan from now on, with a bridge in a window of time, and the DCM (2,) that stays unbridged."""
        n = len(self.schedule.steps)
        last = min(self.schedule.at(time).step + _REBUILT, n)
        if last >= n - 1:
            last = n
        times, points = self._knots(time, last)
        if delay:
            times = [t + delay if t >= window[1] - delay - 1e-9 else t for t in times]
        first = len(self.vrps.times) - (0 if last == n else 2 * (n - last) + 2)
        head_times, head = [time], [now.vrp]
        bridge: list[int] = []
        length = window[1] - window[0]
        if length >= _LEAST_BRIDGE:
            before = [i for i, t in enumerate(times) if t <= window[0] + 1e-9]
            for i in before:
                if times[i] > time + 1e-9:
                    head_times.append(times[i])
                    head.append(points[i])
            del times[: len(before)], points[: len(before)]
            ahead = points[0] if times else self.end
            bridge = [len(head), len(head) + 1]
            for share in (_RAMP, 1.0 - _RAMP):
                head_times.append(window[0] + share * length)
                head.append(head[bridge[0] - 1] + share * (ahead - head[bridge[0] - 1]))
            if times and times[0] > window[1] + 1e-9:  # a bridge inside a stance ends where the stance's VRP is
                head_times.append(window[1])
                head.append(ahead)
        fresh = [i for i, t in enumerate(times) if t > head_times[-1] + 1e-6]
        head_times += [times[i] for i in fresh]
        head += [points[i] for i in fresh]
        plan = self.vrps.replanned(head_times, head, first, shift=shift, delay=delay + late)
        gap = now.dcm - plan.dcm_waypoints[0]
        if bridge:
            push = gap / self._response(head_times[: bridge[1] + 2])
            for i in bridge:
                wanted = head[i] + push
                nearest = closest_point(region, wanted)
                head[i] = wanted if nearest is None else nearest
            plan = self.vrps.replanned(head_times, head, first, shift=shift, delay=delay + late)
            gap = now.dcm - plan.dcm_waypoints[0]
        return plan, gap

    def _response(self, times: list[float]) -> float:
        """DCM at the first of some knots by 1 m of VRP at the last two knots but one."""
        omega, dcm = self._omega, 0.0
        vrp = [0.0] * (len(times) - 3) + [1.0, 1.0, 0.0]
        for i in range(len(times) - 2, -1, -1):
            length = times[i + 1] - times[i]
            rate = (vrp[i + 1] - vrp[i]) / length
            dcm = vrp[i] + rate / omega + math.exp(-omega * length) * (dcm - vrp[i + 1] - rate / omega)
        return dcm

    def _knots(self, time: float, last: int) -> tuple[list[float], list[NDArray[np.float64]]]:
        """Times and VRPs of the stances after a time, up to the one before step `last`; then of the final standing."""
        n = len(self.schedule.steps)
        times: list[float] = []
        points: list[NDArray[np.float64]] = []
        for phase in self.schedule.phases[self.schedule.index(time) :]:
            if phase.kind == PhaseKind.SINGLE_SUPPORT:
                if phase.step >= last:
                    return times, points
                vrp = self._stance_point(phase.step)
                times += [phase.start, phase.end]
                points += [vrp, vrp]
            elif phase.kind == PhaseKind.STANDING and math.isfinite(phase.start):
                end = self._between(n)
                times += [phase.start, phase.start + 1.0]
                points += [end, end]
        return times, points

    def _between(self, steps: int) -> NDArray[np.float64]:
        """Middle (2,) of the feet's VRPs after a number of steps."""
        standing = dict(self._standing)
        for side in standing:
            for k in range(steps - 1, -1, -1):
                if self.schedule.steps[k].side == side:
                    standing[side] = self._points[k].copy()
                    break
        return np.asarray(0.5 * (standing["left"] + standing["right"]))

    def _stance_point(self, step: int) -> NDArray[np.float64]:
        """VRP (2,) over the foot that carries while a step is taken."""
        swing = self.schedule.steps[step].side
        for k in range(step - 1, -1, -1):
            if self.schedule.steps[k].side != swing:
                return np.asarray(self._points[k].copy())
        return self._standing["right" if swing == "left" else "left"]

    def _next(self, phase: Phase) -> Phase:
        phases = self.schedule.phases
        return phases[min(phases.index(phase) + 1, len(phases) - 1)]
