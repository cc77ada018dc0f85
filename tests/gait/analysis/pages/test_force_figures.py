"""Figures of forces show what was measured alone."""

from dataclasses import replace

import numpy as np

from plantar.gait.analysis.pages.force_figures import figure_wrench
from plantar.gait.analysis.parameters import analyse_feet

from ..walks import made_walk


def test_the_wrench_has_a_gap_where_a_sole_was_not_measured():
    recording = replace(made_walk(strides=3).recording, kind="robot")
    left = recording.feet["left"]
    force = left.force.copy()
    force[100:150] = np.nan
    feet = analyse_feet(replace(recording, feet={**recording.feet, "left": replace(left, force=force)}))
    drawn = figure_wrench(recording, feet).axes[0].lines[0].get_data()
    assert np.interp(1.2, *drawn) != np.interp(1.2, *drawn)
    assert np.nanmax(drawn[1]) > 500.0
