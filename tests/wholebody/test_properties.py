"""What holds of stacks of tasks on any robot: strict order, bounded and continuous torques, a support that stays."""

import numpy as np
import pytest

from plantar.wholebody.fusion.hierarchy import DAMPED, fuse
from plantar.wholebody.tasks.cartesian_pose import CartesianPose
from plantar.wholebody.tasks.center_of_mass import CenterOfMass
from plantar.wholebody.tasks.point_force import PointForce
from plantar.wholebody.tasks.posture import Posture
from plantar.wholebody.tasks.self_collision import SelfCollision, Sphere
from plantar.wholebody.tasks.support import Standing, Support

SIZES = (3, 4, 5, 6, 7, 9, 12, 16, 20, 24, 30, 36)


def random_task(rng, robot, count):
    """One of the tasks, with a target that is off by some centimetres or tenths of a radian."""
    link = f"link{rng.integers(0, count)}"
    point = rng.uniform(-0.1, 0.1, 3)
    kind = rng.integers(0, 7)
    if kind < 3:
        task = CartesianPose(link, point, rows=("pose", "position", "orientation")[kind])
        task.demand(robot, None)  # takes its target from where the link is
        task.target_position = task.target_position + rng.uniform(-0.05, 0.05, 3)
        return task
    if kind == 3:
        return CenterOfMass(robot.com()[0] + rng.uniform(-0.05, 0.05, 3))
    if kind == 4:
        held = rng.permutation(len(robot.joints))[: rng.integers(1, len(robot.joints) + 1)]
        return Posture(robot.joint_positions + rng.uniform(-0.3, 0.3, len(robot.joints)), joints=held)
    if kind == 5:
        task = PointForce(link, point)
        task.force = rng.uniform(-20.0, 20.0, 3)
        return task
    other = f"link{rng.integers(0, count)}"
    return SelfCollision([(Sphere(link, point, 0.05), Sphere(other, -point, 0.05))], 10.0, 50.0)


def moved(rng, robot, spread=1.0, speed=1.0):
    """Put a robot into a random position, with a random velocity."""
    model = robot.model
    position = model.qpos0.copy()
    position[-model.njnt :] += spread * rng.uniform(-1.5, 1.5, model.njnt)
    if model.nq != model.nv:  # a free base
        position = model.qpos0.copy()
        position[7:] += spread * rng.uniform(-1.5, 1.5, model.nq - 7)
        position[3:7] = (lambda q: q / np.linalg.norm(q))(rng.normal(size=4))
    robot.update(position, speed * rng.uniform(-1.0, 1.0, model.nv), 0.0)


def disturbance(levels, before, after):
    """Largest change of a level's acceleration by those below, as a share of what it asks for and has."""
    worst = 0.0
    for demand in levels:
        own = demand.jacobian @ before
        asked = own if demand.acceleration is None else np.append(demand.acceleration, own)
        worst = max(worst, np.abs(demand.jacobian @ after - own).max() / max(np.abs(asked).max(), 1e-3))
    return worst


@pytest.mark.parametrize("joints", SIZES)
@pytest.mark.parametrize("where", ["regular", "singular", "near"])
def test_a_lower_task_changes_no_higher_acceleration(random_chain, joints, where):
    """Up to 6 tasks: singular is a stretched chain whose axes are parallel, near is 1e-9 to 1e-2 rad away from it."""
    for seed in range(12):
        rng = np.random.default_rng([joints, seed, len(where)])
        robot = random_chain(rng, joints, parallel=where != "regular")
        moved(rng, robot, {"regular": 1.0, "singular": 0.0, "near": 10.0 ** rng.uniform(-9.0, -2.0)}[where])
        tasks = [random_task(rng, robot, joints) for _ in range(rng.integers(2, 7))]
        if where != "regular" and len(tasks) > 2:
            tasks[-1] = tasks[0]  # what is met already
        levels = [[d] for t in tasks if (d := t.demand(robot, None)) is not None]
        every = fuse(robot, levels)
        assert np.isfinite(every.torque).all()
        for i in range(len(levels)):
            above = fuse(robot, [*levels[: i + 1], []]).acceleration
            assert disturbance(levels[i], above, every.acceleration) < 1e-9


@pytest.mark.parametrize("joints", [3, 7, 16, 36])
def test_what_is_regular_and_above_all_others_is_met(random_chain, joints):
    for seed in range(5):
        rng = np.random.default_rng([joints, seed])
        robot = random_chain(rng, joints)
        moved(rng, robot)
        first = Posture(np.zeros(joints)).demand(robot, None)
        assert np.allclose(fuse(robot, [[first]]).acceleration, first.acceleration, rtol=1e-9, atol=1e-9)
        reached = CartesianPose("link2", np.array([0.1, 0.0, 0.0]), rows="position").demand(robot, None)
        sizes = np.linalg.svd(reached.jacobian, compute_uv=False)
        if sizes[-1] < 0.1:
            continue
        found = fuse(robot, [[reached], [first]]).acceleration
        assert np.allclose(reached.jacobian @ found + reached.drift, reached.acceleration, rtol=1e-8, atol=1e-8)


def torques_along(robot, tasks, path, count):
    """Torques of a stack at as many places of a path through joint space."""
    found = []
    for share in np.linspace(0.0, 1.0, count):
        robot.update(path(share), np.zeros(robot.model.nv), 0.0)
        found.append(fuse(robot, [[d] for t in tasks if (d := t.demand(robot, None)) is not None]).torque)
    return np.array(found)


@pytest.mark.parametrize("joints", [3, 6, 7])
def test_torques_are_bounded_and_continuous_through_a_stretched_arm(random_chain, joints):
    """The hand shall go outwards of a stretched arm: half of the step, half of the largest jump."""
    rng = np.random.default_rng(joints)
    robot = random_chain(rng, joints, parallel=True)
    hand = CartesianPose(f"link{joints - 1}", rows="position")
    hand.target_position = np.array([0.25 * joints + 0.3, 0.05, 0.0])
    turned = CartesianPose(f"link{joints - 1}", rows="orientation")
    turned.target_rotation = np.eye(3)
    tasks = [hand, turned, Posture(np.full(joints, 0.3))]
    bend = rng.choice([-1.0, 1.0], joints) * rng.uniform(0.3, 1.0, joints)

    def path(share):
        return (share - 0.5) * bend

    coarse, fine = (torques_along(robot, tasks, path, count) for count in (2000, 4000))
    jumps = [np.abs(np.diff(t, axis=0)).max() for t in (coarse, fine)]
    assert jumps[1] < 0.6 * jumps[0]
    # What is wanted is 30 m/s^2 at the most; s / (s^2 + lambda^2) is at the most 2 / (sqrt(3) s_0).
    robot.update(path(0.5), np.zeros(joints), 0.0)
    mass = np.linalg.eigvalsh(robot.mass_matrix).max()
    reach = np.linalg.norm(hand.demand(robot, None).jacobian, axis=1).max()
    bound = mass * 30.0 * 2.0 / np.sqrt(3.0) / (DAMPED * reach)
    assert np.abs(coarse).max() < bound
    stretched = fuse(robot, [[d] for t in tasks if (d := t.demand(robot, None)) is not None])
    assert np.abs(stretched.torque).max() < bound


@pytest.mark.parametrize("joints", [8, 20, 30])
def test_a_support_does_not_accelerate_and_carries_the_base(random_chain, joints):
    for seed in range(5):
        rng = np.random.default_rng([joints, seed])
        robot = random_chain(rng, joints, floating=True)
        moved(rng, robot)
        stands = Support({"foot": Standing(f"link{joints - 1}", np.zeros(3))})
        support = stands.demand(robot, None)
        tasks = [random_task(rng, robot, joints) for _ in range(5)]
        levels = [[d] for t in tasks if (d := t.demand(robot, None)) is not None]
        found = fuse(robot, levels, support)
        standing = support.jacobian @ found.acceleration + support.drift
        assert np.abs(standing).max() < 1e-9 * max(1.0, np.abs(found.acceleration).max())
        left = robot.mass_matrix @ found.acceleration + robot.bias - support.jacobian.T @ found.support_force
        assert np.abs(left[:6]).max() < 1e-8 * max(1.0, np.abs(left).max())
        assert np.allclose(left[robot.joints], found.torque, atol=1e-8 * np.abs(left).max())
