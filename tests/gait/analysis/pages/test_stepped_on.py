"""The part of a platform that a picture shows."""

import numpy as np

from plantar.formats.recorded_layouts import grid_cells
from plantar.gait.analysis.pages.sole_figures import stepped_on

PLATFORM = grid_cells(np.ones((30, 20), dtype=bool), 0.01, 0.01, side="left", name="platform", threshold=1.0)


def test_cells_that_are_stepped_on_are_shown_with_those_around_them():
    hit = np.zeros(len(PLATFORM), dtype=bool)
    hit[210] = True
    chosen, ring = stepped_on(PLATFORM, hit)
    assert set(chosen.tolist()) == {210, *PLATFORM.neighbours[210]}
    corners = np.vstack([PLATFORM.cell_polygon(int(c)) for c in chosen])
    np.testing.assert_allclose(ring.min(axis=0), corners.min(axis=0) - 0.01, atol=1e-12)
    np.testing.assert_allclose(ring.max(axis=0), corners.max(axis=0) + 0.01, atol=1e-12)


def test_a_platform_that_nobody_stepped_on_is_shown_whole():
    chosen, _ = stepped_on(PLATFORM, np.zeros(len(PLATFORM), dtype=bool))
    assert len(chosen) == len(PLATFORM)
