"""Whether an arm's gains can be held at a control period, with what touches its skin, and within its torques.

The torques of a controller are linearised about a posture. Between two ticks they are held, and the arm moves on with
the contact's spring and damper as a linear system, whose exact step is a matrix exponential. Gains can be held where no
eigenvalue of that step is outside the unit circle.

Source: Franklin, Powell and Workman, Digital control of dynamic systems (1998), 4.3.
"""

import warnings
from collections.abc import Callable
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import expm

from plantar.common.arguments import number, positive
from plantar.common.arrays import array
from plantar.errors import InputError
from plantar.sensing.link_skin import BodySkin, SkinPatch
from plantar.sensing.reading import Reading
from plantar.wholebody.dynamics import RobotDynamics

_STEP = 1e-5  # rad and rad/s, or m: of the central differences
_GROWS = 1e-3  # a tick: rounding moves the eigenvalues of what drifts freely, two of 1 each, by less


class MovableDynamics(RobotDynamics, Protocol):
    """A robot model that can be put into other states."""

    def update(self, qpos: NDArray[np.float64], qvel: NDArray[np.float64], time: float) -> None: ...


class GainWarning(UserWarning):
    """Gains that cannot be held."""


Control = Callable[[RobotDynamics, Reading], NDArray[np.float64]]
"""Torques (k,) by a robot's dynamics and its skin, such as of a `TaskStack`."""


def check_gains(
    robot: MovableDynamics,
    control: Control,
    skin: BodySkin,
    period: float,
    limits: ArrayLike,
    *,
    push: float = 20.0,
    give: float = 0.01,
    contact: tuple[float, float] = (0.02, 1.0),
) -> list[str]:
    """Warn of gains that cannot be held about the robot's posture now, and return the warnings.

    Checked are the free motion, and a touch on the middle of each patch of the skin and on what looks to its sides:
    whether torques suffice, whether it yields, and whether it grows.

    Args:
        robot: Of a fixed base, with all joints driven; put back as it was.
        control: Called some hundred times at states nearby; its result must not depend on the call before.
        skin: The skin.
        period: Of control in s.
        limits: Largest torque (k,) of each joint in N m or N.
        push: Largest force of a touch in N, that the torques have to suffice for.
        give: How far in m the skin should yield to it, at rest; 0 for not at all.
        contact: Time constant in s and damping ratio of a touch, as MuJoCo's `solref`.

    Returns:
        A sentence each, also given as a `GainWarning`; empty where all gains can be held.

    Raises:
        InputError: If the base is free, a joint is not driven, or a value is not allowed.
    """
    dt = positive(period, "period", "s")
    positive(push, "push", "N")
    if not number(give, "give", finite=True) >= 0.0:
        raise InputError(f"give is {give} m; allowed: 0 or more")
    constant = positive(contact[0], "time constant of a contact", "s")
    ratio = positive(contact[1], "damping ratio of a contact", "1")
    start = np.array(robot.joint_positions)
    speed = np.array(robot.velocity)
    if len(robot.joints) != len(speed):
        raise InputError("gains are checked of a robot with a fixed base whose joints are all driven")
    most = array(limits, "limits", (len(start),))
    plant = _Plant(robot, control, skin, start)
    try:
        found = plant.torques(most, push)
        growth = plant.free().growth(dt)
        if growth > 1.0 + _GROWS:
            found.append(
                f"free motion grows by e in {dt / np.log(growth):.2g} s at a period of {1e3 * dt:g} ms: lower the "
                "damping or stiffness of the tasks, or the period"
            )
        else:
            for patch in skin.patches:
                touches = [plant.touched(taxel, push) for taxel in plant.taxels(patch)]
                yielded = min(push * touch.compliance() for touch in touches)
                if yielded < give:
                    found.append(
                        f"patch '{patch.name}' yields by {1e3 * yielded:.2g} mm to {push:g} N, less than "
                        f"{1e3 * give:g} mm: what moves into it meets large forces; lower the stiffness of the tasks "
                        "above the touch"
                    )
                touched = max(touch.growth(dt, constant, ratio) for touch in touches)
                if touched > max(growth, 1.0) + _GROWS:
                    found.append(
                        f"a touch on patch '{patch.name}' grows by e in {dt / np.log(touched):.2g} s at a period of "
                        f"{1e3 * dt:g} ms: lower the gain on touches, give their task damping, or lower the period"
                    )
    finally:
        robot.update(start, speed, robot.time)
    for sentence in found:
        warnings.warn(sentence, GainWarning, stacklevel=2)
    return found


class _Plant:
    """A controlled arm about a posture at rest."""

    def __init__(self, robot: MovableDynamics, control: Control, skin: BodySkin, start: NDArray[np.float64]) -> None:
        self.robot = robot
        self.control = control
        self.skin = skin
        self.start = start
        self.still = np.zeros(len(start))

    def torque(
        self, position: NDArray[np.float64], velocity: NDArray[np.float64], taxel: int = 0, force: float = 0.0
    ) -> NDArray[np.float64]:
        """Torques in a state, with a force in N on one taxel; leaves the robot there."""
        self.robot.update(position, velocity, self.robot.time)
        forces = np.zeros(len(self.skin))
        forces[taxel] = force
        return np.array(self.control(self.robot, Reading(0.0, forces)))

    def taxels(self, patch: SkinPatch) -> list[int]:
        """Numbers of a patch's middle taxel, and of those that look farthest to each side."""
        normals = patch.rotations[:, :, 2]
        sides = [int(np.argmax(sign * normals[:, k])) for k in range(3) for sign in (1.0, -1.0)]
        first = self.skin.slices[patch.name].start
        return [first + i for i in dict.fromkeys([int(patch.from_middle[0]), *sides])]

    def torques(self, limits: NDArray[np.float64], push: float) -> list[str]:
        """What the torques do not suffice for: the posture, or a push on a patch."""
        rest = np.abs(self.torque(self.start, self.still))
        if (rest > limits).any():
            worst = int(np.argmax(rest - limits))
            return [f"joint {worst} needs {rest[worst]:.3g} N m to hold its posture; its limit is {limits[worst]:.3g}"]
        found = []
        for patch in self.skin.patches:
            answers = [np.abs(self.torque(self.start, self.still, taxel, push)) for taxel in self.taxels(patch)]
            asked = np.max(answers, axis=0)
            if (asked > limits).any():
                worst = int(np.argmax(asked - limits))
                found.append(
                    f"{push:g} N on patch '{patch.name}' ask joint {worst} for {asked[worst]:.3g} N m; its limit is "
                    f"{limits[worst]:.3g}: lower the gain on touches"
                )
        return found

    def free(self) -> "_Linear":
        """The arm where nothing touches it."""
        untouched = np.zeros(len(self.start))
        return self._linear(*self.rates(0, 0.0), untouched, untouched)

    def touched(self, taxel: int, force: float) -> "_Linear":
        """The arm with a force in N on a taxel."""
        by_place, by_speed = self.rates(taxel, force)
        answer = self.answer(taxel, force)
        return self._linear(by_place, by_speed, self.row(taxel), answer)

    def _linear(self, *given: NDArray[np.float64]) -> "_Linear":
        self.robot.update(self.start, self.still, self.robot.time)
        inverse = np.asarray(np.linalg.inv(self.robot.mass_matrix), dtype=np.float64)
        return _Linear(inverse, *given)

    def row(self, taxel: int) -> NDArray[np.float64]:
        """Jacobian (n,) of a taxel's place along its axis, in the robot's state now."""
        link = self.skin.links[self.skin.link_of[taxel]]
        axis = self.robot.pose(link)[1] @ self.skin.normals[taxel]
        return np.asarray(axis @ self.robot.jacobian(link, self.skin.positions[taxel])[:3])

    def answer(self, taxel: int, force: float) -> NDArray[np.float64]:
        """Torques (n,) per N on a taxel."""
        more, less = (self.torque(self.start, self.still, taxel, force + sign * 1e-3) for sign in (1.0, -1.0))
        return np.asarray((more - less) / 2e-3)

    def rates(self, taxel: int, force: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Rates (2, n, n) of torques and of the bias by place, and by speed."""
        count = len(self.start)
        by_place = np.empty((2, count, count))
        by_speed = np.empty((2, count, count))
        for i in range(count):
            off = _STEP * np.eye(count)[i]
            for rates, place, speed in ((by_place, off, self.still), (by_speed, self.still, off)):
                ends = []
                for sign in (1.0, -1.0):
                    torque = self.torque(self.start + sign * place, sign * speed, taxel, force)
                    ends.append(np.array([torque, self.robot.bias]))
                rates[:, :, i] = (ends[0] - ends[1]) / (2.0 * _STEP)
        return by_place, by_speed


class _Linear(NamedTuple):
    """An arm and its controller about a posture at rest, n joints.

    `inverse`: of the mass matrix (n, n); `by_place`, `by_speed`: rates (2, n, n) of torques and of the bias; `row`:
    Jacobian (n,) of the touched taxel's place along its axis; `answer`: torques (n,) per N on it; zeros of both where
    nothing touches.
    """

    inverse: NDArray[np.float64]
    by_place: NDArray[np.float64]
    by_speed: NDArray[np.float64]
    row: NDArray[np.float64]
    answer: NDArray[np.float64]

    def compliance(self) -> float:
        """How far in m per N the taxel gives way in the end; infinity where no spring holds it."""
        torques, bias = self.by_place
        pushed = self.row + self.answer
        moved, _, rank, _ = np.linalg.lstsq(bias - torques, pushed, rcond=1e-9)
        if rank < len(pushed) and np.abs((bias - torques) @ moved - pushed).max() > 1e-6 * np.abs(pushed).max():
            return np.inf
        return abs(float(self.row @ moved))

    def growth(self, period: float, constant: float = 1.0, ratio: float = 1.0) -> float:
        """Largest magnitude of an eigenvalue of one tick, with a touch's spring and damper."""
        count = len(self.row)
        row = self.row
        inverse = self.inverse
        mass = 1.0 / max(float(row @ inverse @ row), 1e-9)
        stiffness = mass / (constant * ratio) ** 2
        damping = 2.0 * mass / constant
        place = slice(count)
        speed = slice(count, 2 * count)
        torque = slice(2 * count, 3 * count)
        moves = np.zeros((3 * count, 3 * count))
        moves[place, speed] = np.eye(count)
        moves[speed, place] = -inverse @ self.by_place[1] - inverse @ np.outer(row, stiffness * row)
        moves[speed, speed] = -inverse @ self.by_speed[1] - inverse @ np.outer(row, damping * row)
        moves[speed, torque] = inverse
        # The skin reads the spring's and the damper's force.
        read = np.outer(self.answer, np.concatenate([stiffness * row, damping * row]))
        held = np.hstack([self.by_place[0], self.by_speed[0]]) - read
        step = expm(moves * period)
        closed = step[: 2 * count, : 2 * count] + step[: 2 * count, torque] @ held
        return float(np.abs(np.linalg.eigvals(closed)).max())
