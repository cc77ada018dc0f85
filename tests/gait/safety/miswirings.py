"""Robots that are wired the wrong way: what arrives of a reading, and the cause that bring-up has to name."""

from collections.abc import Callable, Mapping

import numpy as np

from plantar.common.sides import SIDES
from plantar.gait.command import Sensors
from plantar.mechanics.rotation import rotation_from_vector
from plantar.sensing.reading import Reading

Wiring = Callable[[Sensors], Sensors]


def body(**changes) -> Wiring:
    """Change encoders or IMU by functions of their arrays."""

    def wired(sensors):
        changed = {name: np.ascontiguousarray(change(getattr(sensors, name))) for name, change in changes.items()}
        return sensors.changed(**changed)

    return wired


def taxels(change, sides=SIDES) -> Wiring:
    """Change the taxels' forces of some soles."""

    def wired(sensors):
        given = sensors.readings
        return sensors.changed(
            readings={s: Reading(given[s].time, change(given[s].force)) if s in sides else given[s] for s in SIDES}
        )

    return wired


def turned(x, y, z) -> Wiring:
    """Mount the IMU turned by degrees about an axis."""
    turn = rotation_from_vector(np.radians([x, y, z]))
    return body(gyro=lambda rate: turn @ rate, accelerometer=lambda pull: turn @ pull)


def encoder(joint, change) -> Wiring:
    """Change one joint's angle."""

    def changed(angles):
        angles = angles.copy()
        angles[joint] = change(angles[joint])
        return angles

    return body(joint_positions=changed)


def exchanged(i, j) -> Wiring:
    """Exchange two joints' encoders."""

    def changed(angles):
        angles = angles.copy()
        angles[[i, j]] = angles[[j, i]]
        return angles

    return body(joint_positions=changed)


class Late:
    """Encoders that arrive some ticks late."""

    def __init__(self, ticks):
        self._ticks = ticks
        self._sent = []

    def __call__(self, sensors):
        self._sent.append(sensors.joint_positions)
        return sensors.changed(joint_positions=self._sent[max(0, len(self._sent) - 1 - self._ticks)])


def exchanged_soles(sensors: Sensors) -> Sensors:
    return sensors.changed(readings={"left": sensors.readings["right"], "right": sensors.readings["left"]})


MISWIRINGS: Mapping[str, tuple[Callable[[], Wiring], str]] = {
    "soles exchanged": (lambda: exchanged_soles, "soles exchanged"),
    "taxels x 10": (lambda: taxels(lambda force: 10.0 * force), "taxels ten times too large"),
    "taxels in kg": (lambda: taxels(lambda force: force / 9.81), "taxels ten times too small, or in kilograms"),
    "left skin zero": (lambda: taxels(lambda force: 0.0 * force, ("left",)), "left sole silent"),
    "left skin x 3": (lambda: taxels(lambda force: 3.0 * force, ("left",)), "left sole reads 3.0 times"),
    "taxel order reversed": (
        lambda: taxels(lambda force: force[::-1].copy()),
        "taxel order of the right sole reversed",
    ),
    "right taxel order reversed": (
        lambda: taxels(lambda force: force[::-1].copy(), ("right",)),
        "taxel order of the right sole reversed",
    ),
    "IMU turned about z": (lambda: turned(0, 0, 90), "IMU turned by 90 degrees about z"),
    "IMU turned about y": (lambda: turned(0, 90, 0), "IMU turned by 90 degrees about y"),
    "IMU upside down": (lambda: turned(180, 0, 0), "IMU turned by 180 degrees about x"),
    "gyro in degrees": (lambda: body(gyro=np.degrees), "gyro in degrees"),
    "gyro's signs": (lambda: body(gyro=lambda rate: -rate), "gyro's signs turned"),
    "gyro's axes": (lambda: body(gyro=lambda rate: rate[[1, 0, 2]]), "gyro's axes x and y exchanged"),
    "gyro zero": (lambda: body(gyro=lambda rate: 0.0 * rate), "gyro silent"),
    "accelerometer in g": (lambda: body(accelerometer=lambda pull: pull / 9.81), "accelerometer in g"),
    "accelerometer's signs": (lambda: body(accelerometer=lambda pull: -pull), "accelerometer's signs turned"),
    "accelerometer's x": (
        lambda: body(accelerometer=lambda pull: pull * [-1.0, 1.0, 1.0]),
        "accelerometer's sign of x turned",
    ),
    "degrees": (lambda: body(joint_positions=np.degrees), "joint angles in degrees"),
    "all joints' signs": (lambda: body(joint_positions=lambda angles: -angles), "signs of all joint angles turned"),
    "encoders of the legs": (
        lambda: body(joint_positions=lambda angles: np.roll(angles, len(angles) // 2)),
        "encoders of the legs exchanged",
    ),
    "a hip's sign": (lambda: encoder(1, lambda angle: -angle), "sign of the encoder of left_hip_roll turned"),
    "a knee's zero": (lambda: encoder(9, lambda angle: angle + 0.3), "encoder of right_knee off by 0.30 rad"),
    "two encoders": (lambda: exchanged(0, 1), "encoders of left_hip_yaw and left_hip_roll exchanged"),
    "encoders late": (lambda: Late(10), "encoders late"),
    "milliseconds": (lambda: lambda sensors: sensors.changed(time=1e3 * sensors.time), "time in milliseconds"),
}
"""How each is wired, and how the cause that is named begins."""
