"""Whether a robot lies on the floor, by the sensors that still work."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from plantar.common.gravity import GRAVITY
from plantar.common.sides import SIDES
from plantar.gait.command import Sensors
from plantar.gait.estimate.estimator import Posture
from plantar.kernels.safety.uprightness import Uprightness

_TILTED = 0.5  # derived: cosine of the trunk's tilt below which a robot has fallen: 60 degrees
_PULLED = 0.6  # chosen: cosine by the mean specific force of 0.2 s, which has to agree with the gyro
_LOW = 0.5  # chosen: share of its height below which the CoM of a robot that stands never is
_OFF = 0.1  # chosen: weight: soles with less have left the ground
_OFF_FOR = 0.3  # chosen: s: longer, no walking robot is in the air
_ANGLE = 3.2  # nature: rad: beyond, and in degrees, an angle shows nothing
_LIES = 2  # nature: what `Uprightness.update` returns of a base that does
FROZEN = 0.12
"""Time in s for which a sensor that works may report the same bits. Chosen: a train of 0.1 s is walked through."""


class FallCheck:
    """Finds falls without an estimated state: by IMU, else by soles and legs.

    Args:
        period: Of control in s.
        weight: Robot's in N.
        com_height: CoM over the soles in m.
        posture: Forward kinematics of joint angles (k,) in rad, base frame; None leaves the legs out.

    Attributes:
        knows: Whether IMU or soles show that the robot stands, or that it lies.
    """

    def __init__(
        self,
        period: float,
        weight: float,
        com_height: float,
        posture: Callable[[NDArray[np.float64]], Posture] | None = None,
    ) -> None:
        self._weight = weight
        self._height = com_height
        self._posture = posture
        self._frozen = round(FROZEN / period)
        self._most_off = round(_OFF_FOR / period)
        self._up = Uprightness(period, self._frozen, GRAVITY, (_TILTED, _PULLED))
        self._load: float | None = None
        self._same = 0
        self._off = 0
        self._carried = False
        self.knows = True

    def is_down(self, sensors: Sensors) -> bool:
        """Whether the `sensors` of a tick show that the robot has fallen; of any kind, even None."""
        found: int = self._up.update(getattr(sensors, "gyro", None), getattr(sensors, "accelerometer", None))
        if found:
            self.knows = True
            self._carried = False
            return found == _LIES
        off = self._soles_are_off(sensors)
        self.knows = off is not None
        return bool(off) or self._is_low(sensors)

    def _soles_are_off(self, sensors: Sensors) -> bool | None:
        """Whether the soles have left the ground; None where they do not work."""
        load = _load(sensors)
        self._same = self._same + 1 if load == self._load else 0
        self._load = load
        if load is None or (self._same >= self._frozen and load > 0.0):
            return None
        self._carried = self._carried or load > _OFF * self._weight
        if not self._carried:  # they were silent before: that is the fault, or the robot lies already
            return None
        self._off = self._off + 1 if load < _OFF * self._weight else 0
        return self._off >= self._most_off

    def _is_low(self, sensors: Sensors) -> bool:
        """Whether the legs have folded under the body."""
        joints = getattr(sensors, "joint_positions", None)
        if self._posture is None or not isinstance(joints, np.ndarray) or not (np.abs(joints) < _ANGLE).all():
            return False
        posture = self._posture(joints)
        height = max(float(posture.com[2] - posture.positions[side][2]) for side in SIDES)
        return height < _LOW * self._height


def _load(sensors: Sensors) -> float | None:
    """Force in N on both soles; None where one cannot be read."""
    readings = getattr(sensors, "readings", None)
    if not isinstance(readings, dict):
        return None
    total = 0.0
    for side in SIDES:
        force = getattr(readings.get(side), "force", None)
        if force is None or np.isnan(force).all():
            return None
        total += float(np.nansum(force))
    return total
