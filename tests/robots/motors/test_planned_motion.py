"""Torques of a command's motion: what MuJoCo's inverse dynamics asks of the legs, and of the ground."""

from typing import Any

import mujoco
import numpy as np
import pytest

from plantar.common.sides import SIDES
from plantar.robots import load_robot
from plantar.robots.kinematics.body import body_of
from plantar.robots.kinematics.robot_model import build_leg_model
from plantar.robots.motors.planned_motion import PlannedMotion

PERIOD = 0.005


@pytest.fixture(scope="module", params=["h1", "hrp2kai"])
def legs(request):
    robot = load_robot(request.param)
    return robot, build_leg_model(robot)


def moved(robot, legs, seed: int) -> tuple[Any, np.ndarray, np.ndarray]:
    """A random motion of a robot: configuration, velocity and acceleration."""
    rng = np.random.default_rng(seed)
    posture = np.array([*robot.posture["left"], *robot.posture["right"]])
    legs.set_configuration(rng.normal(size=3), np.array([1.0, 0.0, 0.0, 0.0]), posture + 0.2 * rng.normal(size=12))
    quaternion = legs.configuration[3:7] + 0.3 * rng.normal(size=4)
    configuration = legs.configuration
    legs.set_configuration(configuration[:3], quaternion / np.linalg.norm(quaternion), configuration[7:])
    velocity, acceleration = rng.normal(size=(2, legs.model.nv))
    data = mujoco.MjData(legs.model)
    data.qpos[:], data.qvel[:], data.qacc[:] = legs.configuration, velocity, acceleration
    return data, velocity, acceleration


@pytest.mark.parametrize(("seed", "left"), [(0, 1.0), (1, 0.0), (2, 0.3)])
def test_torques_and_the_grounds_wrench_hold_the_equation_of_motion(legs, seed, left):
    """Where forces bear weight and the CoM's acceleration at places that turn the body by nothing, all rows balance."""
    robot, model = legs
    data, velocity, acceleration = moved(robot, model, seed)
    m = model.model
    m.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
    m.dof_damping[:] = 0.0
    mujoco.mj_inverse(m, data)
    wanted = data.qfrc_inverse.copy()
    mujoco.mj_comPos(m, data)
    com, shares = data.subtree_com[1].copy(), {"left": left, "right": 1.0 - left}
    force = wanted[:3]  # of the ground: the base's rows are what nothing but it exerts
    # Through the CoM, such forces turn the body by nothing; the couple is left to the motion.
    model.carry({s: shares[s] * force for s in SIDES}, dict.fromkeys(SIDES, com))
    model.add_motion(velocity[model.rows], acceleration[model.rows], shares["left"])
    jacobians = {s: np.zeros((6, m.nv)) for s in SIDES}
    for side, jacobian in jacobians.items():
        body = int(m.site_bodyid[m.site(robot.legs[side].sole_site).id])
        mujoco.mj_jac(m, data, jacobian[:3], jacobian[3:], com, body)
    turned = wanted.copy()
    couple = data.xmat[1].reshape(3, 3) @ wanted[3:6] - np.cross(com - data.qpos[:3], force)
    for side, jacobian in jacobians.items():
        turned -= shares[side] * np.concatenate([force, couple]) @ jacobian
    assert turned[:6] == pytest.approx(np.zeros(6), abs=1e-8)
    assert model.torques == pytest.approx(turned[model.rows[6:]], abs=1e-8 * np.abs(turned).max())
    if left == 1.0:  # a leg that a stiff servo swings gets nothing; the one that carries gets the same
        full = model.torques.copy()
        model.carry({s: shares[s] * force for s in SIDES}, dict.fromkeys(SIDES, com))
        still = model.torques.copy()
        model.add_motion(velocity[model.rows], acceleration[model.rows], shares["left"], whole=False)
        assert model.torques[:6] == pytest.approx(full[:6])
        assert model.torques[6:].tolist() == still[6:].tolist()


def test_rates_are_those_of_a_steady_motion(legs):
    robot, model = legs
    motion = PlannedMotion(model, PERIOD, body_of(robot, model.model).beat)
    posture, rate = np.array([*robot.posture["left"], *robot.posture["right"]]), np.linspace(-1.0, 1.0, 12)
    for k in range(60):
        model.set_configuration(
            np.array([0.0, 0.0, 0.5 * (k * PERIOD) ** 2]), np.array([1.0, 0, 0, 0]), posture + k * PERIOD * rate
        )
        motion.update()
    assert motion.velocity[6:] == pytest.approx(rate, abs=1e-9)
    assert motion.acceleration[2] == pytest.approx(1.0, rel=1e-3)
