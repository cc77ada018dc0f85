import numpy as np

from plantar.wholebody.behaviours.contact_phases import ContactPhases


def test_the_weight_goes_from_nearness_to_force_along_a_sigmoid():
    phases = ContactPhases([["a"]], [["b"]], 2.0)
    assert phases.weight(5.0) == 0.0
    assert phases.levels == [["a"]]
    assert phases.enter(True, 5.0)
    assert not phases.enter(True, 5.5)
    assert phases.levels == [["b"]]
    assert [round(phases.weight(t), 6) for t in (5.0, 6.0, 7.0, 9.0)] == [0.0, 0.5, 1.0, 1.0]


def test_the_weight_is_continuous_when_a_phase_is_left_midway():
    phases = ContactPhases([], [], 2.0)
    times, weights = np.arange(0.0, 6.0, 1e-3), []
    for t in times:
        if 1.0 <= t < 1.0005:
            phases.enter(True, t)
        if 1.9 <= t < 1.9005:
            phases.enter(False, t)
        weights.append(phases.weight(t))
    assert max(weights) > 0.3
    assert np.abs(np.diff(weights)).max() < 2e-3
    assert weights[-1] == 0.0
