import numpy as np
import pytest

from ..references import area_exact
from .dirty_rings import ExactRing, convex_ring, dirty_ring


@pytest.mark.parametrize("seed", range(40))
def test_rounding_spoils_a_ring_by_little(seed):
    ring = dirty_ring(np.random.default_rng(seed))
    exact = ExactRing.of(ring)
    assert exact.step <= 1e-6
    local = exact.local(ring)
    assert -exact.depth(local).min() <= 2e-11  # what stands for it holds it
    whole, hull = area_exact([local]), area_exact([exact.polygon])
    assert abs(abs(whole) - hull) <= 2e-11 * len(ring) + 8.0 * len(ring) * exact.step
    assert len(ring) > len(exact.polygon)


def test_rings_of_all_kinds_come():
    rings = [dirty_ring(np.random.default_rng(seed)) for seed in range(200)]
    exact = [ExactRing.of(ring) for ring in rings]
    assert {int(np.sign(area_exact([ring]))) for ring in rings} == {-1, 1}
    sizes = np.array([float(e.size) for e in exact])
    assert sizes.min() < 1e-5
    assert sizes.max() > 100.0
    assert max(float(np.abs(ring).max()) for ring in rings) > 1e5
    narrow = [float(np.ptp(e.polygon @ [[0.0], [1.0]])) for e in exact]
    assert min(narrow) < 1e-5
    assert any(len(convex_ring(np.random.default_rng(seed))) > 10 for seed in range(20))
