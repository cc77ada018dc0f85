"""Windows of a take: means of counts and loads, and which windows a fit may use."""

import numpy as np

from plantar.calibration.take import Take
from plantar.calibration.windows import windows_of

TIME = np.arange(2000) / 100
ZERO = {"left": np.zeros(2), "right": np.zeros(2)}
TOP = {"left": np.full(2, 1000.0), "right": np.full(2, 1000.0)}


def test_a_converter_at_its_end_and_unknown_loads_are_not_used():
    counts = np.full((2000, 2), 500.0)
    counts[300:310, 1] = 1023.0
    load = np.full(2000, 90.0)
    load[1000:1010] = np.nan
    load[0] = 91.0
    found = windows_of(Take("press", TIME, {"left": counts}, load), ZERO, TOP)
    assert np.flatnonzero(~found.usable).tolist() == [30, 100]
    assert found.soles["left"].above.shape == (200, 2)


def test_a_weight_is_no_load_near_steps_and_a_cop_counts_of_a_sole_that_carries_alone():
    left = np.where((TIME < 8.0)[:, None], 500.0, 0.0) * np.ones(2)
    counts = {"left": left, "right": 500.0 - left}
    cop = {"left": np.zeros((2000, 2))}
    found = windows_of(Take("motion", TIME, counts, 700.0, cop), ZERO, TOP)
    near = np.flatnonzero(~found.usable) * 0.1
    assert 6.3 < near.min() < 6.6
    assert 9.4 < near.max() < 9.7
    assert np.isfinite(found.cop["left"][:79]).all()
    assert np.isnan(found.cop["left"][81:]).all()
