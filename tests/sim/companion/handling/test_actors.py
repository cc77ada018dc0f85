"""Who pushes, and who walks up to the base."""

import numpy as np
import pytest

from plantar.sim.companion.handling.actors import Push, Visit


def test_push_comes_and_goes_without_a_jump():
    push = Push(1.0, 3.0, "forearm", 0.1, 0.0, 0.05, 8.0)
    times = np.arange(0.9, 3.1, 1e-3)
    forces = np.array([push.wanted(t) for t in times])
    assert forces.max() == pytest.approx(8.0)
    assert forces[0] == forces[-1] == 0.0
    assert np.abs(np.diff(forces)).max() < 8.0 * 1e-3 * 1.875 / 0.4 * 1.01


def test_visitor_comes_stops_and_leaves():
    visit = Visit(2.0, 12.0, np.array([0.5, 0.0]), np.array([2.5, 0.0]), 1.0)
    np.testing.assert_allclose(visit.place(2.0), [2.5, 0.0])
    np.testing.assert_allclose(visit.place(7.0), [0.5, 0.0])
    np.testing.assert_allclose(visit.place(12.0), [2.5, 0.0])
    speeds = np.abs(np.diff([visit.place(t)[0] for t in np.arange(2.0, 12.0, 0.01)])) / 0.01
    assert speeds.max() < 1.0 * 1.875 * 1.01
