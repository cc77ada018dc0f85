"""Newton steps on MuJoCo's Jacobians against mink (the field's library), and torques against inverse dynamics."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from plantar.layout import Side
from sim.inverse_kinematics import LegModel
from sim.robots import Robot
from sim.world import build_leg_model, robot_spec

STANCE: dict[Side, NDArray[np.float64]] = {"left": np.array([0.0, 0.085, 0.0]), "right": np.array([0.1, -0.085, 0.0])}
LEVEL: dict[Side, NDArray[np.float64]] = {"left": np.eye(3), "right": np.eye(3)}


@pytest.fixture
def legs(h1: Robot) -> LegModel:
    model = build_leg_model(h1)
    model.set_configuration(
        np.array([0.0, 0.0, 0.84]),
        np.array([1.0, 0.0, 0.0, 0.0]),
        np.array([*h1.posture["left"], *h1.posture["right"]]),
    )
    return model


def random_targets(
    seed: int,
) -> tuple[NDArray[np.float64], NDArray[np.float64], dict[Side, NDArray], dict[Side, NDArray]]:
    rng = np.random.default_rng(seed)
    com = np.array([0.05, 0.0, 0.79]) + rng.uniform(-0.02, 0.02, 3)
    torso = Rotation.from_rotvec(rng.uniform(-0.05, 0.05, 3)).as_matrix()
    positions: dict[Side, NDArray[np.float64]] = {s: p + rng.uniform(-0.02, 0.02, 3) for s, p in STANCE.items()}
    rotations: dict[Side, NDArray[np.float64]] = {
        s: np.asarray(Rotation.from_rotvec(rng.uniform(-0.1, 0.1, 3)).as_matrix()) for s in STANCE
    }
    return com, np.asarray(torso), positions, rotations


@pytest.mark.parametrize("seed", range(6))
def test_converges_to_every_target(legs: LegModel, seed: int) -> None:
    com, torso, positions, rotations = random_targets(seed)
    joints, error = legs.solve(com, torso, positions, rotations, iterations=12)
    assert error < 1e-9
    data = mujoco.MjData(legs.model)
    data.qpos[:] = legs.configuration
    mujoco.mj_kinematics(legs.model, data)
    mujoco.mj_comPos(legs.model, data)
    assert data.subtree_com[0] == pytest.approx(com, abs=1e-8)
    for side in STANCE:
        assert data.site(f"{side}_sole").xpos == pytest.approx(positions[side], abs=1e-8)
        assert data.site(f"{side}_sole").xmat.reshape(3, 3) == pytest.approx(rotations[side], abs=1e-8)
    assert data.body("base").xmat.reshape(3, 3) == pytest.approx(torso, abs=1e-8)
    posture = legs.posture(joints)
    base_to_world, base = data.body("base").xmat.reshape(3, 3), data.body("base").xpos
    assert base + base_to_world @ posture.com == pytest.approx(com, abs=1e-8)


def test_agrees_with_mink(h1: Robot, legs: LegModel) -> None:
    mink = pytest.importorskip("mink")
    model = robot_spec(h1).compile()
    com, torso, positions, rotations = random_targets(1)
    joints, _ = legs.solve(com, torso, positions, rotations, iterations=12)

    configuration = mink.Configuration(model)
    start = configuration.data.qpos.copy()
    start[:7] = [0, 0, 0.84, 1, 0, 0, 0]
    start[7:] = [*h1.posture["left"], *h1.posture["right"]]
    configuration.update(start)
    center = mink.ComTask(cost=1.0)
    center.set_target(com)
    upright = mink.FrameTask("base", "body", position_cost=0.0, orientation_cost=1.0)
    upright.set_target(mink.SE3.from_rotation(mink.SO3.from_matrix(torso)))
    tasks = [center, upright]
    for side in STANCE:
        task = mink.FrameTask(f"{side}_sole", "site", position_cost=1.0, orientation_cost=1.0)
        task.set_target(mink.SE3.from_rotation_and_translation(mink.SO3.from_matrix(rotations[side]), positions[side]))
        tasks.append(task)
    for _ in range(60):
        velocity = mink.solve_ik(configuration, tasks, 1.0, "daqp", damping=1e-12)
        configuration.integrate_inplace(velocity, 1.0)
    assert configuration.data.qpos[7:] == pytest.approx(joints, abs=1e-6)


def test_joint_limits_hold_and_unreachable_targets_stay_finite(legs: LegModel) -> None:
    joints, error = legs.solve(np.array([0.05, 0.0, 1.5]), np.eye(3), STANCE, LEVEL, iterations=50)
    assert np.isfinite(joints).all()
    assert error > 0.1
    assert joints[3] >= 0.0  # the knee does not bend backward
    assert joints[9] >= 0.0


def test_torques_balance_gravity_and_ground_forces(legs: LegModel) -> None:
    legs.solve(np.array([0.05, 0.0, 0.79]), np.eye(3), STANCE, LEVEL, iterations=12)
    weight = legs.mass * 9.81
    forces: dict[Side, NDArray[np.float64]] = {
        "left": np.array([10.0, -5.0, 0.3 * weight]),
        "right": np.array([-10.0, 5.0, 0.7 * weight]),
    }
    points: dict[Side, NDArray[np.float64]] = {
        "left": np.array([0.03, 0.09, 0.0]),
        "right": np.array([0.08, -0.1, 0.0]),
    }
    torques = legs.static_torques(forces, points)
    # Independent: MuJoCo's inverse dynamics at rest with the same forces applied to the feet.
    model = legs.model
    data = mujoco.MjData(model)
    data.qpos[:] = legs.configuration
    mujoco.mj_forward(model, data)
    applied = np.zeros(model.nv)
    for side, force in forces.items():
        mujoco.mj_applyFT(model, data, force, np.zeros(3), points[side], model.body(f"{side}_foot").id, applied)
    data.qacc[:] = 0.0
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    mujoco.mj_inverse(model, data)
    assert torques == pytest.approx((data.qfrc_inverse - applied)[6:], abs=1e-9)
