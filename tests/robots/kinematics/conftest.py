"""Random robots for kinematics: chains of hinges, fixed or floating, one limb or two."""

import mujoco
import numpy as np
import pytest
from numpy.typing import NDArray

from plantar.robots.kinematics.tasks.task import Task


def _text(values: NDArray[np.float64]) -> str:
    return " ".join(map(str, values.tolist()))


def _ball(mass: float) -> str:
    return f'<geom type="sphere" size="0.03" mass="{mass}" contype="0" conaffinity="0"/>'


def _limb(rng: np.random.Generator, name: str, joints: int, limited: bool) -> str:
    """Nested bodies, a hinge each about any axis, and a site at the end."""
    inner = f'<site name="{name}_end" pos="0 0 -0.1"/>'
    for k in reversed(range(joints)):
        axis, place = _text(rng.normal(size=3)), _text(rng.uniform([-0.1, -0.1, -0.4], [0.1, 0.1, -0.1]))
        low, high = -rng.uniform(0.3, 2.5), rng.uniform(0.3, 2.5)
        limits = f'limited="true" range="{low} {high}"' if limited and rng.random() < 0.8 else 'limited="false"'
        joint = f'<joint name="{name}{k}" axis="{axis}" {limits}/>'
        inner = f'<body name="{name}{k}" pos="{place}">{joint}{_ball(rng.uniform(0.5, 5.0))}{inner}</body>'
    return inner


@pytest.fixture
def random_robot():
    """A model and its data for a seed: `limbs` chains of `joints` hinges on a body that floats or not."""

    def build(seed, *, limbs=1, joints=7, floating=False, limited=True):
        rng = np.random.default_rng(seed)
        chains = "".join(_limb(rng, name, joints, limited) for name in "ab"[:limbs])
        root = ("<freejoint/>" if floating else "") + _ball(20.0) + chains
        model = mujoco.MjModel.from_xml_string(
            '<mujoco><compiler angle="radian" autolimits="false"/><worldbody>'
            f'<body name="root" pos="0 0 1">{root}</body></worldbody></mujoco>'
        )
        data = mujoco.MjData(model)
        for k in range(model.njnt):
            if model.jnt_type[k] == mujoco.mjtJoint.mjJNT_HINGE:
                low, high = model.jnt_range[k] if model.jnt_limited[k] else (-1.0, 1.0)
                data.qpos[model.jnt_qposadr[k]] = rng.uniform(0.7 * low, 0.7 * high)
        refresh(model, data)
        return model, data

    return build


def refresh(model: mujoco.MjModel, data: mujoco.MjData) -> None:
    """What tasks read."""
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)


@pytest.fixture
def differentiate():
    """Check a task whose target is met: its error changes by minus its Jacobian, along every velocity."""

    def check(model: mujoco.MjModel, data: mujoco.MjData, task: Task) -> None:
        start, h = data.qpos.copy(), 1e-6
        jacobian, error = np.full((task.rows, model.nv), np.nan), np.full(task.rows, np.nan)
        refresh(model, data)
        task.error(error)
        assert np.abs(error).max() < 1e-12
        task.jacobian(jacobian)
        found = np.empty_like(jacobian)
        for k in range(model.nv):
            ends: list[NDArray[np.float64]] = []
            for sign in (1.0, -1.0):
                data.qpos[:] = start
                mujoco.mj_integratePos(model, data.qpos, sign * np.eye(model.nv)[k], h)
                refresh(model, data)
                task.error(error)
                ends.append(error.copy())
            found[:, k] = (ends[0] - ends[1]) / (2.0 * h)
        assert np.abs(found + jacobian).max() < 1e-8

    return check
