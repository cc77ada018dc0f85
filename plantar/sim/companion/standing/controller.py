"""The controller of a machine that stands: base, filtered skin, tasks."""

from collections.abc import Callable, Sequence
from time import perf_counter
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from plantar.common.settings.schema import number, switch
from plantar.mechanics.lip import GRAVITY
from plantar.sensing.link_skin import BodySkin, link_wrenches
from plantar.sensing.reading import Reading
from plantar.sim.companion.dynamics import MujocoDynamics
from plantar.sim.companion.experiment import CompanionControl, Controller
from plantar.sim.companion.standing.stance import Stance
from plantar.wholebody.stack import TaskStack
from plantar.wholebody.tasks.center_of_mass import CenterOfMass
from plantar.wholebody.tasks.task import Task

_WARMING = 0.2  # s: time constant of the filter of temperatures


class StandingControl(CompanionControl):
    """How a standing machine is controlled.

    Attributes:
        skin: Whether skin tasks run and contact forces count.
        gain: Factor on contact forces; 1 yields as without friction and gears.
        lean: Share of the contacts' moment that the centre of mass is shifted against.
        lean_limit: Largest shift in m.
        filter: Time constant in s of each taxel force's low pass.
        balance: Stiffness of the centre of mass over the feet.
        posture: Stiffness in N m/rad for a joint of 75 N m; others by their torque.
        posture_damping: Likewise, in N m s/rad.
    """

    skin: bool = switch(True)
    gain: float = number(3.0, "1", 0.0, 100.0)
    lean: float = number(0.7, "1", 0.0, 1.5)
    lean_filter: ClassVar[float] = 0.15  # Time constant in s of that shift
    lean_limit: float = number(0.035, "m", 0.0, 0.5)
    filter: float = number(0.04, "s", 0.0, 1.0)
    balance: float = number(60.0, "1/s^2", 1.0, 1000.0)
    posture: float = number(120.0, "N m/rad", 0.0, 5000.0)
    posture_damping: float = number(12.0, "N m s/rad", 0.0, 500.0)


class StandingController(Controller):
    """Runs a stack on a stance, by the measured robot put on its feet.

    `stance`: the standing feet, fixed to first places; `levels`: tasks by priority, below support; `balance`: task of
    centre of mass that leans against contacts, or None; `before`: called with machine and filtered reading before each
    step. Attributes `took`: time of each step in us; `torque`: torque (k,) of the last step in N m.
    """

    def __init__(
        self,
        stance: Stance,
        levels: Sequence[Sequence[Task]],
        balance: CenterOfMass | None,
        skin: BodySkin,
        settings: StandingControl,
        before: Callable[[MujocoDynamics, Reading], None] | None = None,
    ) -> None:
        self.stance = stance
        self.skin = skin
        self.settings = settings
        self.stack = TaskStack(levels, stance.support())
        self.before = before
        self.active: list[int] = []
        self.took: list[float] = []
        self.torque: NDArray[np.float64] = np.zeros(0)
        self.after: Callable[[NDArray[np.float64], float], NDArray[np.float64]] | None = None
        self._force: NDArray[np.float64] | None = None
        self._warmth: NDArray[np.float64] | None = None
        self._balance = balance
        self._upright = np.zeros(3) if balance is None else balance.target.copy()
        self._middle = self._upright * [1.0, 1.0, 0.0]
        self._shift = np.zeros(2)
        self._weight = GRAVITY * float(stance.model.body_subtreemass[0])

    def step(self, robot: Any, reading: Reading) -> NDArray[np.float64]:
        began = perf_counter()
        self.stance.locate(robot)
        external = None
        measured: Reading | None = None
        if self.settings.skin:
            measured = self._filtered(reading)
            external, moment = self._external(robot, measured)
            if self._balance is not None:
                self._lean(self._balance, moment)
        if self.before is not None:
            self.before(robot, measured if measured is not None else reading)
        self.torque = self.stack.step(robot, measured, external).torque
        if self.after is not None:
            self.torque = self.after(self.torque, robot.time)
        self.took.append(1e6 * (perf_counter() - began))
        return self.torque

    def _filtered(self, reading: Reading) -> Reading:
        # The reading with low-passed forces, against beating.
        force = reading.force
        if np.isnan(force.sum()):
            force = np.nan_to_num(force)
        share = self.settings.period / (self.settings.period + self.settings.filter)
        self._force = force.copy() if self._force is None else self._force + share * (force - self._force)
        warmth = reading.temperature
        if warmth is not None:
            slow = self.settings.period / (self.settings.period + _WARMING)
            self._warmth = warmth.copy() if self._warmth is None else self._warmth + slow * (warmth - self._warmth)
        return Reading(reading.time, self._force, reading.distance, self._warmth)

    def _external(
        self, robot: MujocoDynamics, measured: Reading
    ) -> tuple[NDArray[np.float64] | None, NDArray[np.float64]]:
        # Generalized force (n,) on the skin, or None; moments (2,) at the feet.
        wrenches = link_wrenches(self.skin, measured.force, measured.force >= self.skin.thresholds)
        self.active.append(len(wrenches))
        if not wrenches:
            return None, np.zeros(2)
        total = np.zeros(len(robot.velocity))
        mx = 0.0
        my = 0.0
        for link, wrench, _taxels in wrenches:
            origin, rotation = robot.pose(link)
            turned = (wrench.reshape(2, 3) @ rotation.T).ravel()
            total += turned @ robot.jacobian(link)
            fx, fy, fz, tx, ty, _tz = turned.tolist()
            x, y, z = (origin - self._middle).tolist()
            mx += y * fz - z * fy + tx
            my += z * fx - x * fz + ty
        return total, np.array([mx, my])

    def _lean(self, balance: CenterOfMass, moment: NDArray[np.float64]) -> None:
        # Shift the centre of mass against moments (2,) at the feet (K 9 corrected).
        s = self.settings
        wanted = s.lean / self._weight * np.array([-moment[1], moment[0]])
        wanted *= min(1.0, s.lean_limit / max(float(np.hypot(*wanted)), 1e-9))
        self._shift += s.period / (s.period + s.lean_filter) * (wanted - self._shift)
        balance.target[:2] = self._upright[:2] + self._shift
