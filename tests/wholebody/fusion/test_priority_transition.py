import math

import numpy as np

from plantar.wholebody.fusion.priority_transition import PriorityTransition, smooth_share


def largest_jump(transition, switches, step=1e-4, end=1.0):
    """Largest change between ticks while the arrangement's torque jumps to another value at each switch."""
    values, target = [], 0.0
    for k in range(int(end / step)):
        now = k * step
        for at, value in switches:
            if abs(now - at) < step / 2:
                transition.begin(now)
                target = value
        values.append(transition.blend(np.array([target]), now)[0])
    return np.abs(np.diff(values)).max(), values[-1]


def test_a_change_is_continuous_also_when_another_begins_within_it():
    for step in (1e-3, 5e-4):
        jump, last = largest_jump(PriorityTransition(0.2), [(0.1, 10.0), (0.2, -30.0), (0.23, 40.0)], step)
        assert jump < 80.0 * 2.5 / 0.2 * step  # steepest slope of the sigmoid times the largest change
        assert last == 40.0


def test_the_printed_share_jumps_half_of_the_way_at_the_trigger():
    def printed(elapsed: float, rate: float) -> float:
        return 1.0 - (1.0 - math.tanh(rate * elapsed)) / 2.0

    assert printed(0.0, 20.0) == 0.5
    assert smooth_share(0.0, 0.2) == 0.0
    assert smooth_share(0.1, 0.2) == 0.5


def test_the_share_is_a_sigmoid_from_0_to_1():
    values = [smooth_share(t, 0.3) for t in np.linspace(-0.1, 0.4, 501)]
    assert values[0] == 0.0
    assert values[-1] == 1.0
    assert (np.diff(values) >= 0.0).all()
    assert np.allclose(np.array(values) + np.array(values)[::-1], 1.0)


def test_without_a_change_torques_pass_through_and_the_first_has_nothing_to_fade_from():
    transition = PriorityTransition()
    transition.begin(0.0)
    torque = np.array([1.0, 2.0])
    assert transition.blend(torque, 0.0) is torque


def test_no_duration_is_a_jump():
    transition = PriorityTransition(0.0)
    transition.blend(np.zeros(1), 0.0)
    transition.begin(0.0)
    assert transition.blend(np.ones(1), 0.0)[0] == 1.0
