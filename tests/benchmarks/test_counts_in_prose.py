"""Counts in README and pages are those of the tables."""

import pytest
from counts_in_prose import PAGES, written

ROWS = """case,robot,plant,seed,completed,fell
beam,h1,own,1,True,False
beam,h1,own,2,False,True
beam,hrp2kai,own,1,False,
"""


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_a_page_states_what_its_tables_have(page):
    text = page.read_text(encoding="utf-8")
    assert written(text) == text, "run `python benchmarks/counts_in_prose.py`"


@pytest.mark.parametrize(
    ("rows", "count"),
    [
        ("a.csv: beam", "1 of 3"),
        ("a.csv: beam, h1", "1 of 2"),
        ("a.csv fallen: beam", "1 of 3"),
        ("a.csv not completed: beam, hrp2kai", "1 of 1"),
    ],
)
def test_a_count_is_of_its_rows(tmp_path, rows, count):
    (tmp_path / "a.csv").write_text(ROWS)
    assert (
        written(f"in <!-- {rows} -->7 of 9<!-- . --> walks", tmp_path) == f"in <!-- {rows} -->{count}<!-- . --> walks"
    )


def test_a_policys_rows_are_counted_by_trial(tmp_path):
    rows = "own,h1,beam,0.4,0,True\nown,h1,beam,0.4,1,False\nown,h1,beam,0.2,0,True\n"
    (tmp_path / "a.csv").write_text(f"policy,robot,kind,value,seed,completed\n{rows}")
    assert "1 of 2" in written("<!-- a.csv: own beam 0.4 -->?<!-- . -->", tmp_path)


def test_a_count_of_no_row_is_an_error(tmp_path):
    (tmp_path / "a.csv").write_text(ROWS)
    with pytest.raises(ValueError, match=r"a\.csv has no row of bridge on h1"):
        written("<!-- a.csv: bridge, h1 -->1 of 1<!-- . -->", tmp_path)
