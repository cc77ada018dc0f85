"""Tables that a spreadsheet shows as they are."""

import csv
import io
import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from plantar.common.table_writer import csv_row, csv_text, mapping_rows, original_cell

SOURCE = Path(__file__).parents[3] / "plantar"


@given(st.lists(st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0\r")), min_size=1))
def test_no_cell_is_a_formula_and_each_is_read_back(cells):
    (row,) = csv.reader(io.StringIO(csv_row(cells), newline=""))
    for cell in row:
        assert not cell.startswith(("=", "@", "\t", "\r"))
        assert not cell.startswith(("+", "-")) or float(cell) is not None
    assert [original_cell(cell) for cell in row] == cells


@pytest.mark.parametrize("value", ["=1+1", "+SUM(A1)", "-cmd|' /C calc'!A0", "@x", "\tx", "\n=1", "-1_000"])
def test_a_formula_is_written_as_text(value):
    ((cell,),) = csv.reader(io.StringIO(csv_row([value]), newline=""))
    assert cell == f"'{value}"


def test_numbers_stay_numbers_and_what_is_not_known_is_empty():
    text = csv_text(["=a", "b"], mapping_rows(["a", "b"], [{"a": -0.5, "b": "-2e-3"}, {"b": float("nan")}]))
    assert text == "'=a,b\n-0.5,-2e-3\n,\n"


def test_no_module_writes_tables_another_way():
    other = [p for p in SOURCE.rglob("*.py") if re.search(r"csv\.(writer|DictWriter)", p.read_text(encoding="utf-8"))]
    assert [p.name for p in other if p.parent.name != "bench" or "sim" in p.parts] == ["table_writer.py"]
