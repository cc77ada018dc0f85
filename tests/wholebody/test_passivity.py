"""Compliance gives no energy away: what is led along a closed path never gets back more than it put in."""

import mujoco
import numpy as np
import pytest

from plantar.sensing.link_skin import BodySkin, SkinPatch
from plantar.sensing.reading import Reading
from plantar.wholebody.stack import TaskStack
from plantar.wholebody.tasks.base_avoidance import BaseAvoidance
from plantar.wholebody.tasks.posture import BodyCompliance, Posture
from plantar.wholebody.tasks.self_collision import SelfCollision, Sphere
from plantar.wholebody.tasks.skin_interaction import DirectInteraction, PressureInteraction, ProximityInteraction

STEP = 1e-3
HAND = "link5"


@pytest.fixture
def skin():
    """Six taxels that look along the axes of the hand, so that any force on it can be felt."""
    axes = np.vstack([np.eye(3), -np.eye(3)])
    rotations = np.array([np.column_stack([np.roll(z, 1), np.cross(z, np.roll(z, 1)), z]) for z in axes])
    return BodySkin([SkinPatch("hand", HAND, -0.04 * axes, rotations, np.full(6, 7e-4), force_threshold=0.0)])


def led_around(robot, stack, skin, loops):
    """Energy in J that a hand puts into a robot that it leads by a spring along closed paths, at its least and last."""
    model = robot.model
    data = mujoco.MjData(model)
    data.qpos[:] = 0.3
    robot.update(data.qpos, data.qvel, 0.0)
    start = robot.pose(HAND)[0]
    energies = [0.0]
    for k in range(int(2.5 / STEP)):
        robot.update(data.qpos, data.qvel, k * STEP)
        share = min(1.0, k * STEP / 2.0)
        held = start + 0.1 * np.array([np.sin(a := 2.0 * np.pi * loops * share), 1.0 - np.cos(a), np.sin(2.0 * a)])
        place, rotation = robot.pose(HAND)
        rows = robot.jacobian(HAND)[:3]
        wanted = rotation.T @ (200.0 * (held - place) - 2.0 * rows @ robot.velocity)
        normal = np.maximum(np.hstack([wanted, -wanted]), 0.0)  # each taxel takes what pushes along its z
        pushed = rows.T @ (rotation @ (normal @ skin.normals))
        torque = stack.step(robot, Reading(k * STEP, normal, np.full(6, np.inf))).torque
        data.qfrc_applied[:] = torque + pushed
        mujoco.mj_step(model, data)
        energies.append(energies[-1] + STEP * pushed @ (robot.velocity + data.qvel) / 2.0)
    return min(energies), energies[-1]


@pytest.mark.parametrize("kind", ["direct", "pressure", "compliance"])
def test_a_robot_that_is_led_along_a_closed_path_takes_energy_in(random_chain, skin, kind):
    """Seen from the hand the robot is one with its mass divided by 1 + gain, and with the same springs and dampers."""
    robot = random_chain(np.random.default_rng(4), 7)
    robot.model.opt.timestep = STEP
    posture = Posture(np.full(7, 0.3), stiffness=20.0, damping=1.0, torques=True)
    direct = DirectInteraction(skin, 2.0)
    levels = {
        "direct": [[direct, posture]],
        "pressure": [[PressureInteraction(skin, 7e-4), posture]],
        "compliance": [[BodyCompliance(posture, direct)]],
    }[kind]
    least, last = led_around(robot, TaskStack(levels), skin, loops=2)
    assert least > -1e-3
    assert last > 0.02


def work_around(robot, task, read, rng, size):
    """Work in J that a task does along a closed path of the joints, and the sum of what it did and took on it."""
    nv = robot.model.nv
    phases, steps = rng.uniform(0.0, 2.0 * np.pi, (2, nv)), 4000
    positions = [
        size * (np.sin(t + phases[0]) + 0.5 * np.sin(2.0 * t + phases[1]))
        for t in 2.0 * np.pi * np.arange(steps) / steps
    ]
    work = []
    for i, position in enumerate(positions):
        robot.update(position, np.zeros(nv), 0.0)
        demand = task.demand(robot, read(robot))
        moved = (positions[(i + 1) % steps] - positions[i - 1]) / 2.0
        work.append(0.0 if demand is None else demand.force @ demand.jacobian @ moved)
    return sum(work), sum(np.abs(work))


def test_fields_that_keep_away_do_no_work_around_a_closed_path(random_chain):
    robot = random_chain(np.random.default_rng(5), 6)
    rng = np.random.default_rng(6)
    apart = SelfCollision([(Sphere("link5", np.zeros(3), 0.05), Sphere("link0", np.zeros(3), 0.05))], 5.0, 50.0)
    posture = Posture(np.zeros(6), stiffness=np.arange(1.0, 7.0), torques=True)
    for task in (apart, posture):
        work, turnover = work_around(robot, task, lambda r: None, rng, 0.4)
        assert turnover > 0.1
        assert abs(work) < 1e-5 * turnover


SLIDING = """<mujoco><worldbody><body name="base">
  <joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 1 0"/><joint type="slide" axis="0 0 1"/>
  <geom size="0.05"/>{turn}</body></worldbody></mujoco>"""


def test_a_base_is_driven_away_from_an_obstacle_without_gain():
    from plantar.sim.companion.dynamics import MujocoDynamics

    turning = SLIDING.format(turn='<joint type="hinge" axis="0 0 1"/>')
    robot = MujocoDynamics(mujoco.MjModel.from_xml_string(turning))
    task = BaseAvoidance("base", (0.2, 0.1))

    def read(robot):
        origin, rotation = robot.pose("base")
        task.obstacles = ((np.array([[1.0, 0.3, 0.0], [-0.9, -0.4, 0.0]]) - origin) @ rotation)[:, :2]

    work, turnover = work_around(robot, task, read, np.random.default_rng(2), 0.3)
    assert turnover > 1.0
    assert abs(work) < 1e-4 * turnover


def test_a_wall_that_is_seen_square_on_gives_back_what_it_took():
    """What is seen at a slant is pushed along the taxel's axis, not the wall's: T 3.30 is no potential there."""
    from plantar.sim.companion.dynamics import MujocoDynamics

    robot = MujocoDynamics(mujoco.MjModel.from_xml_string(SLIDING.format(turn="")))
    works = []
    for slant in (0.0, 0.5):
        z = np.array([np.cos(slant), np.sin(slant), 0.0])
        turn = np.column_stack([[0.0, 0.0, 1.0], np.cross(z, [0.0, 0.0, 1.0]), z])
        skin = BodySkin([SkinPatch("p", "base", np.zeros((1, 3)), turn[None], np.ones(1), proximity_range=9.0)])

        def read(robot, slant=slant):  # a wall at x = -2 m, seen along -z
            return Reading(0.0, np.zeros(1), np.array([(robot.pose("base")[0][0] + 2.0) / np.cos(slant)]))

        works.append(work_around(robot, ProximityInteraction(skin, 10.0), read, np.random.default_rng(3), 0.5))
    (square, turnover), (slanted, _) = works
    assert abs(square) < 1e-6 * turnover
    assert abs(slanted) > 0.01 * turnover
