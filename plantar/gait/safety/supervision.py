"""Supervision: what drives, encoders, IMU and soles report of one motion has to agree.

It notes what does not, for whoever reads the log. Of one joint that does not follow its targets, or two, it takes the
targets, unless the standing sole shows that the joint is where its encoder has it: a drive at its torque limit does not
follow either. Where most joints do not, or soles are late, it calls that grave.
"""

import math
from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.common.gravity import GRAVITY
from plantar.common.sides import SIDES, Side
from plantar.gait.command import Command, Sensors
from plantar.kernels.safety.plausible import BodyCheck, SoleCheck
from plantar.kernels.safety.sensor_watch import (
    ACCELERATION,
    ENCODER_NOISE,
    GYRO_NOISE,
    LATE,
    LOAD,
    SELDOM,
    TURN,
    SensorWatch,
)
from plantar.kernels.safety.tracking import TrackingCheck
from plantar.layouts.layout import SoleLayout

# Each limit is a share of what the robot itself has shown, and a constant. The constants are measured: on 38 walks of
# drawn plants of level 3, which are four robots' over flat and uneven ground and stones, turning and pushed, and 11
# with stepping in place under pushes and hands, no signal passed that share by more than is said below.
# chosen: of the largest in earlier single supports. 20 % less notes the load in one of 24 walks of drawn plants of
# level 3, and names gyro's axes on h1 after 0.19 s, not 0.47; 20 % more notes none; 19 other faults move by 0.09 s
_SHARE = 2.0
# measured: likewise of joints: a hard push bends a soft hip by five times what it missed by before; +-20 % notes none
# of those walks, and moves the time of one of 20 faults, by 0.01 s
_DRIVES = 4.0
_MOST_OFF = 0.5  # measured: rad; with a quarter of the drives' stiffness knees miss their targets by 0.3
# rad by which a joint misses its target: standing (measured: 0.036), in the first single support (0.23), later (0.021)
_MISSES = (0.06, 0.35, 0.03)
_OFF = 0.1  # chosen: rad: three times that, beyond which a robot does not walk on where more joints miss than two
_OFF_FOR = 0.015  # chosen: s after which it counts; three ticks
_SETTLED = 0.25  # chosen: s of standing after which its errors count as usual
# derived: of what a joint misses its target by, that its standing sole turns by: all of it where its encoder is wrong,
# nothing where it is right; half is between
_STILL = 0.5
_MOST_TAKEN = 2  # chosen: joints whose encoders fail at a time; more are moved from outside, as by a blow
_OPENING = 0.5  # derived: s in which the estimator averages gravity, and its state may jump
_ACCELERATION = 0.5  # measured: m/s^2: a push reaches 0.36, all else 0.1
_TURN = 0.07  # measured: rad: 0.027 in 21 walks of drawn plants of level 3 that did not fall; +-20 %: none noted
# share of the weight on the soles: measured: 0.13 after the first single support, of a robot that hands lead; 0.41
# until then
_LOAD = (0.18, 0.5)
_WINDOW = 0.3  # chosen: s of acceleration: a fault is to be named within
_MEAN = 0.06  # measured: s in which a speed is differenced; half as much doubles the noise
_SHORT = 0.2  # chosen: s of the load: a landing is shorter
# measured: second differences of gyro in rad/s, 0.022, and of encoders in rad, with the share of them, 0.11
_NOISES = (0.045, 1e-3, 0.25)
_REPEATED = 0.05  # chosen: s: a sensor of 20 Hz or less is none for a walk
_OLDER = 0.03  # measured: s by which a sole's reading is older than the freshest one was; 0.004 on sound soles
_OLDER_FOR = 4  # chosen: readings in turn
_TOO_LATE = 0.06  # chosen: s by which soles are too late to walk by, a sixth of the shortest single support
_LATE_FOR = 0.1  # chosen: s for which they are; longer than a cable's stutter
_MOVED_FOR = 0.1  # chosen: s for which more joints may be off than encoders fail at a time: a blow is shorter
_FLAT = 0.5  # derived: spread of a flat sole's load, of that of an even one; a row of taxels has less than 0.3


class Supervision:
    """Compares what sensors report of one motion.

    Args:
        layouts: Of each side.
        mass: Robot's in kg.
        period: Of control in s.
        note: Logs a text of a kind, at times.

    Attributes:
        grave: What the robot cannot walk on with, in words; empty for nothing.
        repeated: Ticks after which the same bits of a sensor are noted.
        tracking: Measured against commanded joint angles; None before the first commanded ones.
    """

    def __init__(
        self, layouts: Mapping[Side, SoleLayout], mass: float, period: float, note: Callable[[str, str], None]
    ) -> None:
        self._positions = tuple(layouts[side].positions for side in SIDES)
        self._mass = mass
        self._period = period
        self._note = note
        self._watch: SensorWatch | None = None
        self._stance: Side | None = None
        self._waits = round(_OPENING / period)
        self.repeated = round(_REPEATED / period)
        self._named = ""
        self._moved = 0
        self._taken: set[int] = set()
        self._true: set[int] = set()
        self._stood: tuple[Side | None, NDArray[np.float64]] = (None, np.eye(3))
        self.grave = ""
        self.tracking: TrackingCheck | None = None

    def restart_clock(self) -> None:
        """The clock has another zero: readings have other ages."""
        if self._watch is not None:
            self._watch.restart_clock()

    def skip(self) -> None:
        """Ticks were missed."""
        if self._watch is not None:
            self._watch.skip()

    def followed(
        self, sensors: Sensors, commanded: NDArray[np.float64], body: BodyCheck | None, last: Command
    ) -> Sensors:
        """Sensors with the commanded angle of a joint that does not follow, unless its encoder is shown to be right.

        `commanded`: angles (k,) in rad that the drives were given before the `sensors` were read; `body`: which
        finds jumps of encoders, that are taken off later on, and compares angles with those of the last tick; `last`:
        command of the last tick, whose state was estimated by the angles that it took.
        """
        if last.phase.stance is not self._stood[0]:
            stance = last.phase.stance
            self._stood = (stance, np.eye(3) if stance is None else last.state.rotations_sole[stance])
        if len(sensors.joint_positions) != len(commanded):
            return sensors
        tracking = self.tracking
        if tracking is None:
            ticks = round(_SETTLED / self._period)
            confirmed = max(1, round(_OFF_FOR / self._period))
            tracking = TrackingCheck(len(commanded), confirmed, _MOST_OFF, _DRIVES, _MISSES, _OFF, ticks)
            self.tracking = tracking
        measured = sensors.joint_positions
        slips = body.slips if body is not None and body.slipped else None
        angles = measured if slips is None else measured - slips
        far = tracking.update(angles, commanded)
        count = tracking.noticed_count
        if count or self._taken:
            noticed = set(np.flatnonzero(tracking.noticed).tolist())
            self._true &= noticed
            for joint in noticed - self._true - self._taken:
                if self._is_true(joint, angles, commanded, last):
                    self._true.add(joint)
            taken = noticed - self._true if 0 < count <= _MOST_TAKEN else set()
            if body is not None:
                for joint in taken ^ self._taken:
                    body.forget(joint)
            self._taken = taken
        if not count:
            self._named = ""
            return sensors
        which = ", ".join(map(str, np.flatnonzero(tracking.noticed)))
        if which != self._named:
            self._named = which
            self._note(f"tracking {which}", f"joints that do not follow their targets, counted from 0: {which}")
        self._moved = self._moved + 1 if far > _MOST_TAKEN else 0
        if self._moved * self._period > _MOVED_FOR:
            self.grave = "the joints do not follow their targets, or encoders are late"
        if not self._taken:
            return sensors
        given = commanded if slips is None else commanded + slips
        replaced = measured.copy()
        for joint in self._taken:
            replaced[joint] = given[joint]
        return sensors.changed(joint_positions=replaced)

    def _is_true(self, joint: int, angles: NDArray[np.float64], commanded: NDArray[np.float64], last: Command) -> bool:
        """Whether a joint is where its encoder has it, and its drive is too weak: by a wrong angle of the standing leg
        its sole would have turned by as much as the joint misses its target.
        """
        stance, stood = self._stood
        leg = len(angles) // 2
        if stance is None or len(angles) % 2 or SIDES[joint // leg] != stance:
            return False
        # nature: the trace of a rotation is 1 + 2 cos of its angle
        cosine = 0.5 * (float((stood * last.state.rotations_sole[stance]).sum()) - 1.0)
        turn = math.acos(min(1.0, max(-1.0, cosine)))
        miss = abs(float(angles[joint] - commanded[joint]))
        # No drive is half a turn off its target; such an angle is not taken, so that the sole does not seem to turn.
        return miss < math.pi and turn < _STILL * miss

    def compare(self, sensors: Sensors, command: Command, soles: SoleCheck, reported: float, whole: bool) -> None:
        """Compare a tick's `sensors` with the state of the `command` that answers them.

        `soles`: holds the force on each; `reported`: the tick's time in s as it came; `whole`: no sole is replaced and
        no number is missing, without which the standing sole's turn alone is looked at.
        """
        if self._waits > 0:
            self._waits -= 1
            return
        watch = self._watch
        if watch is None:
            window = round(_WINDOW / self._period)
            mean = round(_MEAN / self._period)
            short = round(_SHORT / self._period)
            joints = len(sensors.joint_positions)
            leasts = (_ACCELERATION, _TURN, *_LOAD)
            ages = (_OLDER, _OLDER_FOR)
            sizes = (window, mean, short)
            mass = self._mass
            positions = self._positions
            limits = (_SHARE, leasts, *ages, _FLAT, _NOISES)
            watch = SensorWatch(joints, mass, GRAVITY, positions, self._period, *sizes, *limits)
            self._watch = watch
        stance = command.phase.stance
        if stance is not self._stance:
            self._change_stance(watch, stance)
        if whole:
            found = watch.update(sensors, command, soles.left, soles.right, reported)
        else:
            watch.skip()
            found = watch.turned(sensors, command, soles.left, soles.right)
        if found:
            self._name(found, watch)

    def _change_stance(self, watch: SensorWatch, stance: Side | None) -> None:
        """Learn what a single support that has ended showed."""
        if self._stance is not None:
            watch.end_support()
        if stance is not None:
            watch.begin_support(stance == "right")
        if self.tracking is not None:
            if self._stance is not None:
                self.tracking.end_support()
            if stance is not None:
                self.tracking.begin_support()
        self._stance = stance

    def _name(self, found: int, watch: SensorWatch) -> None:
        """Put codes in words."""
        if found >= LATE:
            self._name_ages(found, watch)
        if found & ACCELERATION:
            self._note(
                "acceleration", f"accelerometer {watch.acceleration:.1f} m/s^2 off the motion by encoders and gyro"
            )
        if found & LOAD:
            self._note("load", f"soles report {watch.load:.2f} of the weight that the accelerometer shows")
        if found & GYRO_NOISE:
            self._note("gyro noise", "gyro jumps to and fro")
        if found & ENCODER_NOISE:
            self._note("encoder noise", "encoders jump to and fro, or go in coarse steps")
        if found & TURN:
            self.grave = "the standing sole turns, by encoders and IMU, but presses as a flat one"

    def _name_ages(self, found: int, watch: SensorWatch) -> None:
        """Put what is late or comes seldom in words."""
        for i, side in enumerate(SIDES):
            later = watch.later[i]
            if found & SELDOM << i:
                self._note(f"{side} gap", f"no new readings of the {side} sole for {later:.2f} s")
            elif found & LATE << i:
                self._note(f"{side} age", f"readings of the {side} sole come {later:.2f} s later than they did")
                if later > _TOO_LATE and watch.late[i] * self._period > _LATE_FOR:
                    self.grave = "the soles' readings come too late to walk by"
