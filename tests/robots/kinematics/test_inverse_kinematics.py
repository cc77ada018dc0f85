"""Newton steps on random robots: like mink where targets are in reach, and calm where they are not."""

from collections.abc import Callable, Sequence

import mujoco
import numpy as np
import pytest
from hypothesis import HealthCheck, given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from plantar.robots.kinematics.inverse_kinematics import InverseKinematics
from plantar.robots.kinematics.tasks.com_task import ComTask
from plantar.robots.kinematics.tasks.pose_task import PoseTask
from plantar.robots.kinematics.tasks.posture_task import PostureTask
from plantar.robots.kinematics.tasks.task import Task

from ...examples import examples

Robot = tuple[mujoco.MjModel, mujoco.MjData]


class PointTask(Task):
    """The position of a site alone: a task of three rows, as a user of the interface writes one."""

    rows = 3

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, site: int) -> None:
        self._model, self._data, self._site = model, data, site
        self.target: NDArray[np.float64] = data.site_xpos[site].copy()

    def error(self, out: NDArray[np.float64]) -> None:
        np.subtract(self.target, self._data.site_xpos[self._site], out=out)

    def jacobian(self, out: NDArray[np.float64]) -> None:
        mujoco.mj_jacSite(self._model, self._data, out, None, self._site)


def solver(robot: Robot, tasks: Sequence[Task]) -> InverseKinematics:
    model, data = robot
    hinges = [k for k in range(model.njnt) if model.jnt_type[k] == mujoco.mjtJoint.mjJNT_HINGE]
    return InverseKinematics(model, data, tasks, PostureTask(model, data, hinges), np.arange(model.nv))


def limits(model: mujoco.MjModel) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int_]]:
    hinges = np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_HINGE)
    free = model.jnt_limited[hinges] == 0
    low = np.where(free, -np.inf, model.jnt_range[hinges, 0])
    return low, np.where(free, np.inf, model.jnt_range[hinges, 1]), model.jnt_qposadr[hinges]


def moved(model: mujoco.MjModel, before: NDArray[np.float64], after: NDArray[np.float64]) -> NDArray[np.float64]:
    way = np.empty(model.nv)
    mujoco.mj_differentiatePos(model, way, 1.0, before, after)
    return way


def far_from_singular(build: Callable[..., Robot], seed: int) -> Robot:
    """The first of some random arms whose least singular value is 0.03 or more."""
    for k in range(100):
        model, data = build(100 * seed + k, joints=6, limited=False)
        jacobian = np.empty((6, 6))
        PoseTask(model, data, model.site("a_end").id).jacobian(jacobian)
        if np.linalg.svd(jacobian)[1][-1] > 0.03:
            return model, data
    raise AssertionError("no such arm")


@examples(40, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(seed=st.integers(0, 10**6), floating=st.booleans(), size=st.floats(-2.0, 2.0), largest=st.floats(0.01, 0.5))
def test_no_target_makes_a_step_too_large_or_leaves_a_limit(random_robot, seed, floating, size, largest):
    rng = np.random.default_rng(seed)
    model, data = random_robot(seed, limbs=2, joints=int(rng.integers(2, 8)), floating=floating)
    tasks = [PoseTask(model, data, model.site(f"{name}_end").id) for name in "ab"]
    center = ComTask(model, data, model.body("root").id)
    tasks[1].level = int(rng.integers(0, 2))
    inverse = solver((model, data), [center, *tasks])
    low, high, places = limits(model)
    for _ in range(25):
        for task in tasks:
            task.position = task.position + 10.0**size * rng.normal(size=3)
            task.rotation = np.asarray(Rotation.random(random_state=int(rng.integers(2**31))).as_matrix())
        center.target = center.target + 10.0**size * rng.normal(size=3)
        before = data.qpos.copy()
        inverse.solve(1, largest)
        assert np.isfinite(data.qpos).all()
        assert np.abs(moved(model, before, data.qpos)).max() <= largest + 1e-9
        assert (data.qpos[places] >= low).all()
        assert (data.qpos[places] <= high).all()


class AskedPose(PoseTask):
    """A pose whose error and Jacobian a solver asks for, as of a task without a kernel."""

    def rows_for(self, error: NDArray[np.float64], jacobian: NDArray[np.float64]) -> None:
        """None."""


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("floating", [False, True])
def test_a_kernel_takes_the_step_of_what_a_task_says(random_robot, floating, seed):
    """Of all turns, also of more than a quarter, whose error the task writes itself."""
    ways, counts = [], []
    for kind in (PoseTask, AskedPose):
        model, data = random_robot(seed, joints=6, floating=floating, limited=False)
        task = kind(model, data, model.site("a_end").id)
        inverse = solver((model, data), [task])
        way = []
        for k, angle in enumerate(np.linspace(0.1, 3.0, 20)):
            data.qpos[-6:] += 0.1 * np.sin(np.arange(6) + k)
            inverse.move()
            inverse.place()
            here = Rotation.from_matrix(data.site("a_end").xmat.reshape(3, 3))
            task.rotation = (Rotation.from_rotvec([0.0, angle, 0.0]) * here).as_matrix()
            inverse.solve(1, 10.0)
            way.append(data.qpos.copy())
        ways.append(np.array(way))
        counts.append((inverse.plain, inverse.careful))
    assert counts[0] == counts[1]
    assert floating or counts[0][0] > 0  # that a free base leaves directions open is a matter of care
    np.testing.assert_allclose(ways[0], ways[1], rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("seed", range(8))
def test_it_goes_where_mink_goes(random_robot, seed):
    mink = pytest.importorskip("mink")
    model, data = far_from_singular(random_robot, seed)
    goal, start = data.qpos.copy(), data.qpos.copy()
    rng = np.random.default_rng(seed)
    task = PoseTask(model, data, model.site("a_end").id)  # its target is the pose of the goal
    start += rng.uniform(-0.05, 0.05, len(start))
    data.qpos[:] = start
    missed = solver((model, data), [task]).solve(60)
    configuration = mink.Configuration(model)
    configuration.update(start)
    frame = mink.FrameTask("a_end", "site", position_cost=1.0, orientation_cost=1.0)
    rotation = mink.SO3.from_matrix(task.rotation)
    frame.set_target(mink.SE3.from_rotation_and_translation(rotation, task.position))
    for _ in range(200):
        velocity = mink.solve_ik(configuration, [frame], 1.0, "daqp", damping=1e-12)
        configuration.integrate_inplace(velocity, 1.0)
    assert missed < 1e-9
    assert data.qpos == pytest.approx(configuration.q, abs=1e-6)
    assert data.qpos == pytest.approx(goal, abs=0.5)


@pytest.mark.parametrize("seed", range(6))
def test_well_conditioned_steps_are_newtons(random_robot, seed):
    model, data = far_from_singular(random_robot, seed)
    task = PoseTask(model, data, model.site("a_end").id)
    jacobian, error = np.empty((6, 6)), np.empty(6)
    task.jacobian(jacobian)
    task.position = task.position + np.array([1e-4, -2e-4, 1e-4])
    task.error(error)
    before = data.qpos.copy()
    inverse = solver((model, data), [task])
    inverse.solve(1)
    full = data.qpos - before
    assert full == pytest.approx(np.linalg.solve(jacobian, error), rel=1e-3, abs=1e-7)
    # One factor for all joints where the step would be too large.
    data.qpos[:] = before
    inverse.solve(1, 0.25 * float(np.abs(full).max()))
    assert data.qpos - before == pytest.approx(0.25 * full, rel=1e-3, abs=1e-7)


def planar(ranges: Sequence[float]) -> Robot:
    """Links of 0.3 m in a plane, a hinge each with its range."""
    links, end = "", '<site name="end" pos="0.3 0 0"/>'
    for k, r in enumerate(ranges):
        joint = f'<joint name="j{k}" axis="0 0 1" limited="true" range="{-r} {r}"/>'
        links += f'<body pos="{0.3 if k else 0.0} 0 0">{joint}<geom type="sphere" size="0.02" mass="1"/>'
        end += "</body>"
    text = f'<mujoco><compiler angle="radian"/><worldbody>{links}{end}</worldbody></mujoco>'
    model = mujoco.MjModel.from_xml_string(text)
    return model, mujoco.MjData(model)


@pytest.mark.sample(4)
@pytest.mark.parametrize("distance", [0.001, 0.05, 1.0, 100.0])
@pytest.mark.parametrize("angle", [0.3, -1.2, 2.5])
def test_out_of_reach_it_points_at_the_target_and_stands_still(angle, distance):
    model, data = planar([3.0, 3.0, 3.0, 3.0])
    data.qpos[:] = [0.2, -0.7, 0.4, 0.9]
    mujoco.mj_kinematics(model, data)
    task = PointTask(model, data, 0)
    task.target = (1.2 + distance) * np.array([np.cos(angle), np.sin(angle), 0.0])
    inverse, steps = solver((model, data), [task]), []
    for _ in range(2000):
        before = data.qpos.copy()
        inverse.solve(1, 0.02)  # c is 0.9 m
        steps.append(float(np.abs(data.qpos - before).max()))
    mujoco.mj_kinematics(model, data)
    assert np.linalg.norm(task.target - data.site_xpos[0]) == pytest.approx(distance, abs=0.01)
    assert max(steps[-100:]) < 1e-3


def test_a_joint_at_its_limit_leaves_the_rest_to_the_others():
    """The posture draws the first of three joints beyond its limit: it stops, and the end is where it shall be."""
    model, data = planar([0.2, 2.5, 2.5])
    data.qpos[:] = [0.1, 0.5, 0.5]
    mujoco.mj_kinematics(model, data)
    task = PointTask(model, data, 0)
    task.target = np.array([0.35, 0.5, 0.0])
    inverse = solver((model, data), [task])
    inverse.posture.target = np.array([2.0, 0.5, 0.5])
    assert inverse.solve(1000, 0.1) < 1e-6
    assert data.qpos[0] == pytest.approx(0.2, abs=1e-9)
    assert data.qpos[0] <= 0.2


def test_what_is_straight_bends_again():
    """Two links in line and a target on that line: no task moves them, and the posture does."""
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><worldbody><body><joint name="hip" axis="0 1 0"/><geom type="sphere" size="0.02" mass="1"/>'
        '<body pos="0 0 -0.4"><joint name="knee" axis="0 1 0"/><geom type="sphere" size="0.02" mass="1"/>'
        '<site name="end" pos="0 0 -0.4"/></body></body></worldbody></mujoco>'
    )
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    task = PointTask(model, data, 0)
    task.target = np.array([0.0, 0.0, -0.7])
    inverse = solver((model, data), [task])
    inverse.posture.target = np.array([-0.2, 0.4])
    assert inverse.solve(300, 0.1) < 1e-6
    assert data.qpos[1] > 0.5


@pytest.mark.parametrize("seed", range(6))
def test_a_lower_level_does_not_move_the_upper(random_robot, seed):
    """Two limbs of a floating robot: whatever is asked of one, the other and the CoM stay where they are."""
    model, data = random_robot(seed, limbs=2, joints=6, floating=True, limited=False)
    stays, goes = (PoseTask(model, data, model.site(f"{name}_end").id) for name in "ab")
    center = ComTask(model, data, model.body("root").id)
    goes.level = 1
    rng = np.random.default_rng(seed)
    inverse, error = solver((model, data), [center, stays, goes]), np.empty(6)
    for _ in range(60):
        goes.position = goes.position + rng.normal(size=3)
        inverse.solve(1, 0.02)
        mujoco.mj_kinematics(model, data)
        stays.error(error)
        assert np.abs(error).max() < 2e-3  # the curvature of one step of 0.02 rad


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_target_that_is_no_number_moves_nothing(random_robot, bad):
    model, data = random_robot(0)
    task = PointTask(model, data, model.site("a_end").id)
    before, inverse = data.qpos.copy(), solver((model, data), [task])
    task.target = np.array([0.0, bad, 0.0])
    assert not inverse.solve(3) <= 1e3
    assert np.array_equal(data.qpos, before)
