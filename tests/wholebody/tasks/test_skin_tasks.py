"""Tasks that react to the skin: what they ask for, taxel by taxel, and what they leave uncomputed."""

import numpy as np
import pytest

from plantar.sensing.link_skin import BodySkin, SkinPatch
from plantar.sensing.reading import Reading
from plantar.wholebody.stack import TaskStack
from plantar.wholebody.tasks.skin_interaction import (
    DirectInteraction,
    PressureInteraction,
    ProximityInteraction,
    TemperatureInteraction,
)

SIZE = 5


class CountingRobot:
    """Two links with Jacobians of their own; counts what is asked for."""

    def __init__(self):
        rng = np.random.default_rng(0)
        self.asked = 0
        self.mass_matrix = np.eye(SIZE)
        self.bias = np.zeros(SIZE)
        self.velocity = np.zeros(SIZE)
        self.joints = np.arange(SIZE)
        self._rows = {link: rng.normal(size=(6, SIZE)) for link in ("arm", "hand")}
        self._turns = {link: np.linalg.qr(rng.normal(size=(3, 3)))[0] for link in ("arm", "hand")}

    def pose(self, link):
        return np.zeros(3), self._turns[link]

    def jacobian(self, link, point=None):
        self.asked += 1
        return self._rows[link]


@pytest.fixture
def skin():
    rng = np.random.default_rng(1)

    def patch(name, count):
        rotations = np.linalg.qr(rng.normal(size=(count, 3, 3)))[0]
        areas = rng.uniform(1e-4, 9e-4, count)
        return SkinPatch(name, name, rng.normal(size=(count, 3)), rotations, areas, 0.2, 0.05)

    return BodySkin([patch("arm", 4), patch("hand", 3)])


def reading(force=None, distance=None, temperature=None):
    force = np.zeros(7) if force is None else np.asarray(force, dtype=float)
    distance = np.full(7, np.inf) if distance is None else np.asarray(distance, dtype=float)
    return Reading(0.0, force, distance, temperature)


def torque_of(demand):
    return demand.jacobian.T @ demand.force


def expected_torque(robot, skin, signal):
    """J^T f of each taxel by itself (T 3.16, 3.20)."""
    total = np.zeros(SIZE)
    for i in np.flatnonzero(signal):
        link = skin.links[skin.link_of[i]]
        turn, rows = robot.pose(link)[1], robot.jacobian(link)
        push = turn @ (signal[i] * skin.normals[i])
        total += rows[:3].T @ push + rows[3:].T @ np.cross(turn @ skin.positions[i], push)
    return total


def test_contact_forces_act_as_they_would_on_a_free_robot(skin):
    robot, force = CountingRobot(), np.array([0.0, 3.0, 0.1, 1.0, 0.0, 0.5, 2.0])
    demand = DirectInteraction(skin, 1.5).demand(robot, reading(force))
    assert np.allclose(torque_of(demand), expected_torque(robot, skin, np.where(force >= 0.2, 1.5 * force, 0.0)))


def test_pressure_counts_by_the_area_of_each_link(skin):
    robot, force = CountingRobot(), np.array([0.0, 3.0, 0.0, 1.0, 0.0, 0.5, 2.0])
    demand = PressureInteraction(skin, 7e-4).demand(robot, reading(force))
    signal = np.zeros(7)
    for link in range(2):
        own = (skin.link_of == link) & (force > 0.0)
        signal[own] = 7e-4 / skin.areas[own].sum() * force[own]
    assert np.allclose(torque_of(demand), expected_torque(robot, skin, signal))


def test_what_is_near_repels_by_how_far_it_is_inside_the_range(skin):
    robot, distance = CountingRobot(), np.array([0.01, 0.049, 0.06, np.inf, -0.002, np.nan, 0.03])
    task = ProximityInteraction(skin, 40.0)
    signal = 40.0 * np.array([0.04, 0.001, 0.0, 0.0, 0.05, 0.0, 0.02])
    assert np.allclose(torque_of(task.demand(robot, reading(distance=distance))), expected_torque(robot, skin, signal))
    task.sensing_range = 0.02
    signal = 40.0 * np.array([0.01, 0.0, 0.0, 0.0, 0.02, 0.0, 0.0])
    assert np.allclose(torque_of(task.demand(robot, reading(distance=distance))), expected_torque(robot, skin, signal))


def test_heat_repels_from_its_threshold_on(skin):
    robot, heat = CountingRobot(), np.array([20.0, 31.0, 35.0, np.nan, 50.0, 30.9, 25.0])
    demand = TemperatureInteraction(skin, 2.0).demand(robot, reading(temperature=heat))
    assert np.allclose(torque_of(demand), expected_torque(robot, skin, np.array([0, 0, 8.0, 0, 38.0, 0, 0])))
    assert TemperatureInteraction(skin, 2.0).demand(robot, reading()) is None


def test_only_the_patches_that_count_are_heard(skin):
    robot, force = CountingRobot(), np.ones(7)
    demand = DirectInteraction(skin, patches=["hand"]).demand(robot, reading(force))
    assert np.allclose(torque_of(demand), expected_torque(robot, skin, np.where(skin.link_of == 1, 1.0, 0.0)))


def test_a_silent_skin_asks_for_no_jacobian(skin):
    robot = CountingRobot()
    tasks = [DirectInteraction(skin), PressureInteraction(skin, 1e-3), ProximityInteraction(skin, 1.0)]
    stack = TaskStack([[task] for task in tasks])
    fused = stack.step(robot, reading(np.full(7, 0.19)))
    assert robot.asked == 0
    assert stack.silent == 3
    assert not fused.torque.any()
    DirectInteraction(skin).demand(robot, reading([0, 0, 0, 0, 1.0, 0, 0]))
    assert robot.asked == 1


def test_taxels_that_deliver_nothing_are_silent(skin):
    dead = np.full(7, np.nan)
    for task in (DirectInteraction(skin), ProximityInteraction(skin, 1.0), TemperatureInteraction(skin, 1.0)):
        assert task.demand(CountingRobot(), reading(dead, dead, dead)) is None
    assert DirectInteraction(skin).demand(CountingRobot(), None) is None
