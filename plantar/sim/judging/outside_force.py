"""Forces on the robot that no actor of the scene applies.

Pushes, hands, partners and skins act by `xfrc_applied`, too: each of them adds up what it applies, and what MuJoCo
holds besides comes from elsewhere. So does a spring on the base, which no robot has.
"""

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from plantar.kernels.judging.applied_forces import AppliedForces
from plantar.sim.judging.unmet import unmet

_ROUNDING = 1e-9  # N or N m: actors that share a body are added in another order


class Actor(Protocol):
    """Somebody who pushes in a scene."""

    def add_applied(self, forces: NDArray[np.float64]) -> None:
        """Add to `forces` (bodies, 6) what it applies in the present physics step, as MuJoCo's `xfrc_applied`."""


class OutsideForce:
    """Compares what is applied with what the scene's `actors` apply.

    Args:
        model: MuJoCo's.
        data: MuJoCo's; its `xfrc_applied` of all bodies and `qfrc_applied` of the robot are watched.
        base: Id of the robot's base; actors drive their own joints.
        actors: Of the scene.

    Attributes:
        forces: Kernel that compares.
        springs: Force and torque in N and N m of springs on the base.
        largest: Largest force or torque in N or N m of a body or joint that no actor applies.
        where: Body or joint that it acts on, and `since` when in s a first one did.
    """

    def __init__(self, model: Any, data: Any, base: int, actors: Sequence[Actor]) -> None:
        self._model = model
        self._data = data
        self._on_bodies = data.xfrc_applied
        self._on_joints = data.qfrc_applied
        self._own = np.flatnonzero(model.body_rootid[model.dof_bodyid] == base).astype(np.intp)
        first = int(model.body_dofadr[base])
        self.springs = data.qfrc_spring[first : first + int(model.body_dofnum[base])]
        self._base = model.body(base).name
        self._actors = tuple(actors)
        self._known = np.zeros((model.nbody, 6))
        self.forces = AppliedForces(self._on_bodies, self._known, self._on_joints, self._own, self.springs, _ROUNDING)
        self.largest = 0.0
        self.since = 0.0
        self.where = ""

    def step(self) -> None:
        """After each physics step."""
        self.expect()
        if self.forces.unknown():
            self.look()

    def expect(self) -> None:
        """Add up what the actors apply in the present physics step, for `forces`."""
        for actor in self._actors:
            actor.add_applied(self._known)

    def look(self) -> None:
        """Keep what no actor applies, where `forces` found something unknown."""
        forces = np.abs(self._on_bodies - self._known)
        self._known[:] = 0.0
        body = int(forces.max(axis=1).argmax())
        self._found(float(forces[body].max()), self._model.body(body).name)
        torques = np.abs(self._on_joints[self._own])
        axis = int(torques.argmax())
        self._found(float(torques[axis]), self._model.joint(self._model.dof_jntid[self._own[axis]]).name)

    def look_at_springs(self) -> None:
        """Keep what `springs` hold the base with."""
        self._found(float(np.abs(self.springs).max()), self._base)

    def _found(self, size: float, where: str) -> None:
        if size <= _ROUNDING:  # what is no number is found, too
            return
        if self.largest == 0.0:
            self.since = float(self._data.time)
        if not size <= self.largest:
            self.largest = size
            self.where = where

    def reasons(self) -> list[dict[str, Any]]:
        """Failed criteria, as `plantar.sim.judging.unmet`."""
        text = (
            f"{self.where} was pushed from outside by {self.largest:.3g} N or N m, first at {self.since:.2f} s, "
            "which no actor of the scene did"
        )
        return unmet((self.largest == 0.0, "outside_force", self.largest, 0.0, text))
