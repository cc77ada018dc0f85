"""Bipeds that are drawn by lot are found right: legs, sides, feet, soles and how they lie, IMU."""

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar.robots.survey.survey import survey_model

from .random_biped import X, Y, random_biped


@pytest.mark.sample(6)
@pytest.mark.parametrize("seed", range(60))
def test_an_unseen_biped_is_found(seed, tmp_path):
    truth = random_biped(seed, tmp_path)
    found = survey_model(truth.file, tmp_path)
    model = found.source.model
    assert {s: found.joint_names(s) for s in ("left", "right")} == truth.joints
    assert {s: found.foot_name(s) for s in ("left", "right")} == truth.feet
    np.testing.assert_allclose(found.legs.rotation, truth.rotation.T, atol=1e-9)
    assert found.mass == pytest.approx(truth.mass, rel=1e-5)
    assert (found.imu is not None) == truth.imu
    for side in ("left", "right"):
        sole, (point, frame) = found.soles[side], truth.soles[side]
        place = model.body(truth.feet[side])
        # Seen from the body, the sole's z is the robot's up, and its x the robot's forward direction.
        np.testing.assert_allclose(frame @ sole.rotation, truth.rotation @ truth.pitched, atol=2e-3)
        middle = frame.T @ (point - _origin(model, int(place.id)))
        local = sole.rotation.T @ (middle - sole.origin)
        assert abs(float(local[2])) < 1e-3, "the sole plane"
        np.testing.assert_allclose(0.5 * (sole.low + sole.high), local[:2], atol=2e-3)
        assert (sole.high - sole.low)[0] == pytest.approx(truth.size[0], abs=0.12 * truth.size[0])
        assert (sole.high - sole.low)[1] == pytest.approx(truth.size[1], abs=0.3 * truth.size[1])


@pytest.mark.sample(2)
@pytest.mark.parametrize("seed", range(4))
def test_legs_of_four_joints_are_found(seed, tmp_path):
    truth = random_biped(seed, tmp_path, (X, Y, Y, Y))
    found = survey_model(truth.file, tmp_path)
    assert {s: found.joint_names(s) for s in ("left", "right")} == truth.joints
    assert len(truth.joints["left"]) == 4


@pytest.mark.sample(1, each="axis")
@pytest.mark.parametrize(
    ("axis", "degrees", "words"),
    [*(("z", degrees, "turned by") for degrees in (10.0, -30.0, 150.0)), ("x", -90.0, "y axis points up")],
)
def test_a_model_that_is_turned_or_has_y_up_is_turned_back(axis, degrees, words, tmp_path):
    truth = random_biped(10, tmp_path)
    spec = mujoco.MjSpec.from_file(str(truth.file))
    turn, trunk = Rotation.from_euler(axis, degrees, True), spec.body("trunk")
    trunk.pos = turn.apply(trunk.pos)
    trunk.quat = np.roll((turn * Rotation.from_quat(np.roll(trunk.quat, -1))).as_quat(), 1)
    spec.compile()
    truth.file.write_text(spec.to_xml())
    found = survey_model(truth.file, tmp_path)
    np.testing.assert_allclose(found.legs.rotation, truth.rotation.T @ turn.inv().as_matrix(), atol=1e-4)
    assert any(words in note for note in found.notes)


def _origin(model, body: int) -> np.ndarray:
    """Where a body's frame is in the posture of the file."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    return data.xpos[body].copy()
