"""The kernel of the swing foot's correction against its equation in numpy, and its compiled form against its source."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar import kernels
from plantar.kernels.gait import lean_correction
from plantar.mechanics.rotation import heading, level_rotation, rotation_from_vector, sine_vector

SHARE, SHIFT, TURN = 0.15, 0.06, 0.12


@pytest.mark.parametrize("size", [0.0, 0.01, 0.3, 3.0])
@pytest.mark.parametrize("seed", range(3))
def test_a_tick_is_that_of_the_equation(seed, size):
    rng = np.random.default_rng(seed)
    position, com = rng.normal(size=(2, 3))
    place, estimated = position + 0.1 * size * rng.normal(size=3), com + 0.1 * size * rng.normal(size=3)
    wanted = Rotation.from_rotvec(rng.normal(size=3))
    actual = Rotation.from_rotvec(size * rng.normal(size=3)) * wanted
    kept, shift, turn = 0.01 * rng.normal(size=(3, 3))
    weight = float(rng.random())
    found = []
    for module in (lean_correction, kernels.python_form("lean_correction")):
        moved, turned = shift.copy(), turn.copy()
        given = (position, place, com, estimated, wanted.as_matrix(), actual.as_matrix(), kept, SHIFT, TURN)
        module.correct(*given, weight, SHARE, moved, turned)
        found.append((moved, turned))
    assert np.array_equal(*found)
    lean = wanted.as_matrix() @ actual.as_matrix().T
    way, sine = com + lean @ (place - estimated) - position, sine_vector(lean)
    way, sine = (v * min(1.0, most / max(1e-300, np.linalg.norm(v))) for v, most in ((way, SHIFT), (sine, TURN)))
    moved, turned = found[0]
    np.testing.assert_allclose(moved, shift + SHARE * (weight * (way + kept) - shift), rtol=1e-13, atol=1e-15)
    np.testing.assert_allclose(turned, turn + SHARE * (weight * sine - turn), rtol=1e-13, atol=1e-15)


@pytest.mark.parametrize(
    "form", [lean_correction, kernels.python_form("lean_correction")], ids=["as installed", "interpreted"]
)
def test_turns_are_products_of_rotations(form):
    rng = np.random.default_rng(3)
    for _ in range(50):
        rotation, turn = rotation_from_vector(rng.normal(size=3)), rng.normal(0.0, 0.3, 3)
        assert form.turned(turn, rotation) == pytest.approx(rotation_from_vector(turn) @ rotation, abs=1e-15)
        yaw = float(rng.uniform(-3.0, 3.0))
        headed = form.headed(rotation, yaw)
        assert headed == pytest.approx(level_rotation(yaw - heading(rotation)) @ rotation, abs=1e-15)
        assert heading(headed) == pytest.approx(yaw, abs=1e-14)
        assert headed[2] == pytest.approx(rotation[2], abs=0.0)
        assert np.array_equal(headed, lean_correction.headed(rotation, yaw))
        assert np.array_equal(form.turned(turn, rotation), lean_correction.turned(turn, rotation))
