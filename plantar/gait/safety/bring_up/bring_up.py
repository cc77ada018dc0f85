"""Bring-up: a robot stands, leans and unloads each foot, and what its sensors report has to fit."""

import math
from collections.abc import Mapping, Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from plantar.common.sides import Side
from plantar.gait.command import Command, Sensors
from plantar.gait.estimate.estimator import Posture
from plantar.gait.safety.bring_up.body_motion import BodyMotion, body_motion
from plantar.gait.safety.bring_up.delay_checks import check_delays, joint_delay
from plantar.gait.safety.bring_up.finding import Finding
from plantar.gait.safety.bring_up.imu_checks import check_imu
from plantar.gait.safety.bring_up.joint_checks import check_joints, check_planes
from plantar.gait.safety.bring_up.motion import LEANED, STOOD, UNLOADED, BringUpMotion
from plantar.gait.safety.bring_up.sole_checks import check_leaning_soles, check_standing_soles, check_unloaded_soles
from plantar.gait.safety.bring_up.trace import Trace
from plantar.layouts.layout import SoleLayout
from plantar.mechanics.lip import GRAVITY

_PATIENCE = 1.0  # s without a reading that can be used, until that is the finding
_LEANS_OVER = 0.7  # cosine of the turn of the specific force since the start, from which on the robot falls
_SMOOTHED = 0.1  # s of that force's low-pass
_MOST_OFF = 0.25  # share of the weight that the left foot carries more than half, and that the shifts take back
_CLOCK = (0.5, 2.0)  # of a period between two ticks by the sensors' time


class BringUpLegs(Protocol):
    """Legs that are solved for commands, apart from those of the control loop.

    Attributes:
        joints: Angles (k,) in rad of the last `follow`.
    """

    joints: NDArray[np.float64]

    def posture(self, joint_positions: NDArray[np.float64]) -> Posture:
        """Forward kinematics of joint positions (k,) in rad, base frame."""
        ...

    def follow(
        self,
        com: NDArray[np.float64],
        rotation_torso: NDArray[np.float64],
        positions: Mapping[Side, NDArray[np.float64]],
        rotations: Mapping[Side, NDArray[np.float64]],
    ) -> float:
        """Solve for CoM (3,) in m, torso (3, 3) and soles."""
        ...


class BringUp:
    """Checks a robot before its first step; call `step` once a tick instead of the walking controller's.

    Args:
        stand: Command of the standing robot.
        vrps: VRP (2,) over each foot, world frame, in m.
        omega: Pendulum's in rad/s.
        layouts: Of each side.
        legs: Solved for what is commanded.
        imu: Its place (3,) in m in the base's frame.
        names: Of the joints.
        mass: Robot's in kg.
        period: Of control in s.

    Attributes:
        findings: What is wrong, once `ended`.
        passed: Whether the robot may walk.
        ended: Whether all that can be checked is.
        fell: Whether the robot fell over meanwhile.
        stage: "stands", "leans", "unloads", "passed" or "refused".
    """

    def __init__(
        self,
        stand: Command,
        vrps: Mapping[Side, NDArray[np.float64]],
        omega: float,
        layouts: Mapping[Side, SoleLayout],
        legs: BringUpLegs,
        imu: NDArray[np.float64],
        names: Sequence[str],
        mass: float,
        period: float,
    ) -> None:
        self._motion = BringUpMotion(stand, vrps, omega)
        self._width = float(np.linalg.norm(vrps["left"] - vrps["right"]))
        self._legs = legs
        self._imu = imu
        self._names = tuple(names)
        self._weight = mass * GRAVITY
        self._period = period
        self._trace = Trace(layouts, len(self._names))
        self._ticks = 0
        self._missed = 0
        self._first: NDArray[np.float64] | None = None
        self._pull = np.zeros(3)
        self._last = stand
        self.findings: tuple[Finding, ...] = ()
        self.passed = False
        self.ended = False
        self.fell = False
        self.stage = "stands"

    @property
    def duration(self) -> float:
        """Time in s that a sound robot takes."""
        return UNLOADED

    @property
    def time(self) -> float:
        """Time in s of the checks so far."""
        return self._ticks * self._period

    def step(self, sensors: Sensors) -> Command:
        """Command of a tick; once `ended` the last one."""
        if self._falls(sensors):
            self._refuse([Finding("robot leans over", "its specific force has turned by 45 degrees", "it stands")])
            self.fell = True
        if self.ended:
            return self._last
        time = self._ticks * self._period
        command = self._motion.at(time)
        self._legs.follow(
            command.com,
            command.rotation_torso,
            {side: foot.position for side, foot in command.feet.items()},
            {side: foot.rotation for side, foot in command.feet.items()},
        )
        missing = self._trace.add(time, sensors, self._legs.joints)
        if missing is not None:
            self._missed += 1
            if self._missed * self._period > _PATIENCE:
                text = f"no usable value for {_PATIENCE} s"
                self._refuse([Finding(f"{missing} missing or of another size", text, "a number for each")])
            return self._last
        self._ticks += 1
        self._last = command
        self._advance()
        return command

    def _advance(self) -> None:
        """Judge at the end of a stage."""
        # By ticks: a time that is summed up may pass an end by less than what it is rounded to.
        if self._ticks == round(STOOD / self._period):
            self.stage = "leans"
        elif self._ticks == round(LEANED / self._period):
            self._judge_leans()
        elif self._ticks == round(UNLOADED / self._period):
            self._judge_shifts()

    def _judge_leans(self) -> None:
        trace = self._trace.table()
        soles = check_standing_soles(trace, self._weight)
        late = joint_delay(trace)
        joints = check_joints(trace, self._names, late)
        # Encoders show what soles and IMU have to measure. With wrong ones no more than the torso's turns are known.
        motion = self._moved(trace, "expected" if joints else "joints")
        imu, gyro = check_imu(trace, motion, commanded=bool(joints))
        found = [*_clock(trace, self._period), *imu, *joints, *soles]
        if not joints:
            found += check_delays(late, None if imu else gyro, self._period)
            found += check_planes(trace, self._legs.posture, level=not imu)
            if not any("silent" in finding.cause for finding in soles):
                found += check_leaning_soles(trace, motion)
        if found:
            self._refuse(found)
            return
        rest = trace["time"] < STOOD
        left = trace["load_left"][rest].mean()
        right = trace["load_right"][rest].mean()
        off = float(left / (left + right)) - 0.5
        self._motion.shift(min(_MOST_OFF, max(-_MOST_OFF, off)))
        self.stage = "unloads"

    def _judge_shifts(self) -> None:
        trace = self._trace.table()
        shifted = {name: rows[trace["time"] >= LEANED] for name, rows in trace.items()}
        found = check_unloaded_soles(shifted, self._moved(shifted, "joints"), self._weight, self._width)
        if found:
            self._refuse(found)
            return
        self.ended = True
        self.passed = True
        self.stage = "passed"

    def _moved(self, trace: Mapping[str, NDArray[np.float64]], joints: str) -> BodyMotion:
        return body_motion(trace[joints], self._legs.posture, self._imu, self._period)

    def _refuse(self, findings: Sequence[Finding]) -> None:
        if not self.ended:
            self.findings = tuple(findings)
            self.ended = True
            self.stage = "refused"

    def _falls(self, sensors: Sensors) -> bool:
        """Whether the specific force has turned since the start, whatever the accelerometer's axes and unit."""
        pull: Any = getattr(sensors, "accelerometer", None)
        if not isinstance(pull, np.ndarray) or pull.shape != (3,) or not np.isfinite(pull).all():
            return False
        size = float(np.linalg.norm(pull))
        if size < 1e-9:
            return False
        if self._first is None:
            self._first = pull / size
            self._pull = pull / size
        self._pull = self._pull + min(1.0, self._period / _SMOOTHED) * (pull / size - self._pull)
        length = float(np.linalg.norm(self._pull))
        return length > 0.0 and float(self._first @ self._pull) / length < _LEANS_OVER


def _clock(trace: Mapping[str, NDArray[np.float64]], period: float) -> list[Finding]:
    """Findings of the sensors' time."""
    passed = float(np.median(np.diff(trace["clock"]))) / period
    if not math.isfinite(passed) or _CLOCK[0] < passed < _CLOCK[1]:
        return []
    cause = "time in milliseconds" if 500.0 < passed < 2000.0 else "time in another unit, or period not kept"
    return [Finding(cause, f"{passed * period:.4g} between ticks", f"{period:g} s")]
