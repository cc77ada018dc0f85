import mujoco
import numpy as np
import pytest

from plantar.common.sides import SIDES
from plantar.robots.kinematics.leg_model import LegModel
from plantar.robots.kinematics.robot_model import build_leg_model
from plantar.robots.motors.body_dynamics import BodyDynamics
from plantar.robots.robot import Robot
from plantar.robots.robot_file import load_robot


@pytest.fixture(params=["h1", "hrp2kai"])
def robot(request):
    return load_robot(request.param)


def dynamics_of(robot: Robot, legs: LegModel) -> BodyDynamics:
    model = legs.model
    dofs = np.array([model.joint(n).dofadr[0] for s in SIDES for n in robot.legs[s].joints])
    return BodyDynamics(model, dofs, {s: model.site(robot.legs[s].sole_site).id for s in SIDES})


def random_state(model: mujoco.MjModel, seed: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    configuration = np.concatenate([rng.normal(size=7), rng.uniform(*model.jnt_range[1:].T)])
    configuration[3:7] /= np.linalg.norm(configuration[3:7])
    return configuration, rng.normal(size=model.nv)


def test_forces_are_those_of_mujocos_inverse_dynamics(robot):
    legs = build_leg_model(robot)
    model, dynamics = legs.model, dynamics_of(robot, legs)
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT)
    data = mujoco.MjData(model)
    for seed in range(20):
        rng = np.random.default_rng(seed + 100)
        configuration, velocity = random_state(model, seed)
        acceleration = rng.normal(size=model.nv) * 20.0
        wrenches = {s: rng.normal(size=6) * 200.0 for s in SIDES}
        dynamics.place(configuration)
        dynamics.move(velocity[dynamics.rows])
        data.qpos, data.qvel, data.qacc = configuration, velocity, acceleration
        mujoco.mj_inverse(model, data)
        expected = data.qfrc_inverse.copy()
        for side, wrench in wrenches.items():
            site = model.site(robot.legs[side].sole_site)
            taken = np.zeros(model.nv)
            point, body = data.site_xpos[site.id], int(site.bodyid[0])
            mujoco.mj_applyFT(model, data, wrench[:3], wrench[3:], point, body, taken)
            expected -= taken
        found = (
            dynamics.mass @ acceleration[dynamics.rows]
            + dynamics.bias
            - sum(wrenches[s] @ dynamics.soles[s] for s in SIDES)
        )
        assert np.abs(found - expected[dynamics.rows]).max() < 1e-9 * max(1.0, np.abs(expected).max())


def test_drifts_are_what_is_left_of_the_soles_acceleration_without_a(robot):
    legs = build_leg_model(robot)
    model, dynamics = legs.model, dynamics_of(robot, legs)
    configuration, velocity = random_state(model, 3)
    dynamics.place(configuration)
    dynamics.move(velocity[dynamics.rows])
    drifts = {s: d.copy() for s, d in dynamics.drifts.items()}
    moved = []
    for step in (-1e-5, 1e-5):
        there = configuration.copy()
        mujoco.mj_integratePos(model, there, velocity, step)
        dynamics.place(there)
        moved.append({s: dynamics.soles[s] @ velocity[dynamics.rows] for s in SIDES})
    for side in SIDES:
        assert drifts[side] == pytest.approx((moved[1][side] - moved[0][side]) / 2e-5, abs=1e-5)
