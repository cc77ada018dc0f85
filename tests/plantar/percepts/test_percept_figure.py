"""The figure of a percept."""

import numpy as np
import pytest

from plantar import Percept, Reading, hex_layout
from plantar.percepts.percept_figure import percept_figure

SOLE = hex_layout([[-0.10, -0.05], [0.14, -0.05], [0.14, 0.05], [-0.10, 0.05]], cell_area=691e-6)


@pytest.mark.parametrize(("loads", "end"), [(1.0, 15.0), (40.0, 40.0)])
def test_the_colours_of_a_foot_in_the_air_do_not_look_like_a_load(loads, end):
    force = np.full(len(SOLE), 0.1)
    force[0] = loads
    figure = percept_figure(Percept(SOLE, Reading(0.0, force), 1.5))
    cells = [c for axes in figure.axes for c in axes.collections if c.get_array() is not None]
    assert any(c.get_clim()[1] == pytest.approx(end) for c in cells)
