"""Tables of a paper: their numbers are those of the comparison, rounded, and standard deviations are the samples'."""

import re

import numpy as np
import pytest

from plantar.gait.analysis.study.compare_conditions import Comparison
from plantar.gait.analysis.study.paper_table import paper_text
from plantar.gait.analysis.study.statistics import effect_of

A = np.array([310e3, 290e3, 305e3, 320e3])
B = np.array([250e3, 262e3, 240e3, 255e3])


@pytest.fixture
def comparison() -> Comparison:
    effects = {
        "peak_pressure_Pa": effect_of(A, B, True, 0.125, 0.25),
        "heel.peak_pressure_Pa": effect_of(A, B, True, 0.0004, 0.03),
        "midfoot.peak_pressure_Pa": effect_of(A, B, True, 0.4, 0.9),
    }
    return Comparison("flat|shoe", "*rocker*", True, effects, levels=("flat|shoe", "*rocker*"))


def test_a_row_has_means_deviations_and_intervals(comparison):
    text = paper_text([comparison])
    row = next(line for line in text.splitlines() if line.startswith("| Peak pressure (kPa)"))
    cells = [cell.strip() for cell in row.strip("|").split("|")]
    assert cells[1:3] == [
        f"{A.mean() / 1e3:.0f} ({A.std(ddof=1) / 1e3:.0f})",
        f"{B.mean() / 1e3:.0f} ({B.std(ddof=1) / 1e3:.1f})",
    ]
    effect = comparison.effects["peak_pressure_Pa"]
    shown = [float(v.replace("−", "-")) for v in re.findall(r"[−\d.]+", cells[3])]
    assert shown == pytest.approx([1e-3 * v for v in (effect.difference, effect.low, effect.high)], rel=5e-3)
    assert cells[5:] == ["0.125", "0.250"]


def test_regions_are_listed_where_they_differ_and_names_break_no_table(comparison):
    text = paper_text([comparison])
    assert "Heel: peak pressure (kPa)" in text
    assert "Midfoot" not in text
    assert "< 0.001" in text
    assert "flat/shoe, mean (SD) | rocker, mean (SD)" in text
    assert len({line.count("|") for line in text.splitlines() if line.startswith("|")}) == 1
    assert "within participants" in text
    assert "all 3 measures" in text


def test_without_a_comparison_it_says_so():
    assert paper_text([Comparison("a", "b", False, {}, note="too few")]) == "No two conditions were compared.\n"
