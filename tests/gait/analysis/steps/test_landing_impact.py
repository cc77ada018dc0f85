"""The landing impact against its closed form: of a force that rises as a straight line it is that line after 50 ms."""

import numpy as np
import pytest

from plantar.gait.analysis.steps.step_measures import landing_impact


@pytest.mark.parametrize("rate", [25.0, 31.25, 50.0, 100.0, 333.0])
@pytest.mark.parametrize("strike", [0.2, 0.2071, 0.213, 0.2199])
def test_no_frame_rate_and_no_instant_of_the_strike_changes_it(rate, strike):
    time = np.arange(0.0, 1.0, 1.0 / rate)
    assert landing_impact(time, 4000.0 * time, strike) == pytest.approx(4000.0 * (strike + 0.05))


def test_a_peak_inside_counts_and_what_was_not_measured_does_not():
    time = np.arange(0.0, 1.0, 0.01)
    force = np.where(np.isclose(time, 0.23), 900.0, 400.0)
    assert landing_impact(time, force, 0.205) == 900.0
    force[time > 0.24] = np.nan
    assert landing_impact(time, force, 0.205) == 900.0
    force[time > 0.2] = np.nan
    assert np.isnan(landing_impact(time, force, 0.205))
    apart = np.array([0.0, 0.2, 0.21, 0.9])
    assert landing_impact(apart, np.array([0.0, 100.0, 200.0, 5000.0]), 0.2) == 200.0  # no line across a gap
