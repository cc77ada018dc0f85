"""A biped's legs against mink (the field's library), swings out of reach, and torques against inverse dynamics."""

import math
from collections.abc import Callable

import mujoco
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from plantar.common.sides import SIDES
from plantar.gait.command import Command, FootTarget
from plantar.layouts.layout import Side
from plantar.robots import load_robot
from plantar.robots.kinematics.leg_model import LegModel
from plantar.robots.kinematics.robot_model import build_leg_model, robot_spec

STANCE: dict[Side, NDArray[np.float64]] = {"left": np.array([0.0, 0.085, 0.0]), "right": np.array([0.1, -0.085, 0.0])}
LEVEL: dict[Side, NDArray[np.float64]] = {"left": np.eye(3), "right": np.eye(3)}


@pytest.fixture
def legs(h1):
    model = build_leg_model(h1)
    model.set_configuration(
        np.array([0.0, 0.0, 0.84]),
        np.array([1.0, 0.0, 0.0, 0.0]),
        np.array([*h1.posture["left"], *h1.posture["right"]]),
    )
    return model


def solved(legs, *targets, **options):
    missed = legs.follow(*targets, **options)
    return legs.joints.copy(), missed


def random_targets(seed):
    rng = np.random.default_rng(seed)
    com = np.array([0.05, 0.0, 0.79]) + rng.uniform(-0.02, 0.02, 3)
    torso = Rotation.from_rotvec(rng.uniform(-0.05, 0.05, 3)).as_matrix()
    positions: dict[Side, NDArray[np.float64]] = {s: p + rng.uniform(-0.02, 0.02, 3) for s, p in STANCE.items()}
    rotations: dict[Side, NDArray[np.float64]] = {
        s: np.asarray(Rotation.from_rotvec(rng.uniform(-0.1, 0.1, 3)).as_matrix()) for s in STANCE
    }
    return com, np.asarray(torso), positions, rotations


@pytest.mark.parametrize("seed", range(6))
def test_converges_to_every_target(legs, seed):
    com, torso, positions, rotations = random_targets(seed)
    joints, error = solved(legs, com, torso, positions, rotations, iterations=12)
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
    for site in ("imu", "left_sole"):  # the latter's by the joints of the last posture
        assert base + base_to_world @ legs.place_of(site) == pytest.approx(data.site(site).xpos, abs=1e-8)


def test_a_live_posture_is_the_same_in_arrays_that_stay(legs):
    rng, joints = np.random.default_rng(7), legs.configuration[7:]
    first = legs.live_posture(joints)
    for _ in range(3):
        bent = joints + 0.1 * rng.normal(size=len(joints))
        posture, live = legs.posture(bent), legs.live_posture(bent)
        assert live is first
        assert not live.com.flags.writeable
        pairs = [(posture.com, live.com)]
        for side in SIDES:
            pairs += [(posture.positions[side], live.positions[side]), (posture.rotations[side], live.rotations[side])]
        legs.posture(joints)
        assert all(not np.array_equal(a, b) for a, b in pairs)  # what was copied has not moved
        legs.live_posture(bent)
        assert all(np.array_equal(a, b) for a, b in pairs)


def test_targets_may_have_any_strides(legs):
    com, torso, positions, rotations = random_targets(0)
    joints, _ = solved(legs, com, torso, positions, rotations, iterations=20)
    legs.follow(com, np.asfortranarray(torso), positions, {s: np.asfortranarray(r) for s, r in rotations.items()})
    assert legs.joints == pytest.approx(joints, abs=1e-9)


def test_agrees_with_mink(h1, legs):
    mink = pytest.importorskip("mink")
    model = robot_spec(h1).compile()
    com, torso, positions, rotations = random_targets(1)
    joints, _ = solved(legs, com, torso, positions, rotations, iterations=12)

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


def test_joint_limits_hold_and_unreachable_targets_stay_finite(legs):
    joints, error = solved(legs, np.array([0.05, 0.0, 1.5]), np.eye(3), STANCE, LEVEL, iterations=50)
    assert np.isfinite(joints).all()
    assert error > 0.1
    assert joints[3] >= 0.0  # the knee does not bend backward
    assert joints[9] >= 0.0


def test_torques_balance_gravity_and_ground_forces(legs):
    solved(legs, np.array([0.05, 0.0, 0.79]), np.eye(3), STANCE, LEVEL, iterations=12)
    weight = legs.mass * 9.81
    forces: dict[Side, NDArray[np.float64]] = {
        "left": np.array([10.0, -5.0, 0.3 * weight]),
        "right": np.array([-10.0, 5.0, 0.7 * weight]),
    }
    points: dict[Side, NDArray[np.float64]] = {
        "left": np.array([0.03, 0.09, 0.0]),
        "right": np.array([0.08, -0.1, 0.0]),
    }
    legs.carry(forces, points)
    torques = legs.torques
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


def command_of(com, torso, positions, rotations, forces, centers):
    """A command of which legs read targets, forces and momentum alone."""
    feet = {side: FootTarget(positions[side], rotations[side], forces[side], centers[side]) for side in SIDES}
    return Command(com, torso, feet, *([None] * 6), momentum=np.array([2e-3, -3e-3]))


@pytest.mark.parametrize("strided", [False, True])
@pytest.mark.parametrize("unloaded", [(), ("left",), ("right",)])
def test_a_command_is_followed_and_carried_as_by_its_parts(h1, unloaded, strided):
    pair = [build_leg_model(h1) for _ in range(2)]
    rng = np.random.default_rng(len(unloaded))
    for legs in pair:
        posture = np.array([*h1.posture["left"], *h1.posture["right"]])
        legs.set_configuration(np.array([0.0, 0.0, 0.84]), np.array([1.0, 0.0, 0.0, 0.0]), posture)
    whole, parts = pair
    for seed in range(5):
        com, torso, positions, rotations = random_targets(seed)
        forces = {side: rng.normal((0.0, 0.0, 400.0), 100.0) for side in SIDES}
        for side in unloaded:
            forces[side][2] = -1.0
        centers = {side: positions[side][:2] + rng.normal(0.0, 0.02, 2) for side in SIDES}
        velocity, acceleration = rng.normal(size=(2, len(whole.rows)))
        command = command_of(com, torso, positions, rotations, forces, centers)
        if strided:
            loads = {side: np.repeat(forces[side], 2)[::2] for side in SIDES}
            command = command_of(com, torso, positions, rotations, loads, centers)
        missed = whole.follow_command(command, 0.1)
        assert missed == parts.follow(com, torso, positions, rotations, 1, unloaded, 0.1)
        assert np.array_equal(whole.joints, parts.joints)
        whole.carry_command(command, velocity, acceleration, bool(seed % 2))
        parts.carry(forces, {side: [*centers[side], positions[side][2]] for side in SIDES})
        pressing = [max(0.0, float(forces[side][2])) for side in SIDES]
        share = pressing[0] / sum(pressing)
        parts.add_motion(velocity, acceleration, share, command.momentum, bool(seed % 2))
        assert np.array_equal(whole.torques, parts.torques)


Swing = Callable[[float], tuple[NDArray[np.float64], NDArray[np.float64]]]


def swings_out_of_reach() -> dict[str, Swing]:
    """Way of the swing foot from its stand and rotation vector, over a share 0 to 1 of a second, and then held."""
    level = np.zeros(3)
    return {
        "forward, until its knee is straight": lambda x: (np.array([0.6 * x, 0.0, 0.05]), level),
        "down, below the ground": lambda x: (np.array([0.3 * x, 0.0, -0.3 * x]), level),
        "sideways": lambda x: (np.array([0.0, 0.8 * x, 0.05]), level),
        "just out of reach": lambda x: (np.array([0.35 * x, 0.0, -0.12 * x]), level),
        "a jump to far away": lambda x: (np.array([5.0, 2.0, 1.0]) if x > 0.1 else level, level),
        "turned beyond the ankle": lambda x: (np.array([0.1 * x, 0.0, 0.08 * x]), np.array([1.5 * x, 1.5 * x, 0.0])),
    }


@pytest.mark.sample(4)
@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
@pytest.mark.parametrize("case", swings_out_of_reach())
def test_a_swing_out_of_reach_does_not_move_the_stance(robot, case):
    """It used to throw the stance knee by 0.5 rad in a tick: every joint's step was clamped by itself."""
    biped, swing = load_robot(robot), swings_out_of_reach()[case]
    legs = build_leg_model(biped)
    posture = np.array([*biped.posture["left"], *biped.posture["right"]])
    legs.set_configuration(np.array([0.0, 0.0, 0.84]), np.array([1.0, 0.0, 0.0, 0.0]), posture)
    half, com = 0.5 * biped.stance_width, np.array([0.04, -0.03, biped.com_height])
    stand: dict[Side, NDArray[np.float64]] = {"left": np.array([0.0, half, 0.0]), "right": np.array([0.0, -half, 0.0])}
    joints, _ = solved(legs, com, np.eye(3), stand, LEVEL, iterations=50)
    data = mujoco.MjData(legs.model)
    stance = legs.model.site(biped.legs["right"].sole_site).id
    steps, missed = [], []
    for k in range(400):
        way, turn = swing(min(1.0, k / 200))
        positions = {**stand, "left": stand["left"] + way}
        rotations = {**LEVEL, "left": np.asarray(Rotation.from_rotvec(turn).as_matrix())}
        # The robot goes on to balance meanwhile.
        sway = com + np.array([0.01 * math.sin(0.05 * k), 0.01 * math.sin(0.03 * k), 0.0])
        before, (joints, _) = joints, solved(legs, sway, np.eye(3), positions, rotations, 1, ["left"], 0.1)
        steps.append(np.abs(joints - before))
        data.qpos[:] = legs.configuration
        mujoco.mj_kinematics(legs.model, data)
        mujoco.mj_comPos(legs.model, data)
        missed.append([np.abs(data.site_xpos[stance] - stand["right"]).max(), np.abs(data.subtree_com[0] - sway).max()])
    moved = np.array(steps)
    assert moved.max() <= 0.1 + 1e-12
    assert moved[:, 6:].max() < 0.05  # rad of a stance joint in a tick
    assert np.max(missed) < 1e-3  # m
    assert moved[-100:].max() < 0.01  # the target is held: nothing chatters


@pytest.mark.parametrize("height", [1.0, 1.5])
def test_a_stance_out_of_reach_stretches_and_stays_calm(legs, height):
    joints, _ = solved(legs, np.array([0.05, 0.0, 0.79]), np.eye(3), STANCE, LEVEL, iterations=12)
    start, steps = joints, []
    for k in range(400):
        com = np.array([0.05, 0.0, 0.79 + (height - 0.79) * min(1.0, k / 100)])
        before, (joints, _) = joints, solved(legs, com, np.eye(3), STANCE, LEVEL, largest_step=0.1)
        steps.append(float(np.abs(joints - before).max()))
    assert max(steps) <= 0.1 + 1e-12
    assert max(steps[-100:]) < 0.01
    assert joints[[3, 9]].max() < 0.5 * start[[3, 9]].min()  # the knees


@pytest.mark.parametrize("seed", range(4))
def test_legs_without_ankle_roll_leave_the_roll_of_their_soles(h1, seed):
    spec = robot_spec(h1)
    names = [name for side in SIDES for name in h1.legs[side].joints if not name.endswith("ankle_roll")]
    for side in SIDES:
        spec.delete(spec.actuator(f"{side}_ankle_roll"))
        spec.delete(spec.joint(f"{side}_ankle_roll"))
    model = spec.compile()
    legs = LegModel(model, names, {s: f"{s}_sole" for s in SIDES}, "base")
    posture = np.array([*h1.posture["left"][:5], *h1.posture["right"][:5]])
    legs.set_configuration(np.array([0.0, 0.0, 0.84]), np.array([1.0, 0.0, 0.0, 0.0]), posture)
    com, torso, positions, rotations = random_targets(seed)
    _, error = solved(legs, com, torso, positions, rotations, iterations=20)
    assert error < 1e-9
    data = mujoco.MjData(model)
    data.qpos[:] = legs.configuration
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    assert data.subtree_com[0] == pytest.approx(com, abs=1e-8)
    assert data.body("base").xmat.reshape(3, 3) == pytest.approx(torso, abs=1e-8)
    for side in SIDES:
        place = data.site(f"{side}_sole")
        assert place.xpos == pytest.approx(positions[side], abs=1e-8)
        # The sole's x axis is where it shall be; it may have rolled about it.
        assert place.xmat.reshape(3, 3)[:, 0] == pytest.approx(rotations[side][:, 0], abs=1e-7)


@pytest.mark.parametrize("robot", ["h1", "hrp2kai"])
def test_soles_move_as_their_poses_differ(robot):
    legs = build_leg_model(load_robot(robot))
    rng = np.random.default_rng(3)
    joints = rng.uniform(-0.4, 0.4, len(legs.joints))
    moved, turned = legs.sole_motions(joints)
    step = 1e-6
    for joint in range(len(joints)):
        ahead, back = (legs.posture(joints + sign * step * np.eye(len(joints))[joint]) for sign in (1.0, -1.0))
        for i, side in enumerate(SIDES):
            velocity = (ahead.positions[side] - back.positions[side]) / (2.0 * step)
            turn = Rotation.from_matrix(ahead.rotations[side] @ back.rotations[side].T).as_rotvec() / (2.0 * step)
            np.testing.assert_allclose(moved[i, :, joint], velocity, atol=1e-8)
            np.testing.assert_allclose(turned[i, :, joint], turn, atol=1e-8)
