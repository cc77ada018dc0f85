"""Measures beside another package's definitions: every difference above 1 % has its causes, which add up."""

import importlib.util
import re
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[2] / "benchmarks" / "pressure_definitions.py"


@pytest.mark.parametrize("name", ["emed_step.lst", "fscan_walk_left.asf"])
def test_causes_make_up_the_difference(real_data, name):
    specification = importlib.util.spec_from_file_location("pressure_definitions", SOURCE)
    assert specification is not None
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    rows = module.rows_of(real_data / "recordings" / name)
    assert len(rows) == len(module.ROWS)
    for row in rows:
        difference = float(row[7].rstrip(" %"))
        causes = [float(share) for share in re.findall(r"([+-][\d.]+) %:", row[8])]
        assert bool(causes) == (abs(float(row[6]) / float(row[4]) - 1.0) > 0.01), row
        if causes:
            assert sum(causes) == pytest.approx(difference, abs=0.6), row
