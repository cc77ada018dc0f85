"""Rows of steps that are left in files: read again, and written with those of others, as rows in memory are."""

from pathlib import Path

import hypothesis.strategies as st
import numpy as np
from hypothesis import given

from plantar.gait.analysis.study.one_recording import RecordingResult, read_result, write_result
from plantar.gait.analysis.study.participants import Participation
from plantar.gait.analysis.study.stored_steps import write_steps

NUMBERS = st.none() | st.integers(-(10**9), 10**9) | st.floats(allow_nan=False, allow_infinity=False)
NOTES = st.text(st.sampled_from("ab ,;\"'=+-@\n"), max_size=8)
ROWS = st.lists(
    st.fixed_dictionaries(
        {"side": st.sampled_from(["left", "right"]), "step": st.integers(1, 99), "note": NOTES},
        optional={"arch_index": NUMBERS, "toes.peak_force_N": NUMBERS},
    ),
    max_size=5,
)


def stored(rows, path: Path) -> RecordingResult:
    who = Participation("a.asc", "a")
    sole = {"left": np.zeros((36, 14))}
    result = RecordingResult(who, "", "key", "pedar", "", False, rows, {}, {}, sole, (), {})
    return write_result(result, path)


@given(ROWS)
def test_stored_rows_are_those_that_were_stored(tmp_path_factory, rows):
    path = tmp_path_factory.mktemp("kept") / "a.npz"
    names = {name: None for row in rows for name in row}
    for result in (stored(rows, path), read_result(path, "key")):
        assert list(result.rows) == [{name: row.get(name) for name in names} for row in rows]
        assert len(result.rows) == len(rows)


@given(ROWS, ROWS)
def test_a_table_of_stored_rows_is_that_of_rows_in_memory(tmp_path_factory, a, b):
    folder = tmp_path_factory.mktemp("kept")
    names = ["recording", *{name: None for row in (*a, *b) for name in row}, "format"]
    before = [{"recording": "=1+1, a.asc"}, {"recording": "b.asc"}]
    after = {"format": "pedar"}
    kept = [stored(a, folder / "a.npz").rows, stored(b, folder / "b.npz").rows]
    texts = [
        write_steps(folder / f"{number}.csv", names, zip(before, rows, [after, after], strict=True)).read_bytes()
        for number, rows in enumerate(([a, b], kept))
    ]
    assert texts[0] == texts[1]
