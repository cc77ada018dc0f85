import mujoco
import numpy as np
import pytest

from plantar.common.sides import SIDES
from plantar.robots.kinematics.ankle_limits import ankle_limits, standing_legs
from plantar.robots.kinematics.body import body_of, stood
from plantar.robots.kinematics.robot_model import build_leg_model
from plantar.robots.robot_file import load_robot


@pytest.mark.parametrize("slope", [(0.0, 0.0), (0.17, 0.0), (-0.1, 0.08)])
@pytest.mark.parametrize("name", ["h1", "hrp2kai"])
def test_weight_at_the_edge_of_a_strip_takes_the_limit_of_its_joint(name, slope):
    robot = load_robot(name)
    model = build_leg_model(robot).model
    weight = body_of(robot, model).weight
    data = stood(robot, model)
    mujoco.mj_comPos(model, data)
    for side, strips in ankle_limits(robot, model, weight).items():
        assert len(strips) == 2
        site = model.site(robot.legs[side].sole_site).id
        origin, rotation = data.site_xpos[site], data.site_xmat[site].reshape(3, 3)
        up = np.array([*slope, 1.0]) / np.linalg.norm([*slope, 1.0])
        for (x, y, middle, half, high), kind in zip(strips.tolist(), ("pitch", "roll"), strict=True):
            joint = model.joint(f"{side}_ankle_{kind}")
            moved = -high * np.dot((x, y), up[:2]) / up[2]  # the weight goes down past the joint
            for edge in (moved + middle - half / up[2], moved + middle + half / up[2]):
                place = origin + rotation[:, :2] @ (edge * np.array([x, y]))
                # MuJoCo's own Jacobian of the point, fixed to the foot: an upward force's generalised force is J^T f.
                jacobian = np.zeros((3, model.nv))
                mujoco.mj_jac(model, data, jacobian, None, place, int(model.site_bodyid[site]))
                torque = weight * (rotation @ up) @ jacobian[:, joint.dofadr[0]]
                limit = model.actuator(f"{side}_ankle_{kind}").forcerange[1]
                assert abs(torque) == pytest.approx(limit, rel=1e-9)


@pytest.mark.parametrize("name", ["h1", "hrp2kai"])
def test_weight_under_the_hip_loads_the_knee_as_its_strip_says(name):
    robot = load_robot(name)
    model = build_leg_model(robot).model
    weight = body_of(robot, model).weight
    data = stood(robot, model)
    mujoco.mj_comPos(model, data)
    for side, leg in standing_legs(robot, model, weight, 0.0).items():
        middle, half = leg.strip()
        knee = model.joint(f"{side}_knee")
        hip, ankle = (data.xanchor[model.joint(f"{side}_{name}_pitch").id] for name in ("hip", "ankle"))
        foot = int(model.site_bodyid[model.site(robot.legs[side].sole_site).id])
        jacobian = np.zeros((3, model.nv))
        mujoco.mj_jac(model, data, jacobian, None, hip, foot)
        upright = np.arctan2(hip[0] - ankle[0], hip[2] - ankle[2])
        found = []  # with the leg turned about its ankle: where the hip is along the sole, and the knee's torque
        for tilt in (-0.2, 0.0, 0.2):
            turn = upright - tilt  # the weight turns instead, the other way
            up, along = np.array([np.sin(turn), 0, np.cos(turn)]), np.array([np.cos(turn), 0, -np.sin(turn)])
            place = ankle[0] - data.site(f"{side}_sole").xpos[0] + along @ (hip - ankle)
            found.append((float(place), weight * float(up @ jacobian[:, knee.dofadr[0]])))
        (back, less), (place, torque), (front, more) = found
        limit = float(model.actuator(f"{side}_knee").forcerange[1])
        assert abs(torque) == pytest.approx(limit * abs(place - middle) / half, rel=1e-9)
        # The knee's way ahead of the line to the hip turns by the cosine alone, which cancels between two tilts.
        assert front > place > back
        assert abs(more - less) == pytest.approx(limit * (front - back) / half, rel=1e-9)
        assert (abs(more) < abs(torque) < abs(less)) == (middle > front)


def test_joints_without_limits_have_no_strips():
    robot = load_robot("h1")
    model = build_leg_model(robot).model
    model.actuator_forcelimited[:] = 0
    assert all(len(ankle_limits(robot, model, 800.0)[side]) == 0 for side in SIDES)
    assert standing_legs(robot, model, 800.0, 0.0) == {}


def test_a_leg_that_crouches_can_rise_by_as_much():
    robot = load_robot("h1")
    model = build_leg_model(robot).model
    tall, low = (standing_legs(robot, model, 800.0, crouch)["left"] for crouch in (0.0, 0.03))
    assert low.strip(low.rise) == pytest.approx(tall.strip())
    assert (tall.thigh, tall.shank) == pytest.approx((0.3, 0.3))
    assert tall.aside == pytest.approx(0.075)
    assert tall.high == pytest.approx(0.129)
