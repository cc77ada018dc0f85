"""Mean and spread over few values."""

import numpy as np
import pytest

from plantar.gait.analysis.summary import spread


def test_spread_of_few_values():
    assert spread([]).mean is None
    assert spread([float("nan")]).n == 0
    one = spread([2.0])
    assert (one.mean, one.sd, one.cv_percent, one.n) == (2.0, None, None, 1)
    two = spread([1.0, 3.0])
    assert (two.sd, two.cv_percent) == pytest.approx((np.sqrt(2.0), 50 * np.sqrt(2.0)))
