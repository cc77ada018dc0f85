import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar.gait.estimate.ankle_sensor import AnkleSensor, SoleWrench


def test_the_foots_weight_is_taken_off_at_any_posture():
    rng = np.random.default_rng(0)
    for _ in range(20):
        mount, sole = Rotation.random(rng=rng).as_matrix(), Rotation.random(rng=rng).as_matrix()
        position, com = rng.normal(0.0, 0.1, 3), rng.normal(0.0, 0.05, 3)
        sensor = AnkleSensor(position, mount, 1.9, com)
        ground = rng.normal(0.0, 100.0, 6)  # about the sole frame's origin, in it
        weight = sole.T @ [0.0, 0.0, -1.9 * 9.81]
        # A foot at rest passes on what the ground and gravity do to it.
        force = ground[:3] + weight
        moment = ground[3:] + np.cross(com, weight) - np.cross(position, force)
        measured = np.concatenate([mount.T @ force, mount.T @ moment])
        assert sensor.sole_wrench(measured, sole).wrench_in_sole == pytest.approx(ground, abs=1e-9)


def test_it_answers_like_a_percept():
    loaded = SoleWrench(np.array([1.0, 2.0, 200.0, 4.0, -6.0, 0.0]))
    assert loaded.vertical_force == 200.0
    assert loaded.position_cop_in_sole == pytest.approx([0.03, 0.02])
    assert SoleWrench(np.zeros(6)).position_cop_in_sole is None
    assert SoleWrench(np.array([0.0, 0.0, -5.0, 1.0, 0.0, 0.0])).position_cop_in_sole is None
