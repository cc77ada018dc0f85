"""The kernels of perception next to libraries: both give the same."""

import math

import pytest

from plantar.bench.kernels import KERNELS
from plantar.bench.kind import BenchOptions

CASES = {case.key: case for case in KERNELS.cases(BenchOptions(quick=True))}


@pytest.mark.parametrize("kernel", dict.fromkeys(key[0] for key in CASES))
def test_a_kernel_gives_what_the_library_gives(kernel):
    (_, size) = next(key for key in CASES if key[0] == kernel)
    ours, other = CASES[kernel, size].measure()
    assert ours["ours"]
    assert ours["median_us"] > 0.0
    assert other["error"] is None
    if kernel != "percept":  # next to itself without any member
        assert not other["ours"]
        assert ours["error"] < 1e-12


def test_rows_become_a_table_and_a_figure(tmp_path):
    row = {"kernel": "hull + area", "size": "5 active", "route": "plantar", "ours": True, "median_us": 1.0}
    row |= {"spread": 0.1, "ratio": 1.0, "error": 0.0}
    found = KERNELS.find([row, row | {"route": "shapely", "ours": False, "error": None}], BenchOptions())
    assert len(found.tables[0].rows) == len(found.result["results"]) == 2
    assert found.draw is not None
    found.draw(tmp_path / "kernels.png")
    assert (tmp_path / "kernels.png").stat().st_size > 10_000
    assert math.isclose(found.tables[0].rows[0][3], 1.0)
