"""Tasks of a hand that works on surfaces: force or distance, posture with a velocity, a base that keeps clear."""

import numpy as np
import pytest

from plantar.sensing.link_skin import BodySkin, SkinPatch
from plantar.sensing.reading import Reading
from plantar.wholebody.tasks.base_avoidance import AvoidanceField, BaseAvoidance
from plantar.wholebody.tasks.compliant_wrist import CompliantWrist, WristGains
from plantar.wholebody.tasks.contact_force import ContactForce, ContactGains
from plantar.wholebody.tasks.posture import Posture

OUTWARD = np.array([1.0, 0.0, 0.0])


@pytest.fixture
def skin():
    inward = np.array([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])  # z of each taxel along -x of the hand
    places = np.array([[0.1, y, 0.0] for y in (-0.02, 0.0, 0.02, 0.0)])
    return BodySkin([SkinPatch("face", "hand", places, np.tile(inward, (4, 1, 1)), np.full(4, 1e-4), 0.1, 0.1)])


def felt(force=0.0, distance=np.inf, time=0.0):
    return Reading(time, np.full(4, force / 4), np.full(4, distance))


def task(skin, **gains):
    return ContactForce(skin, "face", np.array([0.1, 0.0, 0.0]), OUTWARD, ContactGains(**gains))


def asked(task, robot, reading):
    demand = task.demand(robot, reading)
    np.testing.assert_allclose(demand.jacobian, [[1.0, 0.0, 0.0]], atol=1e-12)
    return float(demand.acceleration[0])


def test_force_that_is_missing_pushes_on_and_too_much_withdraws(robot, skin):
    hand = task(skin, gain=2.0, inertia=4.0)
    hand.weight, hand.target_force = 1.0, 5.0
    assert asked(hand, robot, felt(3.0)) == pytest.approx(2.0 * 2.0 / 4.0)
    assert asked(hand, robot, felt(7.0)) == pytest.approx(-2.0 * 2.0 / 4.0)


def test_weight_of_a_half_counts_force_and_distance_alike(robot, skin):
    hand = task(skin, gain=1.0, inertia=1.0, distance_stiffness=100.0)
    hand.weight, hand.target_force, hand.target_distance = 0.5, 5.0, 0.03
    assert asked(hand, robot, felt(1.0, 0.05)) == pytest.approx(0.5 * 4.0 + 0.5 * 100.0 * 0.02)


def test_nearing_is_as_fast_as_it_may_be_and_no_faster(robot, skin):
    """At the approach speed nothing is asked for, however far the surface is and however stiff a free hand is."""
    for free in (0.0, 500.0):
        hand = task(skin, distance_stiffness=1e4, damping=100.0, free_damping=free, gain=2.5)
        hand.approach_speed = 0.05
        robot.update(np.zeros(3), np.array([0.05, 0.0, 0.0]), 0.0)
        assert asked(hand, robot, felt()) == pytest.approx(0.0, abs=1e-9)
        robot.update(np.zeros(3), np.array([0.06, 0.0, 0.0]), 0.0)
        assert asked(hand, robot, felt()) < 0.0


def test_free_hand_takes_a_misjudged_push_with_its_own_damping(robot, skin):
    robot.update(np.zeros(3), np.array([0.1, 0.0, 0.0]), 0.0)
    hand = task(skin, damping=10.0, free_damping=100.0, inertia=1.0)
    hand.weight = 1.0
    assert asked(hand, robot, felt(0.0)) == pytest.approx(-100.0 * 0.1)
    hand.target_force = 5.0
    assert asked(hand, robot, felt(5.0)) == pytest.approx(-10.0 * 0.1)


def test_noise_of_a_hand_that_touches_nothing_winds_nothing_up(robot, skin):
    hand = task(skin, integral=10.0, gain=1.0, inertia=1.0)
    hand.weight, hand.target_force = 1.0, 5.0
    for k in range(100):
        robot.update(np.zeros(3), np.zeros(3), 0.01 * k)
        asked(hand, robot, felt(0.2, time=0.01 * k))
    robot.update(np.zeros(3), np.zeros(3), 1.0)
    assert asked(hand, robot, felt(5.0, time=1.0)) == pytest.approx(0.0, abs=1e-9)


def test_lasting_error_is_taken_back(robot, skin):
    hand = task(skin, integral=10.0, gain=1.0, inertia=1.0)
    hand.weight, hand.target_force = 1.0, 5.0
    pushes = []
    for k in range(11):
        robot.update(np.zeros(3), np.zeros(3), 0.01 * k)
        pushes.append(asked(hand, robot, felt(4.0, time=0.01 * k)))
    np.testing.assert_allclose(np.diff(pushes), 10.0 * 0.01)


def test_normal_of_a_turning_hand_turns_with_it(robot, skin):
    """The drift is what the outward speed changes by while nothing is accelerated: finite difference."""
    step, speed = 1e-6, np.array([0.3, -0.2, 1.1])
    rates = []
    for k in (-1, 1):
        robot.update(k * step * speed, speed, 0.0)
        rotation, rows = robot.pose("hand")[1], robot.jacobian("hand", np.array([0.1, 0.0, 0.0]))
        rates.append((rotation @ OUTWARD) @ rows[:3] @ speed)
    robot.update(np.zeros(3), speed, 0.0)
    drift = task(skin).demand(robot, felt()).drift[0]
    assert drift == pytest.approx((rates[1] - rates[0]) / (2.0 * step), rel=1e-5)


def test_posture_with_a_velocity_asks_for_nothing_where_it_is_followed(robot):
    posture = Posture(np.zeros(3), 50.0)
    posture.target_velocity = np.array([0.1, 0.2, -0.3])
    robot.update(np.zeros(3), posture.target_velocity, 0.0)
    np.testing.assert_allclose(posture.demand(robot, None).acceleration, 0.0, atol=1e-12)


def test_all_obstacles_together_push_no_more_than_the_field_may(robot):
    keep = BaseAvoidance("hand", (0.3, 0.2), AvoidanceField(force=100.0, decay=10.0, reach=5.0))
    keep.obstacles = np.array([[0.4, 0.0]])
    alone = keep.demand(robot, None).force
    np.testing.assert_allclose(alone, [-100.0 * np.exp(-0.01), 0.0, 0.0], atol=1e-9)
    keep.obstacles = np.array([[0.4, 0.0], [0.4, 0.1], [0.4, -0.1]])
    assert np.linalg.norm(keep.demand(robot, None).force[:2]) == pytest.approx(100.0)


def test_a_wrist_yields_to_a_moment_and_its_own_turn_is_damped(robot, skin):
    """A 10 corrected: pressed at +y of its face, along -x, it is turned by +z; what turns already is braked."""
    wrist = CompliantWrist(skin, "face", np.array([0.1, 0.0, 0.0]), WristGains(inertia=0.5, damping=3.0, gain=2.0))
    wrist.weight = 1.0
    one_side = Reading(0.0, np.array([0.0, 0.0, 4.0, 0.0]), np.full(4, np.inf))
    demand = wrist.demand(robot, one_side)
    moment = np.cross([0.0, 0.02, 0.0], [-4.0, 0.0, 0.0])
    assert wrist.moment == pytest.approx(moment)
    assert demand.acceleration == pytest.approx(2.0 * moment / 0.5)
    robot.update(np.zeros(3), np.array([0.0, 0.0, 0.7]), 0.1)
    turning = wrist.demand(robot, Reading(0.0, np.zeros(4), np.full(4, np.inf)))
    assert turning.acceleration == pytest.approx([0.0, 0.0, -3.0 * 0.7 / 0.5])
