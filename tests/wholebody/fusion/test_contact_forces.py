"""Contacts of a standing robot take what acts on its base, inside their cones."""

import numpy as np
import pytest

from plantar.errors import InputError
from plantar.mechanics.wrench_cone import Rectangle, wrench_cone
from plantar.wholebody.fusion.contact_forces import ContactForces
from plantar.wholebody.fusion.hierarchy import joint_torques
from plantar.wholebody.tasks.support import Standing, Support

SOLE = Rectangle(-0.1, 0.15, -0.06, 0.06)
WEIGHT = 800.0
PLACES = {
    "left": np.array([0.0, 0.1, 0.0]),
    "right": np.array([0.0, -0.1, 0.0]),
    "forearm": np.array([0.45, -0.2, 0.9]),
    "base": np.array([0.0, 0.0, 0.8]),
}


class Statue:
    """A free base that carries three links by 12 joints; rigid, so that Jacobians follow from places."""

    def __init__(self):
        self.joints = np.arange(6, 18)
        self._rows = np.random.default_rng(0).normal(size=(3, 6, 12))

    def pose(self, link):
        return PLACES[link], np.eye(3)

    def jacobian(self, link, point=None):
        place = PLACES[link] + (0.0 if point is None else point)
        x, y, z = place - PLACES["base"]
        rigid = np.eye(6)
        rigid[:3, 3:] = [[0, z, -y], [-z, 0, x], [y, -x, 0]]
        names = list(PLACES)
        own = np.zeros((6, 12)) if link == "base" else self._rows[names.index(link)]
        return np.hstack([rigid, own])

    def drift(self, link, point=None):
        return np.zeros(6)


def weight_at(x, y):
    """Generalized force that holds the weight of a robot whose centre of mass is over (x, y)."""
    force = np.zeros(18)
    force[2], force[3], force[4] = WEIGHT, WEIGHT * y, -WEIGHT * x
    return force


@pytest.fixture
def support():
    contacts = {side: Standing(side, np.zeros(3), area=SOLE) for side in ("left", "right")}
    return Support(contacts | {"forearm": Standing("forearm", np.zeros(3), flat=False)})


def wrenches(support, carried):
    """Wrench (6,) of each contact in the world."""
    found, at = {}, 0
    for name, contact in support.contacts.items():
        found[name] = np.concatenate([carried[at : at + contact.rows], np.zeros(6 - contact.rows)])
        at += contact.rows
    return found


@pytest.mark.parametrize(("x", "y"), [(0.02, 0.0), (0.05, -0.03), (0.19, -0.02)])
def test_they_hold_the_base_inside_their_cones(support, x, y):
    robot = Statue()
    demand = support.demand(robot, None)
    forces = ContactForces(support, "base", WEIGHT)
    torque, carried = forces(robot, weight_at(x, y), demand)
    assert np.allclose(demand.jacobian[:, :6].T @ carried, weight_at(x, y)[:6], atol=0.02)
    assert np.allclose(torque, -demand.jacobian[:, 6:].T @ carried)
    cone = wrench_cone(SOLE, 0.6)
    found = wrenches(support, carried)
    for side in ("left", "right"):
        assert (cone @ found[side] <= 1e-6 * WEIGHT).all()
    assert found["forearm"][2] > 0.0
    # Beyond the toes only the forearm holds: its share follows from moments about the foremost edge.
    if x > SOLE.x_max:
        assert found["forearm"][2] > WEIGHT * (x - SOLE.x_max) / (PLACES["forearm"][0] - SOLE.x_max)


def test_the_least_force_would_tip_a_sole(support):
    """Why there are cones: without them a sole carries outside itself."""
    robot, cone = Statue(), wrench_cone(SOLE, 0.6)
    demand = support.demand(robot, None)
    wanted = weight_at(0.0, 0.14)
    _, least = joint_torques(robot, wanted, demand)
    _, coned = ContactForces(support, "base", WEIGHT)(robot, wanted, demand)
    worst = [max((cone @ wrenches(support, f)[s]).max() for s in ("left", "right")) for f in (least, coned)]
    assert worst[0] > 0.01 * WEIGHT
    assert worst[1] <= 1e-6 * WEIGHT


def test_a_robot_needs_a_support(support):
    with pytest.raises(InputError, match="need a support"):
        ContactForces(support, "base", WEIGHT)(Statue(), weight_at(0.0, 0.0), None)
