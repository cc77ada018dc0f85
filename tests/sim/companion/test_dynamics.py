"""Kinematics and dynamics for the tasks against finite differences and MuJoCo's own inverse dynamics."""

import mujoco
import numpy as np
import pytest

from plantar.errors import InputError
from plantar.sim.companion.dynamics import MujocoDynamics

CHAIN = """
<mujoco><option><flag contact="disable"/></option>
  <worldbody>
    <body name="base" pos="0 0 1">{base}
      <geom type="box" size=".1 .2 .3" pos=".02 0 .1"/>
      <body name="upper" pos="0 .2 .1">
        <joint name="a" axis="0 1 .2" armature=".1"/><geom type="capsule" size=".04" fromto="0 0 0 .1 0 -.4"/>
        <body name="lower" pos=".1 0 -.4">
          <joint name="b" axis="1 0 .5"/><joint name="c" type="slide" axis="0 0 1"/>
          <geom type="capsule" size=".03" fromto="0 0 0 .3 .1 0"/>
        </body>
      </body>
      <body name="side" pos="0 -.2 0"><joint name="d" axis="0 0 1"/><geom type="sphere" size=".1" pos=".2 0 0"/></body>
    </body>
  </worldbody>
  {actuators}
</mujoco>"""
MOTORS = '<actuator><motor joint="c"/><motor joint="a"/></actuator>'
TENDON = '<tendon><fixed name="t"><joint joint="b" coef="1"/><joint joint="d" coef="1"/></fixed></tendon>'


@pytest.fixture(params=["fixed", "floating"])
def robot(request):
    base = "<freejoint/>" if request.param == "floating" else ""
    model = mujoco.MjModel.from_xml_string(CHAIN.format(base=base, actuators=""))
    rng = np.random.default_rng(4)
    qpos = model.qpos0.copy()
    mujoco.mj_integratePos(model, qpos, rng.normal(0.0, 0.6, model.nv), 1.0)
    found = MujocoDynamics(model)
    found.update(qpos, rng.normal(0.0, 1.0, model.nv), 0.3)
    return found


def moved(robot: MujocoDynamics, step: float, way: np.ndarray | None = None) -> MujocoDynamics:
    """The robot a little later or, given a direction (n,), displaced along it."""
    qpos = robot.data.qpos.copy()
    mujoco.mj_integratePos(robot.model, qpos, robot.velocity if way is None else way, step)
    other = MujocoDynamics(robot.model)
    other.update(qpos, robot.velocity, 0.0)
    return other


@pytest.mark.parametrize("link", ["base", "lower", "side"])
def test_jacobian_and_drift_against_finite_differences(robot, link):
    point, h = np.array([0.1, -0.2, 0.05]), 1e-6
    jacobian = robot.jacobian(link, point)
    for i in range(robot.model.nv):
        ends = [moved(robot, s * h, np.eye(robot.model.nv)[i]).pose(link) for s in (1, -1)]
        places = [position + rotation @ point for position, rotation in ends]
        turn = (ends[0][1] - ends[1][1]) @ robot.pose(link)[1].T / (2 * h)
        assert jacobian[:3, i] == pytest.approx((places[0] - places[1]) / (2 * h), abs=1e-8)
        assert jacobian[3:, i] == pytest.approx([turn[2, 1], turn[0, 2], turn[1, 0]], abs=1e-8)
    speeds = [moved(robot, s * h).jacobian(link, point) @ robot.velocity for s in (1, -1)]
    assert robot.drift(link, point) == pytest.approx((speeds[0] - speeds[1]) / (2 * h), abs=1e-7)


def test_centre_of_mass_against_finite_differences(robot):
    _position, jacobian, drift = robot.com()
    h, n = 1e-6, robot.model.nv
    for i in range(n):
        a, b = (moved(robot, s * h, np.eye(n)[i]).com()[0] for s in (1, -1))
        assert jacobian[:, i] == pytest.approx((a - b) / (2 * h), abs=1e-8)
    a, b = (moved(robot, s * h).com()[1] @ robot.velocity for s in (1, -1))
    assert drift == pytest.approx((a - b) / (2 * h), abs=1e-7)


def test_equations_of_motion_are_those_of_mujoco(robot):
    data = mujoco.MjData(robot.model)
    data.qpos, data.qvel = robot.data.qpos, robot.velocity
    mujoco.mj_inverse(robot.model, data)
    assert robot.bias == pytest.approx(data.qfrc_inverse, abs=1e-10)
    acceleration = np.random.default_rng(1).normal(size=robot.model.nv)
    data.qacc = acceleration
    mujoco.mj_inverse(robot.model, data)
    assert robot.mass_matrix @ acceleration + robot.bias == pytest.approx(data.qfrc_inverse, abs=1e-9)
    mujoco.mj_forward(robot.model, data)
    full = np.zeros((robot.model.nv,) * 2)
    mujoco.mj_fullM(robot.model, data, full)
    assert np.array_equal(robot.mass_matrix, full)


def test_nothing_is_computed_before_it_is_asked_for_and_a_jacobian_once(robot):
    assert robot.jacobians == 0
    first = robot.jacobian("lower")
    assert robot.jacobian("lower") is first
    assert robot.jacobians == 1
    robot.jacobian("lower", np.zeros(3))
    assert robot.jacobians == 2
    robot.update(robot.data.qpos, np.zeros(robot.model.nv), 0.4)
    assert robot.jacobian("lower") == pytest.approx(first)
    assert robot.jacobians == 3
    assert robot.time == 0.4


def test_joints_are_those_with_actuators_in_the_order_of_the_model():
    model = mujoco.MjModel.from_xml_string(CHAIN.format(base="<freejoint/>", actuators=MOTORS))
    robot = MujocoDynamics(model)
    assert robot.joints.tolist() == [6, 8]
    qpos = model.qpos0.copy()
    qpos[7:] = [0.1, 0.2, 0.3, 0.4]
    robot.update(qpos, np.zeros(model.nv), 0.0)
    assert robot.joint_positions.tolist() == [0.1, 0.3]


def test_an_actuator_of_a_tendon_is_none_of_the_joint_of_its_number():
    motors = TENDON + MOTORS.replace('<motor joint="a"/>', '<motor tendon="t"/>')
    model = mujoco.MjModel.from_xml_string(CHAIN.format(base="", actuators=motors))
    assert MujocoDynamics(model).joints.tolist() == [2]


def test_an_unknown_link_is_named_with_those_near_to_it(robot):
    with pytest.raises(InputError, match=r"no link 'loewr'; nearest: lower"):
        robot.jacobian("loewr")
    with pytest.raises(InputError, match=r"no link 'x'; there are base, upper"):
        robot.pose("x")


def test_a_model_without_joints_is_refused():
    model = mujoco.MjModel.from_xml_string("<mujoco><worldbody><body><geom size='.1'/></body></worldbody></mujoco>")
    with pytest.raises(InputError, match="no hinge or slide joint"):
        MujocoDynamics(model)
