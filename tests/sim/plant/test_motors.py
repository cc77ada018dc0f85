from types import SimpleNamespace

import numpy as np
import pytest

from plantar.sim.plant.motors import TorqueCurve, TrueMotors


def plant(**fields: object) -> SimpleNamespace:
    nominal = {"actuation_delay": 0.0, "encoder_offsets": np.zeros(1), "backlash": 0.0, "torque_ripple": 0.0}
    return SimpleNamespace(**nominal | fields)


def torque(found: np.ndarray, q: float = 0.1, v: float = 0.5) -> float:
    """What an actuator with gains of 50 and 2 exerts."""
    return float(found[0] - 50.0 * q - 2.0 * v)


@pytest.mark.parametrize(
    ("fields", "expected"),
    [
        ({}, 50.0 * (0.3 - 0.1) + 2.0 * (1.0 - 0.5) + 4.0),
        ({"encoder_offsets": np.array([0.02])}, 50.0 * (0.3 - 0.12) + 2.0 * (1.0 - 0.5) + 4.0),
        ({"backlash": 0.2}, 50.0 * (0.3 - 0.1 - 0.1) + 2.0 * (1.0 - 0.5) + 4.0),
        ({"torque_ripple": 0.1}, (1.0 + 0.1 * np.sin(200.0 * 0.1)) * 15.0),
    ],
)
def test_torque_is_that_of_the_gain_loop(fields: dict[str, object], expected: float) -> None:
    motors = TrueMotors(plant(**fields), np.array([50.0]), np.array([2.0]))  # type: ignore[arg-type]
    asked = np.array([50.0 * 0.3 + 2.0 * 1.0 + 4.0])
    found = motors.control(0.0, asked, np.array([0.1]), np.array([0.5]))
    assert torque(found) == pytest.approx(expected)


def test_targets_arrive_late() -> None:
    motors = TrueMotors(plant(actuation_delay=0.002), np.array([50.0]), np.array([2.0]))  # type: ignore[arg-type]
    still = np.zeros(1)
    found = [float(motors.control(0.001 * k, np.array([float(k)]), still, still)[0]) for k in range(5)]
    assert found == [0.0, 0.0, 0.0, 1.0, 2.0]


def test_a_motors_torque_falls_with_its_speed_and_its_brake_keeps_it() -> None:
    ranges = np.array([[-8.0, 8.0]])
    model = SimpleNamespace(actuator_forcerange=ranges, actuator_forcelimited=np.ones(1, dtype=bool))
    curve = TorqueCurve(model, np.array([0]), np.array([10.0]), 0.5)
    assert curve.acts
    for speed, low, high in (
        (0.0, -8.0, 8.0),
        (5.0, -8.0, 8.0),
        (7.5, -8.0, 4.0),
        (-7.5, -4.0, 8.0),
        (12.0, -8.0, 0.0),
    ):
        curve.limit(np.array([speed]))
        assert ranges[0].tolist() == pytest.approx([low, high])
