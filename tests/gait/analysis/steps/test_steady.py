"""Which steps are in the means, and what is said of the others."""

from dataclasses import replace

import numpy as np
import pytest

from plantar import InputError
from plantar.gait.analysis.options import AnalysisOptions, steps_of_text
from plantar.gait.analysis.parameters import analyse_feet
from plantar.gait.analysis.steps.steady import with_used_steps
from plantar.gait.analysis.summary import summary_of_foot

from ..walks import made_walk


def test_steps_that_start_and_stop_a_walk_are_not_in_its_means():
    """Of 9 steps the first and the last are twice as long."""
    recording = made_walk(slow_ends=1.6, rate=50.0).recording
    steady = analyse_feet(recording)["left"]
    everything = analyse_feet(recording, options=AnalysisOptions(steps="all"))["left"]
    assert [s.number for s in steady.used] == [2, 3, 4, 5, 6, 7, 8]
    assert len(steady.steps) == len(everything.used) == 9
    contact, all_contact = (summary_of_foot(g)["contact_time_s"] for g in (steady, everything))
    assert contact.mean == pytest.approx(0.62 * 1.1, rel=0.06)
    assert contact.sd < 0.01
    assert all_contact.mean > 1.1 * contact.mean
    assert all_contact.median == pytest.approx(contact.median, rel=0.02)
    assert any("steady walking of the left foot is steps 2-8: 1, 9 start or stop" in w for w in steady.warnings)
    # On a plate no step starts a walk, and four steps do not show what is usual.
    few = replace(everything, steps=everything.steps[:4])
    for gait, kind in ((everything, "platform"), (few, "robot")):
        assert len(with_used_steps(gait, AnalysisOptions(), kind).used) == len(gait.steps)


def test_an_odd_step_within_the_walk_is_said_and_stays():
    gains = np.ones(14)
    gains[6] = 1.5
    gait = analyse_feet(made_walk(strides=14, rate=50.0, gains=gains.tolist()).recording)["right"]
    assert len(gait.used) == 14
    assert "peak force" in gait.steps[6].odd
    assert [w for w in gait.warnings if "in the means" in w] == [
        f"step 7 of the right foot is odd and in the means: {gait.steps[6].odd}"
    ]


@pytest.mark.parametrize("seed", range(2))
def test_an_even_walk_keeps_every_step(seed):
    gains = np.random.default_rng(seed).normal(1.0, 0.05, 20)
    feet = analyse_feet(made_walk(strides=20, rate=50.0, gains=gains.tolist(), noise=1.0, seed=seed).recording)
    assert [len(g.used) for g in feet.values()] == [20, 20]


def test_steps_by_number_and_by_time():
    recording = made_walk(strides=16, rate=50.0).recording
    some = analyse_feet(recording, options=AnalysisOptions(steps=(3, 14)))["left"]
    assert [s.number for s in some.used] == list(range(3, 15))
    late = analyse_feet(recording, options=AnalysisOptions(begin=5.0, end=12.0))["left"]
    assert min(s.heel_strike_s for s in late.used) >= 5.0
    assert max(s.toe_off_s for s in late.used) <= 12.0
    assert any("fewer than 12 a foot" in w for w in late.warnings)
    none = analyse_feet(recording, options=AnalysisOptions(steps=(30, 40)))["left"]
    assert none.used == ()
    assert any("no step of the left foot is among those that were asked for: it has 16" in w for w in none.warnings)


@pytest.mark.parametrize("text", ["0-3", "5-2", "a", "3-", "-1"])
def test_what_names_no_steps_is_refused(text):
    with pytest.raises(InputError, match="allowed: a number or a range such as 3-14"):
        steps_of_text(text)


def test_options_that_contradict_are_refused():
    with pytest.raises(InputError, match="--from 5 is not before --to 2"):
        AnalysisOptions(begin=5.0, end=2.0)
    with pytest.raises(InputError, match="--baseline is 'none'; allowed: auto, keep"):
        AnalysisOptions(baseline="none")
