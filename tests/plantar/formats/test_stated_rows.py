"""Rows that a file counts or states, and are lost."""

import numpy as np
import pytest

from plantar.formats import read_recording
from plantar.gait.analysis.analyse import analyse

from .test_table_kinds import LEFT, RIGHT, check, forces, mot


@pytest.mark.parametrize("share", [0.05, 0.2])
def test_rows_that_a_counter_shows_to_be_lost_cost_no_time(tmp_path, share):
    path, random = tmp_path / "walk.forces", np.random.default_rng(0)
    lines = forces().splitlines()
    lines[2] = "SampleRate=100.000\nNumberOfSamples=800"
    kept = [x for x in lines[4:] if random.random() > share]
    path.write_text("\n".join([*lines[:4], *kept]) + "\n")
    found = analyse(path)
    check(found)
    lost = 800 - len(kept)
    assert any(f"{lost} of 800 rows" in w or f"{lost - 1} of 799 rows" in w for w in found.warnings)
    assert found.metrics["gait"]["implied_weight_N"] == pytest.approx(float(LEFT.mean() + RIGHT.mean()), rel=0.05)


@pytest.mark.parametrize("statement", ["nRows=800", "datarows 800", "NumberOfSamples=800"])
def test_a_stated_number_of_rows_has_to_hold(tmp_path, statement):
    path = tmp_path / "walk.mot"
    lines = mot().replace("nRows=800", statement).splitlines()
    path.write_text("\n".join(lines) + "\n")
    assert not any("the file states" in w for w in read_recording(path).warnings)
    path.write_text("\n".join(lines[:-200]) + "\n")
    (told,) = [w for w in read_recording(path).warnings if "the file states" in w]
    assert "states 800 rows" in told
    assert "holds 600: 25 % are lost" in told
