"""The summary's figure shows what both feet measured."""

from dataclasses import replace

import numpy as np

from plantar.gait.analysis.pages.one_page import figure_summary
from plantar.gait.analysis.parameters import analyse_feet

from ..walks import made_walk


def test_the_butterfly_has_a_gap_where_a_foot_was_not_measured():
    recording = made_walk(strides=6).recording
    whole = wings(recording)
    frame = int(np.flatnonzero((np.abs(whole[0]) < 30.0) & (recording.time > 3.0))[0])  # between both feet
    lost = slice(frame - 10, frame + 10)
    left = recording.feet["left"]
    force = left.force.copy()
    force[lost] = np.nan
    cut = wings(replace(recording, feet={**recording.feet, "left": replace(left, force=force)}))
    assert np.isfinite(whole[:, lost]).all()
    assert np.isnan(cut[:, lost]).all()


def wings(recording):
    """CoP of both feet (2, n) in mm, to the right and forward, as drawn."""
    return np.array(figure_summary(recording, analyse_feet(recording)).axes[1].lines[0].get_data(), dtype=float)
