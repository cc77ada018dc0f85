"""Servo gains, and the rotor inertia that is assumed where a joint would be too light for any."""

import numpy as np
import pytest

from plantar.robots.survey.model_copy import add_rotors
from plantar.robots.survey.servo_gains import SAMPLED, JointInertia, rotor_inertia, servo_gains
from plantar.robots.walk import CONTROL_PERIOD


@pytest.mark.parametrize("seed", range(20))
def test_with_the_rotors_that_are_assumed_no_joint_swings_too_far_in_a_control_period(seed):
    random = np.random.default_rng(seed)
    mass, height, beat = 10.0 ** random.uniform(0.3, 2.2), random.uniform(0.15, 1.2), random.uniform(0.1, 0.3)
    swing, stated = 10.0 ** random.uniform(-5.0, 0.0, 6), np.where(random.random(6) < 0.3, 1e-3, 0.0)
    bare = JointInertia(swing + stated, swing + 1.0, stated, np.zeros(6))
    rotors = rotor_inertia(bare, mass, height, CONTROL_PERIOD)
    assert not rotors[stated > 0.0].any()  # what the model states is believed
    full = JointInertia(bare.swing + rotors, bare.stance + rotors, stated + rotors, bare.damping)
    stiffness, _ = servo_gains(full, mass, height, beat, CONTROL_PERIOD)
    phase = CONTROL_PERIOD * np.sqrt(stiffness / full.swing)
    assert (phase[stated == 0.0] <= 1.08 * SAMPLED).all()  # figures of two digits
    heavy = CONTROL_PERIOD * np.sqrt(servo_gains(bare, mass, height, beat, CONTROL_PERIOD)[0] / bare.swing)
    assert not rotors[heavy < 0.92 * SAMPLED].any()


def test_rotors_are_written_where_their_joints_are(tmp_path):
    file = tmp_path / "model.xml"
    file.write_text(
        '<mujoco><worldbody><body><joint name="a" range="-1 1" /><joint name="b" /></body></worldbody></mujoco>'
    )
    add_rotors(file, {"b": 0.0036})
    text = file.read_text()
    assert text.count("armature") == 1
    assert '<joint name="b" armature="0.0036" />' in text
