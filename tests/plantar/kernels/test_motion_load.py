"""The kernel of motion's torques against numpy, in both forms."""

import numpy as np
import pytest

from plantar.kernels import python_form
from plantar.kernels.joints import motion_load


@pytest.mark.parametrize("whole", [True, False])
@pytest.mark.parametrize("seed", range(4))
def test_both_forms_are_the_formula(seed, whole):
    rng = np.random.default_rng(seed)
    nv, legs = 12, 4
    dofs = np.array([7, 6, 10, 11])
    rows, joints = np.concatenate([np.arange(6), dofs]).astype(np.intp), np.array([2, 1, 5, 6], dtype=np.intp)
    gravity, load, axes, armature = (rng.normal(size=s) for s in (3, nv, (7, 3), legs))
    place, turn, com = rng.normal(size=3), rng.normal(size=(3, 3)), rng.normal(size=3)
    velocity, acceleration = rng.normal(size=(2, 6 + legs))
    left, bx, by = 0.3, 2.0, -1.0
    moment = np.cross(com - place, load[:3]) + np.array([bx, by, 0.0])
    couple = turn @ load[3:6] - moment
    carried = np.array([left, left, 1.0 - left, 1.0 - left])
    taken = load[dofs] + armature * acceleration[6:]
    wanted = (taken if whole else carried * taken) - carried * (axes[joints] @ couple)
    for module in (motion_load, python_form("motion_load")):
        speeds, changes, torques = np.zeros(nv), np.zeros(nv), np.ones(legs)
        kernel = module.MotionLoad(
            *((speeds, changes), gravity, rows, load, (place, turn.reshape(-1), com), (axes, joints), armature, torques)
        )
        kernel.move(velocity, acceleration)
        assert np.array_equal(speeds[rows], velocity)
        assert np.array_equal(changes[rows], acceleration + np.concatenate([gravity, np.zeros(3 + legs)]))
        assert (speeds != 0.0).sum() == len(rows)  # others are left alone
        kernel.add(acceleration, left, bx, by, whole)
        np.testing.assert_allclose(torques, 1.0 + wanted, rtol=1e-12)


def test_velocity_and_acceleration_of_solutions_are_those_of_a_low_pass():
    rows = np.array([4, 0, 2])
    moved = np.zeros(5)
    forms = [m.JointMotion(moved, rows, 0.005, 0.3) for m in (motion_load, python_form("motion_load"))]
    velocity = np.zeros(3)
    acceleration = np.zeros(3)
    for moved[:] in np.random.default_rng(0).normal(size=(20, 5)):
        acceleration += 0.3 * ((moved[rows] - velocity) / 0.005 - acceleration)
        velocity = moved[rows]
        for motion in forms:
            motion.update()
            assert np.array_equal(motion.velocity, velocity)
            np.testing.assert_allclose(motion.acceleration, acceleration, rtol=1e-13)
