"""Safety shell: a command at every tick, for sensors and times of any kind.

Sound input and targets without jumps leave the command unchanged (docs/safety.md).
"""

import math
import time as clock
from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.common.arguments import positive
from plantar.common.sides import SIDES, Side, other_side
from plantar.gait.command import Command, Sensors
from plantar.gait.estimate.estimator import Posture
from plantar.gait.plan.phases import PhaseKind
from plantar.gait.safety.bring_up.bring_up import BringUp
from plantar.gait.safety.fall_check import FROZEN, FallCheck
from plantar.gait.safety.fault_log import FaultLog
from plantar.gait.safety.safe_stop import SITS, SafeStop
from plantar.gait.safety.supervision import Supervision
from plantar.gait.safety.target_limits import TargetLimits
from plantar.gait.safety.taxel_check import AIR, TaxelCheck
from plantar.kernels.safety.plausible import BodyCheck, SoleCheck
from plantar.kernels.safety.tick_clock import TickClock
from plantar.layouts.layout import SoleLayout
from plantar.mechanics.lip import GRAVITY
from plantar.sensing.reading import Reading

# rad, rad/s^2: a joint's speed changes faster only where its encoder jumps; walks reach 80
_SLIP = 0.02  # chosen: four times the largest zero of a drawn encoder
_JERK = 800.0  # measured: ten times what walks reach
_SILENT = 0.06  # chosen: s for which a reading that cannot be taken is bridged by the last one that could
_LATE = 0.15  # chosen: s of times that cannot be taken, until the state is "late"
# chosen: weight on both soles below which one must be silent, and for how long in s
_UNLOADED = 0.3
_WEIGHTLESS = 0.04  # chosen: 40 ms: impacts unload a foot for less
_FALLEN = 0.5  # derived: share of its height below which the CoM of a robot has fallen
_LANDING = 0.15  # chosen: s of double support within which a foot comes down that lands late
_EMPTY = 0.05  # chosen: weight on both soles of a robot that stands on both feet, below which both are silent
# chosen: s after which a blind robot sits, and goes limp where neither IMU nor soles show that it stands
_UNKNOWN = 2.0
_STALLED = 0.1  # chosen: s by which a tick comes late, and is noted; twenty ticks
_OFTEN = 0.3  # chosen: missed ticks of each, in the mean of 20
_AGAIN = 2.0  # chosen: s in which what is noted is not noted again; a log alone depends on it
# What the soles' check returns of those that it cannot take as they are, and of those that carry the robot
_UNREAD = -1  # nature: a code
_CARRY = 1  # nature: a code
_FINAL = ("fallen", "limp", "released")
_PROBLEMS = ("", "a joint angle that no robot has", "an IMU reading that no robot has", "IMU stuck", "encoders stuck")

Readings = Mapping[Side, Reading]


class SafetyShell:
    """Guards a controller's tick.

    Attributes:
        state: "bring-up", "refused" (bring-up found something wrong: it stands), "stopped" and "released" (by `stop`),
            "fallen", "limp", "blind" (these stay, but that a robot that sits may fall or go limp), "late" (ends with
            the first usable time), "waiting" (ends with the first usable reading), or None.
        reason: Why, in words.
        bring_up: Has to pass before the first tick of the walk, whose time then counts from 0; None skips it.
        commanded: Joint angles (k,) in rad that the drives were given last, which measured ones are compared with;
            None does not.
        log: Faults, with what came before each.

    Args:
        start: Command before the first sound reading.
        period: Of control in s.
        mass: Robot's in kg.
        leg: Leg length in m.
        com_height: CoM over the soles in m.
        begin: Of the walk in s; a later first tick has another zero.
        stop: Commands in a state that stays.
        posture: Forward kinematics of joint angles (k,) in rad, base frame; None looks for falls without it.
    """

    def __init__(
        self,
        tick: Callable[[Sensors], Command],
        start: Command,
        layouts: Mapping[Side, SoleLayout],
        joints: int | None,
        period: float,
        mass: float,
        leg: float,
        com_height: float,
        begin: float,
        stop: SafeStop,
        posture: Callable[[NDArray[np.float64]], Posture] | None = None,
    ) -> None:
        self._tick = tick
        self._last = start
        self._begun = False
        self._period = period
        self._weight = mass * GRAVITY
        self._fallen = _FALLEN * com_height
        self._counts = {side: len(layouts[side]) for side in layouts}
        self._clock = TickClock(period, begin)
        self._limits = TargetLimits(period, leg, math.sqrt(leg / GRAVITY), self._weight)
        self._joints = joints
        self._body: BodyCheck | None = None
        self._taxels = TaxelCheck(layouts, self._weight, period)
        self._noted: dict[str, float] = {}
        self._jumps = 0
        self._missed = 0.0
        self._stuck = round(FROZEN / period)
        self._soles = SoleCheck(self._weight, _UNLOADED * self._weight, AIR * self._weight, self._stuck)
        self._bridged = round(_SILENT / period)
        self._silent = 0
        self._unloaded = 0
        self._sound: Sensors | None = None
        self._lost: Side | None = None
        self._stop = stop
        self._fall = FallCheck(period, self._weight, com_height, posture)
        self._empty = 0
        self._unknown = 0
        self._carried = False
        self._supervision = Supervision(layouts, mass, period, self._note)
        self._reported = 0.0
        self._dead = 0
        self._asked: tuple[str, str] | None = None
        self._beat: float | None = None
        self._longest_beat = math.inf
        self._named: str | None = None
        self.bring_up: BringUp | None = None
        self.commanded: NDArray[np.float64] | None = None
        self.log = FaultLog(period, layouts)
        self.reason = ""
        self.state: str | None = None
        self.errors = 0
        self.error = ""

    def stop(self, reason: str = "asked for", *, limp: bool = False) -> None:
        """Stop from the next tick on, from any thread: "stopped" puts both feet down and sits; `limp`, "released", goes
        limp in 0.5 s. It stays stopped.
        """
        if self._asked is None or limp:
            self._asked = ("released" if limp else "stopped", reason)

    def expect_heartbeat(self, longest: float) -> None:
        """Stop where no `heartbeat` comes for a time in s: of a supervisor, an operator's pendant, a radio."""
        self._longest_beat = positive(longest, "longest time without a heartbeat", "s")
        self.heartbeat()

    def heartbeat(self) -> None:
        """The supervisor is there."""
        self._beat = clock.monotonic()

    def step(self, sensors: Sensors) -> Command:
        """Command of the controller, or of its state, at a tick; never raises."""
        try:
            reported = float(sensors.time)
        except (AttributeError, TypeError, ValueError):
            reported = math.nan
        time = self._clock.time_of(reported)
        late = self._clock.late
        self._reported = reported
        if late:
            self._soles.skip()
            self._supervision.skip()
        self._missed += 0.05 * (late - self._missed)  # derived: the mean of 20
        if self._clock.jumped:
            self._supervision.restart_clock()
        if self._clock.jumped or self._clock.odd or self._missed > _OFTEN:
            self._note_clock(self._clock.jumped)
        try:
            command = self._stepped(sensors, time)
        except Exception as raised:  # of any kind: a robot that walks needs a command
            self.errors += 1
            self.error = f"{type(raised).__name__}: {raised}"
            self.reason = self.error
            try:
                command = self._bridge(time)
            except Exception:  # the last sound reading makes the tick raise, too
                command = self._held()
        self._last = command
        self.log.add(sensors, command)
        named = self.state or self._stop.state
        if named != self._named:
            self._note_state(named)
        return command

    def _note(self, kind: str, text: str) -> None:
        """Log what the robot walks on with; each kind at times."""
        time = self.log.time
        if time - self._noted.get(kind, -math.inf) > _AGAIN:
            self.log.note(text)
        self._noted[kind] = time

    def _note_dead(self) -> None:
        """Log that more taxels have no number than before, those that were left out not counted."""
        dead = self._soles.dead - self._taxels.count
        if dead > self._dead and self._begun:
            self._note("dead", f"{dead} taxels without a number, {self._dead} before")
        self._dead = dead

    def _note_stuck(self, soles: SoleCheck) -> None:
        """Log a taxel that repeats its reading while its sole's others do not."""
        for side, taxel in zip(SIDES, (soles.left_stuck, soles.right_stuck), strict=True):
            if taxel >= 0:
                name = self._taxels.ids[side][taxel]
                self._note(f"{side} taxel {name}", f"taxel {name} of the {side} sole repeats its reading")

    def _note_clock(self, jumped: float) -> None:
        """Log a time that is not the one that was expected."""
        if jumped > _STALLED:
            self._note("clock", f"a tick came {jumped:.2f} s late: the loop stalled, or its clock jumped")
        elif jumped < 0.0:
            self._note("clock", f"the clock went back by {-jumped:.2f} s")
        elif self._clock.odd:
            self._note("clock", "times that are no numbers")
        else:
            self._note("clock", "times come late again and again: ticks are missed, or the clock jitters")

    def _note_state(self, named: str | None) -> None:
        """Log a state that has just begun."""
        self._named = named
        if named == "lost":
            self.reason = "the CoM would have to be farther from the feet than it is high"
        if named not in (None, "bring-up"):
            self.log.note(f"{named}: {self.reason}" if self.reason else str(named))

    def _stepped(self, sensors: Sensors, time: float) -> Command:
        down = self._fall.is_down(sensors)
        if self._beat is not None or self._asked is not None:
            stopped = self._stopped()
            if stopped is not None:
                return stopped
        if self.bring_up is not None and not self.bring_up.passed and self._asked is None:
            return self._checked(self.bring_up, sensors)
        if self.state in _FINAL:
            return self._held()
        if down or self._limits.height < self._fallen:
            return self._in_state("fallen", "the trunk tilts, the soles are off the ground, or the legs have folded")
        if self.state in SITS:
            return self._sitting()
        self.state = None
        if self._clock.odd * self._period > _LATE:
            return self._in_state("late", "times that cannot be used")
        if (
            sensors is None
            or sensors.joint_positions is None
            or sensors.gyro is None
            or sensors.accelerometer is None
            or sensors.readings is None
        ):
            self.reason = "angles, IMU or soles missing"
            return self._bridge(time)
        if self.commanded is not None:
            sensors = self._supervision.followed(sensors, self.commanded, self._body, self._last)
        problem = self._problem(sensors)
        if problem:
            self.reason = _PROBLEMS[problem]
            return self._bridge(time)
        body = self._body
        if body is not None and (body.slipped or body.missing):
            sensors = self._with_slips(body, sensors)
        readings = self._readings(sensors, time)
        if readings is None:
            self.reason = "both soles missing, silent or stuck"
            return self._bridge(time)
        if time != sensors.time or readings is not sensors.readings:
            sensors = sensors.changed(time=time, readings=readings)
        return self._commanded(sensors)

    def _in_state(self, state: str, reason: str) -> Command:
        self.state = state
        self.reason = reason
        return self._held()

    def _stopped(self) -> Command | None:
        """The command of a robot that has just been asked to stop; None for any other."""
        if self._beat is not None and clock.monotonic() - self._beat > self._longest_beat:
            self.stop(f"no heartbeat for {self._longest_beat:g} s")
        if self._asked is None or self.state in ("fallen", "limp", self._asked[0]):
            return None
        return self._in_state(*self._asked)

    def _sitting(self) -> Command:
        """A tick of a robot that sits down; limp once it is seated and nothing shows that it stands."""
        self._unknown = 0 if self._fall.knows else self._unknown + 1
        if self._unknown * self._period > _UNKNOWN:
            return self._in_state("limp", "neither IMU nor soles show whether it stands")
        return self._held()

    def _with_slips(self, body: BodyCheck, sensors: Sensors) -> Sensors:
        """Sensors without the jumps of encoders."""
        if body.missing:
            self._note("missing", "encoders or IMU without a number")
        if body.jumps != self._jumps:
            self._jumps = body.jumps
            joint = body.last_slip
            self._note(f"slip {joint}", f"encoder of joint {joint}, counted from 0: it jumped, which is taken off")
        return sensors.changed(joint_positions=sensors.joint_positions - body.slips) if body.slipped else sensors

    def _checked(self, bring_up: BringUp, sensors: Sensors) -> Command:
        """A tick of bring-up, whose own look at the IMU counts until it is known to be wired right."""
        command = bring_up.step(sensors)
        if bring_up.fell:
            return self._in_state("fallen", "it leaned over during bring-up")
        self.state = "refused" if bring_up.ended else "bring-up"
        self.reason = "; ".join(map(str, bring_up.findings))
        if bring_up.passed:
            self.state = None
            self._clock = TickClock(self._period, 0.0)
        return command

    def _commanded(self, sensors: Sensors) -> Command:
        command = self._tick(sensors)
        self._sound = sensors
        self._silent = 0
        whole = self._lost is None and not (self._body is not None and self._body.missing)
        self._supervision.compare(sensors, command, self._soles, self._reported, whole)
        if self._soles.dead != self._dead:
            self._note_dead()
        if not self._begun:
            self._begun = True
            if self.bring_up is None:
                return command
        if self._supervision.grave:
            return self._in_state("blind", self._supervision.grave)
        return self._limits.limited(self._last, command)

    def _bridge(self, time: float) -> Command:
        """A tick without usable reading: on with the last briefly, then blind."""
        self._silent += 1
        if self._silent == 1:
            self._note("unusable", self.reason)
        if self._silent > self._bridged:
            self.state = "blind" if self._begun else "waiting"
        if self.state is None and self._sound is not None:
            return self._limits.limited(self._last, self._tick(self._sound.changed(time=time)))
        return self._held()

    def _held(self) -> Command:
        return self._stop.after(self._last, self.state)

    def _problem(self, sensors: Sensors) -> int:
        """Fault of encoders and IMU, 0 for none; the controller bridges NaN."""
        joints = sensors.joint_positions
        gyro = sensors.gyro
        accelerometer = sensors.accelerometer
        if self._body is None:
            self._joints = len(joints) if self._joints is None else self._joints
            self._body = BodyCheck(self._joints, self._stuck, max(_SLIP, _JERK * self._period**2))
        body = self._body
        found = body.check(joints, gyro, accelerometer, 1 + self._clock.late)
        stands = self._last.phase.kind == PhaseKind.STANDING
        repeated = self._supervision.repeated
        if body.imu_same == repeated:
            self._note("repeated", "gyro or accelerometer repeats its last reading")
        if body.joints_same == repeated and not stands:
            self._note("repeated", "encoders repeat their last reading")
        # nature: a code of the check, from which nothing that came can be
        return found if found < 3 or not stands else 0

    def _readings(self, sensors: Sensors, time: float) -> Readings | None:
        """Each sole's reading under its side; a silent one follows from the other."""
        readings = sensors.readings
        soles = self._soles
        counts = self._counts
        left = readings.get("left")
        right = readings.get("right")
        if left is not None and right is not None:
            sound = self._taxels.checked(readings, soles, sensors.accelerometer, self._last.phase, time)
            if sound is not readings:
                readings = sound
                left = readings["left"]
                right = readings["right"]
                if self._taxels.found:
                    self.log.note(self._taxels.found)
                    self._taxels.found = ""
        seen = _UNREAD
        if left is not None and right is not None and self._lost is None:
            seen = soles.look(left.force, counts["left"], right.force, counts["right"])
            if soles.left_stuck >= 0 or soles.right_stuck >= 0:
                self._note_stuck(soles)
        if seen == _CARRY:
            self._carried = True
            self._empty = 0
            self._unloaded = 0
            return readings
        left = _sound(readings, "left", counts["left"])
        right = _sound(readings, "right", counts["right"])
        if left is None or right is None:
            missing: Side = "left" if left is None else "right"
            return None if left is right else self._replaced(readings, missing)
        if seen == _UNREAD:
            soles.update(left.force, counts["left"], right.force, counts["right"])
        if soles.swapped:
            if counts["left"] != counts["right"]:
                return None
            self._note("swapped", "soles exchanged")
            readings = {"left": right, "right": left}
        if self._both_silent(soles, sensors.accelerometer):
            return None
        lost = self._silent_sole(soles, sensors.accelerometer)
        return readings if lost is None else self._replaced(readings, lost)

    def _both_silent(self, soles: SoleCheck, accelerometer: NDArray[np.float64]) -> bool:
        """Whether both soles are stuck, or unloaded while the robot stands on both."""
        total = soles.left + soles.right
        self._carried = self._carried or total > _UNLOADED * self._weight
        silent = self._carried and total < _EMPTY * self._weight and self._last.phase.stance is None
        self._empty = self._empty + 1 if silent and _is_carried(accelerometer) else 0
        # Where one sole is known to be silent, the other's foot may still come down.
        if self._empty * self._period > (_WEIGHTLESS if self._lost is None else _LANDING):
            return True
        both = min(soles.left_same, soles.right_same) >= self._stuck and total > 0.0
        return both and self._last.phase.kind != PhaseKind.STANDING

    def _silent_sole(self, soles: SoleCheck, accelerometer: NDArray[np.float64]) -> Side | None:
        """Sole that is stuck, or unloaded while carrying."""
        weight = self._weight
        phase = self._last.phase
        if phase.kind != PhaseKind.STANDING:
            # A sole that may be in the air repeats its zeros.
            if soles.left_same >= self._stuck and soles.left > _EMPTY * weight:
                return "left"
            if soles.right_same >= self._stuck and soles.right > _EMPTY * weight:
                return "right"
        if self._lost is not None:
            own = soles.left if self._lost == "left" else soles.right
            if own > 2.0 * _EMPTY * weight:  # it carries again
                self._lost = None
            return self._lost
        light = soles.left + soles.right < _UNLOADED * weight
        self._unloaded = self._unloaded + 1 if light and _is_carried(accelerometer) else 0
        # Of two empty soles under a robot that stands on both, none replaces the other.
        if self._unloaded * self._period > _WEIGHTLESS and not self._empty:
            self._lost = phase.stance or ("left" if soles.left < soles.right else "right")
        return self._lost

    def _replaced(self, readings: Readings, lost: Side) -> Readings | None:
        """Readings with a silent sole's as an even load, the other's remainder."""
        self._note(f"{lost} sole", f"{lost} sole missing, silent or stuck: its load follows from the other's")
        other = other_side(lost)
        reading = readings[other]
        total = float(np.nansum(reading.force))
        if self._last.phase.stance == other and total < _UNLOADED * self._weight:
            return None  # both are silent
        rest = self._weight - total
        # derived: three times `_EMPTY`: less is the noise of both soles
        rest = rest if rest > 0.15 * self._weight and self._last.phase.swing != lost else 0.0
        count = self._counts[lost]
        found: dict[Side, Reading] = {
            other: reading,
            lost: Reading(reading.time, np.full(count, rest / count)),
        }
        return found


def _sound(readings: Readings, side: Side, count: int) -> Reading | None:
    """Sole's reading; None if missized or without any number."""
    reading = readings.get(side)
    if reading is None or len(reading.force) != count:
        return None
    first = reading.force.item(0)
    return None if first != first and np.isnan(reading.force).all() else reading


def _is_carried(accelerometer: NDArray[np.float64]) -> bool:
    """Whether the specific force is that of a robot on its feet, not that of a drop or a blow."""
    # chosen: wide of the 0.7 to 1.3 of a walk without impacts
    return 0.6 * GRAVITY < math.hypot(*accelerometer.tolist()) < 1.6 * GRAVITY
