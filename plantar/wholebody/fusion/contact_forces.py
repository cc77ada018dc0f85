"""Contact forces of standing: pressing, within the contact, without slip (T 4.4.4)."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from plantar.errors import InputError
from plantar.mechanics.contact import Contact
from plantar.mechanics.wrench_distribution import DistributionWeights, WrenchDistribution, WrenchShare
from plantar.wholebody.dynamics import RobotDynamics
from plantar.wholebody.tasks.support import Support
from plantar.wholebody.tasks.task import Demand

_LEAST = 0.01  # least normal force of a contact, as a share of the weight


class ContactForces:
    """Shares a free base's load among contacts, as `joint_torques`, within friction cones.

    `base`: link of the free coordinates; `weight`: robot's in N. Attributes `shares`: desired load shares by contact
    name; None for equal; `last`: last wrench of each contact, own frame.
    """

    def __init__(self, support: Support, base: str, weight: float, weights: DistributionWeights | None = None) -> None:
        self.shares: Mapping[str, float] | None = None
        self.last: WrenchShare | None = None
        self._support = support
        self._base = base
        self._free: NDArray[np.int64] | None = None  # coordinates that no joint drives
        self._distribution = WrenchDistribution(weight, weights, minimum_force=_LEAST * weight)

    def __call__(
        self, robot: RobotDynamics, force: NDArray[np.float64], support: Demand | None
    ) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
        """Share a generalized force (`plantar.wholebody.fusion.hierarchy.joint_torques`).

        Returns joint torques (k,) and forces (s,) along the support's rows; InputError without support.
        """
        if support is None:
            raise InputError("contact forces need a support")
        contacts = self._contacts(robot)
        wrenches = self._shared(robot, force, contacts).wrenches
        parts = []
        for name, contact in contacts.items():
            turned = np.concatenate([contact.rotation @ wrenches[name][:3], contact.rotation @ wrenches[name][3:]])
            parts.append(turned[: self._support.contacts[name].rows])
        carried = np.concatenate(parts)
        return force[robot.joints] - support.jacobian[:, robot.joints].T @ carried, carried

    def share(self, robot: RobotDynamics, force: NDArray[np.float64]) -> WrenchShare:
        """Returns each contact's wrench, own frame, under a generalized `force` (n,) on the base of a `robot`."""
        return self._shared(robot, force, self._contacts(robot))

    def _shared(self, robot: RobotDynamics, force: NDArray[np.float64], contacts: Mapping[str, Contact]) -> WrenchShare:
        if self._free is None:
            self._free = np.setdiff1d(np.arange(len(force)), robot.joints)
        net = np.asarray(np.linalg.solve(robot.jacobian(self._base)[:, self._free].T, force[self._free]))
        self.last = self._distribution.solve(contacts, net, robot.pose(self._base)[0], self.shares)
        return self.last

    def _contacts(self, robot: RobotDynamics) -> dict[str, Contact]:
        contacts = {}
        for name, standing in self._support.contacts.items():
            origin, rotation = robot.pose(standing.link)
            turn = rotation if standing.rotation is None else rotation @ standing.rotation
            contacts[name] = Contact(origin + rotation @ standing.point, turn, standing.area, standing.friction)
        return contacts
