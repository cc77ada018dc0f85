"""What a run records of footholds."""

import numpy as np
import pytest

from plantar.geometry.polygon import area
from plantar.sim.run import log


@pytest.mark.parametrize("vertices", [3, 24, 25, 60, 200])
def test_a_rounder_support_than_the_recording_holds_keeps_its_shape(vertices):
    angle = np.linspace(0.0, 2.0 * np.pi, vertices, endpoint=False)
    ring = np.column_stack([0.12 * np.cos(angle), 0.05 * np.sin(angle)])
    kept = log._with_fewer_vertices(ring)
    assert len(kept) == min(vertices, log.MOST_VERTICES)
    assert area(kept) >= 0.98 * area(ring)
    assert {tuple(p) for p in kept} <= {tuple(p) for p in ring}
