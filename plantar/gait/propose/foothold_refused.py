"""Keeps walks off bad footholds, before weight transfer (T 4.3.2).

walking --(ground higher than expected)--> doubting: the single support is extended, the foot lands softly doubting
--(too little ground seen under it)--> walking: it goes around without a touch doubting --(touchdown)--> probing: the
foot presses, the rule decides probing --(feasible)--> walking on over it probing --(refused)--> the foot lifts again
and goes around: walking probing --(no way around, or too many tries)--> the foot goes back next to the other one, and
the walk ends

One leg holds only as long as the measured DCM xi can be captured: for a time T the best ZMP p of the standing sole
leaves it

    |p + e^(w T) (xi - p) - xi_e| <= (1 - e^(-w t_ds)) b

off its goal xi_e, which is what a ZMP at the sole's edge, b from the VRP, takes up in the double support t_ds that
follows (T 4.9-4.14). Otherwise the foot lands when it was going to and is judged in double support, as weight comes
onto it; what is refused then is stood on, unless the DCM is still over the other foot for a step around.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side, other_side
from plantar.gait.contact.foot_contacts import REMEMBERED
from plantar.gait.plan.footsteps import Footstep
from plantar.gait.plan.phases import Phase, PhaseKind
from plantar.gait.plan.plan_change import PlanChange, Point
from plantar.gait.propose.feasibility import (
    FeasibilityRules,
    Foothold,
    FootholdProbe,
    room_ahead,
    seen_foothold,
    way_around,
)
from plantar.gait.propose.proposer import Priority, Tick
from plantar.geometry.polygon import signed_margin
from plantar.layouts.layout import SoleLayout

_LASTING = 0.02  # chosen: s for which ground has to look higher than expected; five readings
# chosen: of an extension that is too long: a sixty-fourth of 0.7 s is two ticks; a time alone depends on it
_HALVINGS = 6


class _State(Enum):
    WALKING = 0
    DOUBTING = 1
    PROBING = 2
    TRUSTING = 3
    STOPPED = 4


@dataclass(frozen=True)
class CheckedStep:
    """A checked foothold.

    `step`: its index; `foothold`: what was found; `shift`: its move (2,) along the planned foot's axes in m; None if it
    stayed, had no way, or no leg could hold the body for it.
    """

    step: int
    foothold: Foothold
    shift: NDArray[np.float64] | None


class StepGuard:
    """Checks a walk's footholds.

    `stopped`: whether it ended the walk without a way on; `press`: force in N of a probing foot; None without; `lifts`:
    whether this tick refuses a foothold that is seen and not touched.
    """

    priority = Priority.SAFETY

    def __init__(self, rules: FeasibilityRules, layouts: Mapping[Side, SoleLayout], period: float) -> None:
        self.rules = rules
        self._probes = rules.at != "impact"
        self._looks = rules.at == "sight" and rules.rule == "skin"
        self._force = rules.probe_force if self._probes else rules.impact_force
        # A pressing foot settles first; a touch is read from its beginning.
        self._settling, self._reading = (
            (0.5 * rules.probe_time, rules.probe_time) if self._probes else (0.0, rules.impact_time)
        )
        self.checked: list[CheckedStep] = []
        self.stopped = False
        self.press: float | None = None
        self.lifts = False
        self._layouts = layouts
        self._state = _State.WALKING
        self._step = -1
        self._tries = 0
        self._refuge: Footstep | None = None
        self._probe: FootholdProbe | None = None
        self._began = 0.0
        self._since = 0.0
        self._lasting = round(_LASTING / period)
        self._surprised = 0
        self._unsafe = 0
        self._reading_time = -1.0
        self._refused = -math.inf
        self._alone: NDArray[np.float64] | None = None  # region (k, 2) in m of the ZMP under the standing foot

    def summary(self) -> dict[str, object]:
        """Checks, for a run's summary."""
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
        return {"feasibility": checks}

    @property
    def probing(self) -> bool:
        """Whether a foot presses on something unexpected."""
        return self._state is _State.PROBING

    @property
    def holds(self) -> bool:
        """Whether a leg carries alone for longer than a step, by what the other foot met."""
        return self._tries > 0 or self._state in (_State.DOUBTING, _State.PROBING)

    def firm(self, step: int) -> bool:
        """Whether no foothold was refused in a step or shortly before, so that feet can go anywhere."""
        return step > self._refused + REMEMBERED

    def propose(self, tick: Tick) -> PlanChange | None:
        """A longer single support for a doubted foothold, another place for a refused one.

        Its changes, of `Priority.SAFETY`, are always applied.
        """
        phase = tick.phase
        side = tick.phase.swing
        self.lifts = False
        if side is None or self.stopped:
            self.press = None
            judges = phase.kind == PhaseKind.DOUBLE_SUPPORT and phase.step == self._step + 1 and not self.stopped
            return self._judge_on_both(tick) if judges else None
        if phase.step != self._step:
            self._begin(phase, side, tick)
        if tick.pendulum is not None and not tick.feet.landed:
            self._alone = tick.pendulum.zmp_region
        # For some ticks on end, so that one noisy height does not hold a walk up.
        self._surprised = self._surprised + 1 if tick.feet.surprise > self.rules.surprise else 0
        if self._state is _State.WALKING and self._surprised >= self._lasting:
            self._state = _State.DOUBTING
            return self._waiting(phase, self.rules.hold, tick)
        if self._state is _State.DOUBTING and tick.feet.landed:
            self.press = self._force
            missing = self._touch(side, tick) - phase.end
            return self._waiting(phase, missing, tick) if self._probes and missing > 0.0 else None
        if self._state is _State.DOUBTING and self._looks:
            return self._seen(phase, side, tick)
        return self._probed(phase, side, tick)

    def _seen(self, phase: Phase, side: Side, tick: Tick) -> PlanChange | None:
        """Another place for a foothold that is seen under too little of the sole for some ticks on end."""
        below = tick.feet.below
        found = None if below is None else seen_foothold(self._layouts[side], below, self.rules)
        self._unsafe = self._unsafe + 1 if found is not None and not found.feasible else 0
        if found is None or self._unsafe < self._lasting or not self._captures(self.rules.swing_time, tick):
            return None
        self._unsafe = 0
        self.lifts = True
        return self._judge(found, phase, side, tick)

    def _judge_on_both(self, tick: Tick) -> PlanChange | None:
        """A doubted foothold on which the plan puts weight by now."""
        if tick.feet.side is None or self._state not in (_State.DOUBTING, _State.PROBING):
            return None
        if self._state is _State.DOUBTING:
            if tick.feet.landed:
                self._touch(tick.feet.side, tick)
            return None
        support = next(p for p in tick.plan.schedule.phases if p.step == self._step and p.swing is not None)
        return self._probed(support, tick.feet.side, tick)

    def _probed(self, support: Phase, side: Side, tick: Tick) -> PlanChange | None:
        """What follows from a probe that has lasted long enough. `support`: single support of its step."""
        if self._state is not _State.PROBING or self._probe is None:
            return None
        self._read(side, tick)
        if tick.time < self._since + self._settling + self._reading:
            return None
        self.press = None
        return self._judge(self._probe.verdict(), support, side, tick)

    def _waiting(self, phase: Phase, by: float, tick: Tick) -> PlanChange | None:
        """A single support that is longer by a time in s, or as much of it as can be captured."""
        longest = by
        if not self._captures(phase.end + by - tick.time, tick):
            longest = 0.0
            for halving in range(1, _HALVINGS + 1):
                tried = longest + by / 2**halving
                if self._captures(phase.end + tried - tick.time, tick):
                    longest = tried
        if longest == 0.0:
            return None
        return PlanChange("ground higher than expected", phase.step, longer=longest, wait=phase.wait + longest)

    def _captures(self, left: float, tick: Tick) -> bool:
        """Whether the measured DCM can be captured after `left` seconds on the standing foot alone."""
        pendulum = tick.pendulum
        alone = self._alone
        if pendulum is None or alone is None or not len(alone):
            return True
        growth, wanted, best = pendulum.changed(zmp_region=alone).beyond_zmp(left)
        taken = -math.expm1(-pendulum.omega * tick.plan.schedule.timing.double_support)
        room = max(0.0, signed_margin(alone, tick.plan.stance_vrp(self._step)))
        return growth * math.dist(wanted, best) <= taken * room

    def _begin(self, phase: Phase, side: Side, tick: Tick) -> None:
        """A step begins; its start is where the foot can return."""
        self._step = phase.step
        self._tries = 0
        self._state = _State.WALKING
        self._alone = None
        origin = tick.place(side)
        stance = tick.place(other_side(side))
        ahead = origin.rotation_sole_to_world[:2, 0]
        way = np.array([stance.x, stance.y]) - [origin.x, origin.y]
        dx, dy = (ahead * float(way @ ahead)).tolist()
        self._refuge = replace(origin, x=origin.x + dx, y=origin.y + dy)

    def _touch(self, side: Side, tick: Tick) -> float:
        """Touchdown: the foot presses. Returns the time in s until which the stance foot should carry."""
        rules = self.rules
        self._state = _State.PROBING
        self._began = tick.time
        self._since = math.inf
        self._reading_time = -1.0
        self._probe = FootholdProbe(self._layouts[side], rules)
        if tick.feet.distance is not None:
            self._probe.update_view(tick.feet.distance)
        # The DCM has to be back over the stance foot, and to stay there, until the rule has decided.
        return tick.time + rules.probe_limit + self._settling + self._reading + rules.reserve

    def _read(self, side: Side, tick: Tick) -> None:
        assert self._probe is not None
        rules = self.rules
        reading = tick.readings[side]
        load = tick.loads[side]
        time = tick.time
        # The rule reads a foot that has its load; where that does not come, what there is after the time for it;
        # chosen: a foot yields as it is pressed, and may stay below its force
        if self._since == math.inf and (load > 0.7 * self._force or time > self._began + rules.probe_limit):
            self._since = time
        if time >= self._since + self._settling and reading.time > self._reading_time:
            self._reading_time = reading.time
            pressing = load > 0.5 * self._force
            self._probe.update_load(reading.force, tick.moments.get(side) if pressing else None)

    def _judge(self, found: Foothold, phase: Phase, side: Side, tick: Tick) -> PlanChange | None:
        step = tick.plan.foothold(phase.step)
        if not found.feasible:
            self._refused = phase.step
        if found.feasible or not self._captures(self.rules.swing_time, tick):
            self._state = _State.TRUSTING
            self.checked.append(CheckedStep(phase.step, found, None))
            return None
        self._tries += 1
        shift = way_around(found.polygon_in_sole, self._layouts[side].outline, side, self.rules)
        if self._tries > self.rules.attempts:
            shift = None
        self.checked.append(CheckedStep(phase.step, found, shift))
        if shift is None:
            return self._back(phase, tick)
        x, y = (step.rotation_sole_to_world[:2, :2] @ shift).tolist()
        self._state = _State.WALKING
        later = self._shift_of_later(step, shift, found, tick)
        wait = self._wait(self.rules.swing_time, phase, tick)
        return PlanChange(
            "foothold refused",
            phase.step,
            foothold=replace(step, x=step.x + x, y=step.y + y),
            shift=later,
            longer=wait[0],
            wait=wait[1],
            again=tick.phase.swing is None,
            because="foothold before it refused",
        )

    def _back(self, phase: Phase, tick: Tick) -> PlanChange:
        self.stopped = True
        self._state = _State.STOPPED
        longer, wait = self._wait(self.rules.return_time, phase, tick)
        return PlanChange(
            "no way around, back",
            phase.step,
            foothold=self._refuge,
            following=(),
            longer=longer,
            wait=wait,
            again=tick.phase.swing is None,
        )

    def _shift_of_later(self, step: Footstep, shift: NDArray[np.float64], found: Foothold, tick: Tick) -> Point:
        """Later steps' move in m: a sidestep is carried over, so that the next foot keeps its distance.

        Both next feet then clear the obstacle, which the one that did not meet it may be shifted to.
        """
        into_sole = step.rotation_sole_to_world[:, :2].T
        plan = tick.plan
        room = 0.0
        for later in range(self._step + 1, min(self._step + 3, plan.count)):
            foothold = plan.foothold(later)
            place = into_sole @ (foothold.position - step.position) + shift
            outline = self._layouts[foothold.side].outline
            room = max(room, room_ahead(found.polygon_in_sole, outline, place, self.rules))
        x, y = (step.rotation_sole_to_world[:2, :2] @ (shift + np.array([room, 0.0]))).tolist()
        return x, y

    @staticmethod
    def _wait(duration: float, phase: Phase, tick: Tick) -> tuple[float, float]:
        """Single support's extension in s for a swing, and the time that the foot is down by then."""
        missing = tick.time + duration - phase.end
        return max(0.0, missing), max(0.0, -missing)
