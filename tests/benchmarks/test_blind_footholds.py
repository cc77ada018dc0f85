"""The order in which the rows of the foothold benchmark are counted, and their page."""

from collections import Counter

import blind_footholds
import pytest
from blind_footholds import count, page, wanted

from plantar.sim.bench.footholds.foothold_run import TRIALS


def test_whatever_time_allows_is_even_among_trials_and_policies():
    cases = [case.key for case in wanted(10, 3)]
    assert len(cases) == len(set(cases)) == len(TRIALS) * (10 + 3 * 3)
    first = Counter(key[0] for key in cases[: len(cases) // 2])
    assert 2.5 < first["plantar"] / first["ankles"] < 4.5
    assert len({key[2:4] for key in cases[: len(TRIALS)]}) == len(TRIALS)


def test_a_table_goes_on_and_is_of_one_commit(tmp_path, monkeypatch):
    monkeypatch.setattr(blind_footholds, "TABLE", tmp_path / "a.csv")
    flat = [case for case in wanted(1, 1) if case.key[2] == "flat" and case.key[0] in ("zero", "plantar")]
    count(iter(flat[:1]), 1.0, "one")
    count(iter(flat), 1.0, "one")
    assert (tmp_path / "a.csv").read_text().count("flat") == 2
    assert "1 runs of `zero`, 1 runs of `plantar`" in page()
    assert page().index("| zero |") < page().index("| plantar |")
    with pytest.raises(SystemExit, match="rows of one, not of two"):
        count(iter(flat), 1.0, "two")
