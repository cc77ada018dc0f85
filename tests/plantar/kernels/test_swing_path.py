"""Both forms of a swing's path, and its own derivatives."""

import numpy as np
import pytest

from plantar import kernels
from plantar.kernels.gait import swing_path

FORMS = [swing_path, kernels.python_form("swing_path")]


def drawn(rng, form):
    ends = rng.uniform(-0.3, 0.3, (2, 4)).tolist()
    shares = (*rng.uniform((0.3, 0.0, 0.0, 0.0), (0.5, 0.1, 0.1, 0.1)).tolist(),)
    approach = (0.0, 0.06) if rng.random() < 0.4 else (*rng.uniform((0.005, 0.02), (0.03, 0.1)).tolist(),)
    height, duration = rng.uniform((0.03, 0.5), (0.1, 1.2)).tolist()
    return (
        form.SwingPath(*map(tuple, ends), height, duration, shares, approach, bool(rng.random() < 0.3)),
        ends,
        duration,
    )


@pytest.mark.parametrize("seed", range(20))
def test_the_forms_agree_to_the_last_bit_and_lead_from_end_to_end(seed):
    (path, ends, duration), (plain, _, _) = (drawn(np.random.default_rng(seed), form) for form in FORMS)
    for time in np.linspace(-0.1, 1.1, 60) * duration:
        place, yaw = path.at(float(time))
        other, turned = plain.at(float(time))
        assert place.tolist() == other.tolist()
        assert yaw == turned
    assert path.at(0.0)[0].tolist() == pytest.approx(ends[0][:3])
    assert path.at(duration)[0].tolist()[:2] == pytest.approx(ends[1][:2])
    heights = np.array([path.at(float(t))[0][2] for t in np.linspace(0.0, duration, 2000)])
    assert np.abs(np.diff(heights, 2)).max() < 1e-4 * (1.0 + duration)  # no jump of the speed
    assert 0.0 < path.lifted < path.arrived <= duration
