"""Tables drawn by seeds: each is read right, or what was assumed is stated."""

import re
from pathlib import Path

import numpy as np
import pytest

from plantar import FormatError
from plantar.gait.analysis.analyse import analyse

from .made_tables import Table, made_table

LONG = [pytest.param(seed, marks=pytest.mark.long) for seed in range(24, 324)]


@pytest.mark.sample(16)
@pytest.mark.parametrize("seed", [*range(24), *LONG])
@pytest.mark.parametrize("hard", [False, True])
def test_made_tables_are_right(tmp_path, seed, hard):
    path = tmp_path / "walk.csv"
    made = made_table(seed, path, hard)
    nameless = made.twist == "no names" and made.kind == "cells"
    columns = _pasted(path) if nameless else None
    walk = analyse(path, columns=columns)
    assert sorted(walk.feet) == sorted(made.sides), made.note
    assert walk.metrics["activity"]["name"] == "walking"
    if made.cells:
        assert {foot.force.shape[1] for foot in walk.recording.feet.values()} == {made.cells}
    gait = walk.metrics["gait"]
    assert gait["cadence_steps_per_min"] == pytest.approx(120.0 / made.period, rel=0.003)
    if len(made.sides) == 2:
        both = 100.0 * (2.0 * made.stance / made.period - 1.0)
        assert gait["double_support_percent"] == pytest.approx(both, abs=3.0)
    for side in made.sides:
        _check_foot(walk.feet[side].steps, made, side, nameless)
    assert walk.recording.raw == (made.raw or made.relative or nameless)


def _pasted(path: Path) -> str:
    """The map of columns that the refusal of a table without names prints."""
    with pytest.raises(FormatError, match=r"have no names") as refused:
        analyse(path)
    found = re.search(r'--columns "([^"]+)"', str(refused.value))
    assert found is not None
    return found[1]


def _check_foot(steps: tuple[object, ...], made: Table, side: str, either: bool) -> None:
    """Steps of a foot; without names the first columns may be either foot's."""
    begins = np.concatenate(list(made.begins.values())) if either else made.begins[side]
    assert abs(len(steps) - len(made.begins[side])) <= 1, made.note
    assert min(abs(steps[0].heel_strike_s - b) for b in begins) < 0.02
    assert np.median([s["contact_time_s"] for s in steps]) == pytest.approx(made.stance, abs=0.015)
    if not made.raw and not either:
        weight = 100.0 / (made.mass * 9.80665) if made.relative else 1.0
        peak = np.median([s["peak_force_N"] for s in steps])
        assert peak == pytest.approx(weight * made.force[side].max(), rel=0.01), made.note
