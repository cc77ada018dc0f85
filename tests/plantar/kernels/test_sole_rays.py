"""The kernel of a sole's proximity sensors against numpy and rays cast one by one, in both forms."""

import numpy as np
import pytest

from plantar.kernels import python_form
from plantar.kernels.sensors import ground_rays, noise_rows, sole_rays

FORMS = (noise_rows, sole_rays), tuple(map(python_form, ("noise_rows", "sole_rays")))
LIFT, MOST = 0.02, 0.05


def sole(rng):
    """A sole's rays, and a plane with two boxes on it."""
    starts, ways = rng.uniform(-0.1, 0.1, (20, 3)) * [1.0, 0.6, 0.0], np.tile([0.0, 0.0, -1.0], (20, 1))
    ids, kinds = np.arange(3, dtype=np.int32), np.array([0, 6, 6], dtype=np.int32)
    sizes = np.array([[0.0, 0.0, 1.0], [0.04, 0.04, 0.01], [0.03, 0.05, 0.02]])
    solids = ids, kinds, sizes, np.linalg.norm(sizes, axis=1)
    positions = np.array([[0.0, 0.0, 0.0], [0.05, 0.0, 0.01], [-0.05, 0.02, 0.0]])
    return starts, ways, solids, positions, np.tile(np.eye(3).ravel(), (3, 1))


@pytest.mark.parametrize("forms", FORMS, ids=["compiled", "python"])
def test_each_taxel_tells_how_far_its_ray_goes(forms):
    rng = np.random.default_rng(3)
    starts, ways, solids, positions, frames = sole(rng)
    origin, rotation, dead = np.zeros(3), np.eye(3), np.array([2, 5])
    rays = forms[1].SoleRays(starts, ways, LIFT, MOST, origin, rotation, solids, positions, frames)
    rows = rng.normal(0.0, 2e-3, (30, 20))
    noise, lengths, seen = forms[0].NoiseRows(lambda: rows), np.empty(20), 0
    for k in range(30):
        angle = rng.normal(0.0, 0.1)
        rotation[:] = [[np.cos(angle), 0.0, np.sin(angle)], [0.0, 1.0, 0.0], [-np.sin(angle), 0.0, np.cos(angle)]]
        origin[:] = rng.uniform([-0.1, -0.1, 0.03], [0.1, 0.1, 0.09])
        rays.cast()
        rays.measure()
        world, along = starts.dot(rotation.T) + origin, ways.dot(rotation.T)
        ground_rays.cast_rays(world, along, MOST + LIFT, *solids, positions, frames, lengths)
        wanted = np.where((lengths >= 0.0) & (lengths <= MOST + LIFT), lengths - LIFT, np.inf)
        assert np.array_equal(rays.starts, world)
        assert np.array_equal(rays.ways, along)
        assert np.array_equal(rays.distances, wanted)
        told = wanted + rows[k]
        told[told > MOST] = np.inf
        told[dead] = np.nan
        assert np.array_equal(rays.tell(noise, noise.advance(), dead), told, equal_nan=True)
        seen += int(np.isfinite(told).sum())
        height = float(rng.uniform(0.0, 0.1))
        assert rays.lies_below(0.1, height) == (origin[2] - 0.1 * np.hypot(*rotation[2, :2]) <= height)
    assert 100 < seen < 500
    rays.see_nothing()
    assert np.isinf(rays.distances).all()
