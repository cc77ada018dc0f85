"""Masks and measures of one's own."""

import numpy as np
import pytest

from plantar import InputError
from plantar.gait.analysis.analyse import Analysis
from plantar.gait.analysis.custom import custom_measures, mask_measures
from plantar.gait.analysis.pages.sole_figures import axis_is_inside
from plantar.gait.analysis.parameters import analyse_feet

from .walks import made_walk

WHOLE = [[-0.1, -0.1], [1.1, -0.1], [1.1, 1.1], [-0.1, 1.1]]


@pytest.fixture(scope="module")
def analysis():
    recording = made_walk(strides=5).recording
    return Analysis(recording, analyse_feet(recording), {})


def test_a_mask_of_everything_measures_the_foot(analysis):
    for side, rows in mask_measures(analysis, {"all": WHOLE}).items():
        for row, step in zip(rows, analysis.feet[side].steps, strict=True):
            assert row["all"]["peak_pressure_Pa"] == step["peak_pressure_Pa"]
            assert row["all"]["contact_area_m2"] == pytest.approx(step["contact_area_m2"])
            assert row["all"]["impulse_percent"] == pytest.approx(100.0)


def test_a_mask_is_the_same_part_of_both_feet(analysis):
    """The medial half of the forefoot; a mask with a notch leaves out what lies in the notch."""
    medial = [[0.7, 0.55], [1.0, 0.55], [1.0, 1.0], [0.7, 1.0]]
    notch = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.5, 0.5], [0.0, 1.0]]
    found = mask_measures(analysis, {"all": WHOLE, "medial": medial, "notch": notch, "turned": notch[::-1]})
    for left, right in zip(found["left"], found["right"], strict=False):
        assert left["medial"]["contact_area_m2"] == pytest.approx(right["medial"]["contact_area_m2"])
        assert (
            0.0 < left["medial"]["contact_area_m2"] < left["notch"]["contact_area_m2"] < left["all"]["contact_area_m2"]
        )
        assert left["notch"] == left["turned"]


def test_a_measure_of_ones_own(analysis):
    found = custom_measures(analysis, {"peak": lambda v: v.load.force.sum(axis=1).max(), "none": lambda v: np.nan})
    for side, gait in analysis.feet.items():
        assert found[side]["peak"] == pytest.approx([s["peak_force_N"] for s in gait.steps])
        assert np.isnan(found[side]["none"]).all()


@pytest.mark.parametrize(
    "corners", [[[0, 0], [1, 1]], [[0, 0], [1, 1], [1, 0], [0, 1]], [[0, 0], [100, 0], [100, 100]], "heel"]
)
def test_what_is_no_mask_is_refused(analysis, corners):
    with pytest.raises(InputError, match=r"mask mine(: not numeric| crosses itself, has less than three corners)"):
        mask_measures(analysis, {"mine": corners})


def test_a_measure_that_is_no_number_is_named(analysis):
    with pytest.raises(InputError, match="measure mine of step 1 of the left foot gave 'None'; allowed: a number"):
        custom_measures(analysis, {"mine": lambda view: None})


def test_an_axis_beside_the_print_is_not_drawn(analysis):
    from dataclasses import replace

    print_ = analysis.feet["left"].footprint
    assert print_ is not None
    assert axis_is_inside(print_)
    assert not axis_is_inside(replace(print_, rings=print_.rings + np.array([0.0, 0.08])))
