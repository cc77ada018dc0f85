"""Keeps a walk off bad footholds: doubt, probe, step on or walk around, stop where there is no way (T 4.3.2).

    walking --(ground higher than expected)--> doubting: the single support is made longer, the foot lands softly
    doubting --(touchdown)--> probing: the foot presses, the rule decides
    probing --(feasible)--> walking on over it
    probing --(refused)--> the foot lifts again and goes around: walking
    probing --(no way around, or too many tries)--> the foot goes back beside the other one, and the walk ends

All of it before weight is transferred.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from gait.command_frame import CommandFrame
from gait.feasibility import FeasibilityRules, Foothold, FootholdProbe, room_ahead, way_around
from gait.foot_motion import FootMotion
from gait.footsteps import Footstep, other_side
from gait.phases import Phase
from gait.swing_compliance import SwingCompliance
from gait.walk_plan import WalkPlan, vrp_of_step
from plantar.layout import Side
from plantar.reading import Reading

__all__ = ["CheckedStep", "StepGuard"]


_LASTING = 4  # control ticks for which ground has to look higher than expected


class _State(Enum):
    WALKING = 0
    DOUBTING = 1
    PROBING = 2
    TRUSTING = 3
    STOPPED = 4


@dataclass(frozen=True)
class CheckedStep:
    """A foothold that was checked.

    Attributes:
        step: Index of the step.
        foothold: What was found.
        shift: How far the foothold was moved (2,) along the planned foot's axes in m; None where it stayed, or where
            there was no way around.
    """

    step: int
    foothold: Foothold
    shift: NDArray[np.float64] | None


class StepGuard:
    """Checks the footholds of a walk.

    Args:
        rules: Rules.
        motion: Motion of the feet.
        plan: Plan of the walk, which it changes together with its schedule.
        compliance: What each sole sees and feels while it lands.
        vrp_in_sole: VRP (2,) in each sole's frame in m.
    """

    def __init__(
        self,
        rules: FeasibilityRules,
        motion: FootMotion,
        plan: WalkPlan,
        compliance: Mapping[Side, SwingCompliance],
        vrp_in_sole: Mapping[Side, NDArray[np.float64]],
    ) -> None:
        self.rules = rules
        self.checked: list[CheckedStep] = []
        self.stopped = False
        self._motion = motion
        self._plan = plan
        self._schedule = plan.schedule
        self._compliance = compliance
        self._vrp_in_sole = vrp_in_sole
        self._state = _State.WALKING
        self._step = -1
        self._tries = 0
        self._refuge: Footstep | None = None
        self._probe: FootholdProbe | None = None
        self._began = self._since = 0.0
        self._surprised = 0
        self._reading_time = -1.0

    def summary(self) -> dict[str, object]:
        """What was checked, for a run's summary."""
        checks = [
            {
                "step": c.step,
                "feasible": bool(c.foothold.feasible),
                "area_ratio": round(c.foothold.area_ratio, 3),
                "ankle_moment_Nm": None if c.foothold.moment is None else round(c.foothold.moment, 2),
                "shift_m": None if c.shift is None else [round(float(v), 3) for v in c.shift],
            }
            for c in self.checked
        ]
        return {"feasibility": checks, "emergency_stop": self.stopped}

    @property
    def probing(self) -> bool:
        """Whether a foot presses on something unexpected."""
        return self._state is _State.PROBING

    def update(
        self,
        phase: Phase,
        time: float,
        frame: CommandFrame,
        readings: Mapping[Side, Reading],
        moments: Mapping[Side, NDArray[np.float64]],
        loads: Mapping[Side, float],
        region: NDArray[np.float64],
    ) -> bool:
        """One control tick, after the feet's motion.

        Args:
            phase: Phase of the walk.
            time: Time in s.
            frame: Frame that footholds are commanded in.
            readings: Latest reading of each sole.
            moments: Moment (2,) at each ankle in N m, where there are such sensors.
            loads: Vertical force on each foot in N.
            region: Where the desired ZMP may lie (k, 2) in m.

        Returns:
            Whether the plan changed.
        """
        side = phase.swing
        if side is None or self.stopped:
            self._motion.press = None
            return False
        if phase.step != self._step:
            self._step, self._tries, self._state = phase.step, 0, _State.WALKING
            position, yaw = self._motion.footholds[side]
            x, y = frame.to_world(position)[:2].tolist()
            origin = Footstep(side, x, y, yaw + frame.turn)
            stance = frame.to_world(self._motion.footholds[other_side(side)][0])[:2]
            ahead = origin.rotation_sole_to_world[:2, 0]
            dx, dy = (ahead * float((stance - [x, y]) @ ahead)).tolist()
            self._refuge = replace(origin, x=x + dx, y=y + dy)
        self._surprised = self._surprised + 1 if self._motion.surprise > self.rules.surprise else 0
        if self._state is _State.WALKING and self._surprised >= _LASTING:
            self._state = _State.DOUBTING
            self._plan.hold(time, self.rules.hold, region)
            return True
        if self._state is _State.DOUBTING and self._motion.landed:
            self._state = _State.PROBING
            self._began, self._since, self._reading_time = time, math.inf, -1.0
            self._motion.press = self.rules.probe_force
            self._probe = FootholdProbe(self._compliance[side].layout, self.rules)
            self._probe.see(self._compliance[side].ground.distance)
            # The DCM has to be back over the stance foot, and to stay there, until the rule has decided.
            missing = time + self.rules.probe_limit + 1.5 * self.rules.probe_time + self.rules.reserve - phase.end
            if missing > 0.0:
                self._plan.hold(time, missing, region)
                return True
        if self._state is not _State.PROBING or self._probe is None:
            return False
        reading = readings[side]
        if self._since == math.inf and (
            loads[side] > 0.7 * self.rules.probe_force or time > self._began + self.rules.probe_limit
        ):
            self._since = time
        settled = time > self._since + 0.5 * self.rules.probe_time
        if settled and reading.time > self._reading_time:
            self._reading_time = reading.time
            pressing = loads[side] > 0.5 * self.rules.probe_force
            self._probe.feel(reading.force, moments.get(side) if pressing else None)
        if time < self._since + 1.5 * self.rules.probe_time:
            return False
        self._motion.press = None
        return self._decide(phase, side, time, frame, region)

    def _decide(self, phase: Phase, side: Side, time: float, frame: CommandFrame, region: NDArray[np.float64]) -> bool:
        assert self._probe is not None
        found = self._probe.verdict()
        if found.feasible:
            self._state = _State.TRUSTING
            self.checked.append(CheckedStep(phase.step, found, None))
            return False
        self._tries += 1
        outline = self._compliance[side].layout.outline
        shift = way_around(found.polygon_in_sole, outline, side, self.rules)
        if self._tries > self.rules.attempts:
            shift = None
        self.checked.append(CheckedStep(phase.step, found, shift))
        step, later = self._schedule.steps[phase.step], np.zeros(2)
        if shift is None:
            assert self._refuge is not None
            target = self._refuge
            self.stopped = True
            self._plan.stop_after(phase.step)
        else:
            x, y = (step.rotation_sole_to_world[:2, :2] @ shift).tolist()
            target = replace(step, x=step.x + x, y=step.y + y)
            # A shorter or longer step shifts those to come; one to the side is made up for by the next. What was not
            # stepped on must not be met again by the same foot's next step.
            longer = float(shift[0])
            if phase.step + 2 < len(self._schedule.steps):
                ahead = self._schedule.steps[phase.step + 2].position - step.position
                place = step.rotation_sole_to_world[:, :2].T @ ahead + [longer, 0.0]
                longer += room_ahead(found.polygon_in_sole, outline, place, self.rules)
            later = step.rotation_sole_to_world[:2, 0] * longer
            self._schedule.shift_steps(phase.step + 1, later)
        self._schedule.move_step(phase.step, target)
        duration = self.rules.return_time if self.stopped else self.rules.swing_time
        missing = max(0.0, time + duration - phase.end)
        self._plan.hold(time, missing, region, vrp_of_step(target, self._vrp_in_sole[side]), later)
        self._motion.retake(time, duration, frame)
        self._state = _State.STOPPED if self.stopped else _State.WALKING
        return True
