"""Pairs of patches and obstacles that may meet, by both forms of the kernel: none is left out that does."""

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar.kernels import python_form
from plantar.kernels.contacts.near_patches import NearPatches

FORMS = {"compiled": NearPatches, "python": python_form("contacts.near_patches").NearPatches}
BODIES, GEOMS, PATCHES = 4, 5, 6


@pytest.mark.parametrize("form", FORMS)
def test_no_pair_is_left_out_of_which_a_point_of_one_is_in_the_other(form: str) -> None:
    rng = np.random.default_rng(65)
    met = apart = 0
    for _ in range(40):
        bodies = rng.integers(0, BODIES, PATCHES)
        geoms = rng.permutation(GEOMS)[:3]
        low = rng.uniform(-0.2, 0.0, (PATCHES, 3))
        high = low + rng.uniform(0.05, 0.3, (PATCHES, 3))
        middles = 0.5 * (low + high)
        squares = 0.25 * ((high - low) ** 2).sum(axis=1)
        halves = rng.uniform(0.02, 0.2, (3, 3))
        shapes = np.hstack([np.zeros((3, 3)), halves])
        near: Any = FORMS[form](
            bodies.astype(np.intp),
            np.column_stack([middles, squares]),
            np.hstack([low, high]),
            geoms.astype(np.intp),
            shapes,
            (halves**2).sum(axis=1),
        )
        places, geom_places = rng.uniform(-0.3, 0.3, (BODIES, 3)), rng.uniform(-0.3, 0.3, (GEOMS, 3))
        turns = Rotation.random(BODIES, random_state=rng.integers(1 << 30)).as_matrix()
        geom_turns = Rotation.random(GEOMS, random_state=rng.integers(1 << 30)).as_matrix()
        count = near.look(places, turns.reshape(-1, 9), geom_places, geom_turns.reshape(-1, 9))
        assert count == near.near.sum()
        for i, body in enumerate(bodies):
            inside = low[i] + rng.random((2000, 3)) * (high[i] - low[i])
            world = inside @ turns[body].T + places[body]
            for k, geom in enumerate(geoms):
                local = (world - geom_places[geom]) @ geom_turns[geom]
                if (np.abs(local) <= halves[k]).all(axis=1).any():
                    assert near.near[i, k]
                    met += 1
                apart += not near.near[i, k]
    assert met > 50
    assert apart > 100
