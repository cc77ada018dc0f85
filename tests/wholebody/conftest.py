"""Robots to try fusion and tasks on: random equations of motion, and random chains of links in MuJoCo."""

from dataclasses import dataclass

import mujoco
import numpy as np
import pytest
from numpy.typing import NDArray

from plantar.sim.companion.dynamics import MujocoDynamics

HAND = """
<mujoco>
  <worldbody>
    <body name="hand">
      <joint name="x" type="slide" axis="1 0 0"/><joint name="y" type="slide" axis="0 1 0"/>
      <joint name="yaw" axis="0 0 1"/><geom size="0.1" mass="2"/>
    </body>
  </worldbody>
</mujoco>
"""


@dataclass
class RandomRobot:
    """Only what fusion and the torque resolver ask for."""

    mass_matrix: NDArray[np.float64]
    bias: NDArray[np.float64]
    joints: NDArray[np.int64]
    velocity: NDArray[np.float64]
    joint_positions: NDArray[np.float64]
    time: float = 0.0


@pytest.fixture
def random_robot():
    """`random_robot(rng, size, base=0)`: `base` coordinates come first that no joint drives."""

    def make(rng: np.random.Generator, size: int, base: int = 0) -> RandomRobot:
        root = rng.normal(size=(size, size))
        joints = np.arange(base, size)
        return RandomRobot(
            root @ root.T + np.eye(size), rng.normal(size=size), joints, rng.normal(size=size), np.zeros(size - base)
        )

    return make


def chain_xml(rng: np.random.Generator, joints: int, floating: bool, parallel: bool) -> str:
    """MJCF of links "link0", "link1", ..., each with a hinge or, one in eight, a slide; some branch off.

    The links of a parallel chain lie along x and turn about z, so that stretched it is singular.
    """
    bodies: list[list[int]] = [[] for _ in range(joints + 1)]  # children of the base, 0, and of each link
    for i in range(1, joints + 1):
        branches = not parallel and i > 3 and rng.random() < 0.15
        bodies[int(rng.integers(0, i)) if branches else i - 1].append(i)

    def numbers(values: object) -> str:
        return " ".join(f"{v:.6f}" for v in np.atleast_1d(values))

    def link(i: int) -> str:
        end = np.array([0.25, 0.0, 0.0]) if parallel else rng.uniform((-0.2, -0.2, -0.1), (0.2, 0.2, 0.3))
        kind = "slide" if not parallel and rng.random() < 0.125 else "hinge"
        axis = np.array([0.0, 0.0, 1.0]) if parallel else rng.normal(size=3)
        moved = f'<joint name="joint{i - 1}" type="{kind}" axis="{numbers(axis)}" armature="0.02"/>'
        if i == 0:
            moved = "<freejoint/>" if floating else ""
        shape = f'<geom type="capsule" fromto="0 0 0 {numbers(end)}" size="0.03" mass="{rng.uniform(0.3, 3.0):.4f}"/>'
        inner = "".join(f'<body pos="{numbers(end)}" name="link{k - 1}">{link(k)}</body>' for k in bodies[i])
        return moved + shape + inner

    alone = '<option><flag contact="disable"/></option>'
    return f'<mujoco>{alone}<worldbody><body name="base">{link(0)}</body></worldbody></mujoco>'


@pytest.fixture
def robot():
    """A body that slides along x and y and turns about z."""
    return MujocoDynamics(mujoco.MjModel.from_xml_string(HAND))


@pytest.fixture
def random_chain():
    """`random_chain(rng, joints, floating=False, parallel=False)`: its joints at 0 and at rest until it is updated."""

    def make(rng: np.random.Generator, joints: int, floating: bool = False, parallel: bool = False) -> MujocoDynamics:
        model = mujoco.MjModel.from_xml_string(chain_xml(rng, joints, floating, parallel))
        robot = MujocoDynamics(model)
        robot.update(model.qpos0, np.zeros(model.nv), 0.0)
        return robot

    return make
