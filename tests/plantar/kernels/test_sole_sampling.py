"""A sole that is sampled in one kernel reads what its parts read one by one, in both forms."""

from collections import deque
from types import SimpleNamespace

import numpy as np
import pytest

from plantar import Reading
from plantar.kernels import python_form
from plantar.kernels.sensors import noise_rows, sole_sampling

FORMS = (noise_rows, sole_sampling), tuple(map(python_form, ("noise_rows", "sole_sampling")))


class _Rays:
    """Rays that each measure the same distance."""

    def __init__(self):
        self.looks = 0

    def look(self):
        self.looks += 1

    def tell(self, noise, row, dead):
        told = 0.04 + np.array(noise.rows[row])
        told[dead] = np.nan
        return told


@pytest.mark.parametrize("forms", FORMS, ids=["compiled", "python"])
def test_a_sample_without_rays_draws_its_noise(forms):
    rows = np.random.default_rng(0).normal(size=(9, 4))
    samples = forms[1].ProximitySampling(forms[0].NoiseRows(lambda: rows), 4, np.array([1]))
    samples.skip()
    samples.leave()
    assert (samples.cast, samples.skipped) == (4, 4)
    if forms[0] is not noise_rows:  # compiled ones take rays of their own class alone
        told = samples.of(_Rays())
        assert np.array_equal(told, np.where(np.arange(4) == 1, np.nan, 0.04 + rows[2]), equal_nan=True)
        assert (samples.cast, samples.skipped) == (8, 4)


def test_readings_are_late_and_closed_to_writing():
    noise, sampling = FORMS[1]
    rows = np.random.default_rng(1).normal(size=(20, 3))
    near = sampling.ProximitySampling(noise.NoiseRows(lambda: rows), 3, np.array([], dtype=np.intp))
    forces = iter(np.arange(60.0).reshape(20, 3))
    sample = SimpleNamespace(of_contacts=lambda *_: next(forces).copy())
    queue: deque[Reading] = deque([Reading(0.0, np.zeros(3))], maxlen=3)
    clock = noise.SampleClock(0.004, 1e-6)
    clock.due(0.0)
    sole = sampling.SoleSampling(clock, sample, None, None, 1e-3, near, queue, Reading)
    rays = _Rays()
    delivered = [sole.read(0.001 * k, None, rays if k > 12 else None) for k in range(1, 21)]
    assert [round(reading.time, 3) for reading in delivered[3::4]] == [0.0, 0.0, 0.004, 0.008, 0.012]
    assert [reading.time for reading in queue] == pytest.approx([0.012, 0.016, 0.02])
    assert [reading.proximity is None for reading in queue] == [True, False, False]
    assert np.array_equal(queue[1].proximity, 0.04 + rows[3])
    assert np.array_equal(queue[1].force, [9.0, 10.0, 11.0])
    assert not queue[1].force.flags.writeable
    assert not queue[1].proximity.flags.writeable
    assert rays.looks == 2
    assert (near.cast, near.skipped) == (6, 9)
