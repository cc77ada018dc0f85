"""What the kernels of tasks write, against the tasks' own error and MuJoCo's Jacobian."""

import mujoco
import numpy as np
import pytest

from plantar.mechanics.rotation import rotation_from_vector
from plantar.robots.kinematics.tasks.com_task import ComTask
from plantar.robots.kinematics.tasks.pose_task import OrientationTask, PoseTask, RollingPoseTask
from plantar.robots.kinematics.tasks.posture_task import PostureTask
from plantar.robots.kinematics.tasks.task import chain

TWO_TREES = """
<mujoco><worldbody>
  <body name="a"><joint name="ball" type="ball"/><geom size=".1"/>
    <body name="b" pos="0 .1 .3"><joint name="slide" type="slide"/><joint name="hinge" axis="0 1 1"/>
      <geom type="ellipsoid" size=".1 .2 .1" pos=".1 0 0"/>
      <body name="fixed" pos=".1 0 0"><geom size=".1"/><site name="tip" pos=".2 .1 0" euler="20 40 60"/></body>
    </body>
  </body>
  <body name="other"><freejoint/><geom size=".3"/><body pos="1 1 1"><joint/><geom size=".1"/></body></body>
  <body name="still"><geom size=".1"/><site name="mark"/></body>
</worldbody></mujoco>
"""


@pytest.mark.parametrize("seed", range(6))
def test_kernels_write_what_error_and_jacobian_say(seed):
    model = mujoco.MjModel.from_xml_string(TWO_TREES)
    data, rng = mujoco.MjData(model), np.random.default_rng(seed)
    ids = [model.joint(name).id for name in ("hinge", "slide")]
    poses = [kind(model, data, model.site(name).id) for kind in (PoseTask, RollingPoseTask) for name in ("tip", "mark")]
    turns = [OrientationTask(model, data, model.body(name).id) for name in ("fixed", "a", "still")]
    coms = [ComTask(model, data, model.body(name).id) for name in ("world", "a", "b", "other", "still")]
    tasks = [*poses, *turns, *coms, PostureTask(model, data, ids)]
    written = [(np.zeros(t.rows), np.zeros((t.rows, model.nv))) for t in tasks]
    kernels = [t.rows_for(*out) for t, out in zip(tasks, written, strict=True)]
    assert [task for task, kernel in zip(tasks, kernels, strict=True) if kernel is None] == [*poses[2:], tasks[-1]]
    for _ in range(5):
        data.qpos[:] = rng.normal(size=model.nq)
        mujoco.mj_normalizeQuat(model, data.qpos)
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        for pose in poses:
            pose.position, pose.rotation = rng.normal(size=3), rotation_from_vector(rng.normal(size=3))
        for turn in turns:
            turn.target = rotation_from_vector(rng.normal(size=3))
        for com in coms:
            com.target = rng.normal(size=3)
        for task, (error, jacobian), kernel in zip(tasks, written, kernels, strict=True):
            if kernel is None:
                continue
            wanted, moves = np.zeros(task.rows), np.zeros((task.rows, model.nv))
            task.error(wanted)
            task.jacobian(moves)
            # A turn of more than a quarter is left to the task.
            known = task.rows if kernel.write() else task.lengths
            np.testing.assert_allclose(error[:known], wanted[:known], rtol=0.0, atol=1e-15)
            np.testing.assert_allclose(jacobian, moves, rtol=0.0, atol=1e-14)


def test_a_target_is_an_array_of_the_tasks_own():
    model = mujoco.MjModel.from_xml_string(TWO_TREES)
    data = mujoco.MjData(model)
    task, point = ComTask(model, data, 1), np.array([1.0, 2.0, 3.0])
    own = task.target
    task.target = point
    point[:] = 0.0
    assert task.target is own
    assert own.tolist() == [1.0, 2.0, 3.0]
    with pytest.raises(ValueError, match="broadcast"):
        task.target = np.zeros(4)


def test_a_chain_leads_from_a_body_to_its_root():
    model = mujoco.MjModel.from_xml_string(TWO_TREES)
    chains = {name: chain(model, model.body(name).id).tolist() for name in ("fixed", "a", "other", "still", "world")}
    assert chains == {"fixed": [4, 3, 2, 1, 0], "a": [2, 1, 0], "other": [10, 9, 8, 7, 6, 5], "still": [], "world": []}
