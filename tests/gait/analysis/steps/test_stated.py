"""Events that a file states: read, shown beside ours, and used."""

import time
from dataclasses import replace

import numpy as np
import pytest

from plantar import FormatError, InputError
from plantar.formats.stated_events import read_events
from plantar.gait.analysis.options import AnalysisOptions
from plantar.gait.analysis.parameters import analyse_feet
from plantar.gait.analysis.steps.stated import stated_beside_own, stated_contacts
from plantar.recordings.pressure_recording import StatedEvents

from ....event_report import write_report
from ....plantar.formats.corruption import refusals
from ..walks import made_walk


def test_stated_events_are_used_and_shown(tmp_path):
    made = made_walk()
    path = tmp_path / "events.csv"
    rows = [
        f"{side},{a + 0.02},{b - 0.01}"
        for side in made.strikes
        for a, b in zip(made.strikes[side], made.lifts[side], strict=True)
    ]
    path.write_text("side,heel_strike_s,toe_off_s\n" + "\n".join(rows) + "\n")
    recording = replace(made.recording, events=read_events(path))
    own = analyse_feet(recording)
    used = analyse_feet(recording, options=AnalysisOptions(events="vendor"))
    for side in own:
        assert [s.heel_strike_s for s in used[side].steps] == pytest.approx((made.strikes[side] + 0.02).tolist())
        assert [s["contact_time_s"] for s in used[side].steps] == pytest.approx([0.62 * 1.1 - 0.03] * 9)
        beside = stated_beside_own(recording.events[side], own[side])
        assert beside is not None
        found = np.array([s.heel_strike_s for s in own[side].steps]) - made.strikes[side] - 0.02
        assert beside["heel_strike_difference_s"] == pytest.approx(found.tolist())
    with pytest.raises(InputError, match="states no events of left and right"):
        analyse_feet(made.recording, options=AnalysisOptions(events="vendor"))


def test_contacts_that_the_recording_cuts():
    time = np.arange(500) * 0.01
    contacts = stated_contacts(time, StatedEvents(np.array([1.0, 2.1, 4.5]), np.array([0.4, 1.7, 2.8])))
    assert [(c.heel_strike, c.toe_off) for c in contacts] == [(None, 0.4), (1.0, 1.7), (2.1, 2.8), (4.5, None)]
    assert contacts[-1].end == 500


def test_toe_offs_without_heel_strikes_make_no_contact():
    assert stated_contacts(np.arange(500) * 0.01, StatedEvents(np.zeros(0), np.array([0.4]))) == []


def test_what_holds_no_events_is_refused(tmp_path):
    path = tmp_path / "events.csv"
    for content in (b"", b"PK\x03\x04nothing", b"a,b\n1,2\n", b"side,heel_strike_s,toe_off_s\nnone,1,2\n"):
        path.write_bytes(content or b"\n")
        with pytest.raises(FormatError, match=r"no events|not an archive"):
            read_events(path)


def test_a_report_and_a_table_of_any_encoding_are_read(tmp_path):
    found = read_events(write_report(tmp_path / "a.xlsx", ["Left Steps", "Right Steps", "Summary"]))
    assert found["left"].heel_strikes.tolist() == [1.0, 2.0, 3.0]
    assert found["right"].toe_offs.tolist() == [1.6, 2.6, 3.6]
    text = "side;heel_strike_s;toe_off_s\nleft;1,0;1,6\nright;1,5;\n" + "left;2;2.6\n" * 20
    for encoding in ("utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "latin-1"):
        (tmp_path / "a.csv").write_bytes(text.encode(encoding))
        found = read_events(tmp_path / "a.csv")
        assert (found["left"].heel_strikes[0], found["left"].toe_offs[0]) == (1.0, 1.6)
        assert found["right"].toe_offs.tolist() == []


@pytest.mark.parametrize("text", ["up,1,2\n", "left,one,2\n", "left,1,x\n", 'left,"1\n', "left,1,2\0\n"])
def test_a_row_that_cannot_be_meant_is_refused(text, tmp_path):
    (tmp_path / "a.csv").write_text("side,heel_strike_s,toe_off_s\nleft,1,1.6\n" + text)
    with pytest.raises(FormatError, match=r"a\.csv"):
        read_events(tmp_path / "a.csv")


@pytest.mark.parametrize(
    ("rows", "line"),
    [
        ([(1.0, 0.3), (2.1, 1.4)], 2),  # the columns are exchanged
        ([(0.3, 0.9), (1.4, 1.4)], 3),
        ([(0.3, 1.6), (1.4, 2.7), (2.5, 3.8)], 3),  # overlapping
        ([(0.3, 0.9), (1.4, 2.0), (1.5, 1.9)], 4),
        ([(2.5, 3.1), (0.3, 2.6)], 2),
        ([(0.3, 2.0), (1.4, "")], 3),
    ],
)
def test_contacts_out_of_order_are_refused(rows, line, tmp_path):
    (tmp_path / "a.csv").write_text("side,heel_strike_s,toe_off_s\n" + "".join(f"left,{a},{b}\n" for a, b in rows))
    with pytest.raises(FormatError, match=rf"a\.csv, line {line}: the left foot lands .*; allowed: each toe off after"):
        read_events(tmp_path / "a.csv")


@pytest.mark.parametrize("rows", [[(2.5, 3.1), (0.3, 0.9), (0.3, 0.9)], [("", 0.9), (2.5, 3.1), (0.3, "")]])
def test_rows_in_any_order_are_the_same_events(rows, tmp_path):
    (tmp_path / "a.csv").write_text("side,heel_strike_s,toe_off_s\n" + "".join(f"left,{a},{b}\n" for a, b in rows))
    found = read_events(tmp_path / "a.csv")["left"]
    assert (found.heel_strikes.tolist(), found.toe_offs.tolist()) == ([0.3, 2.5], [0.9, 3.1])


def test_reports_that_grow_are_refused_at_once(tmp_path):
    files = [
        write_report(tmp_path / "sheets.xlsx", ["Left Steps"] * 3000, rows=0),
        write_report(tmp_path / "rows.xlsx", ["Left Steps"], rows=150_000),
        write_report(tmp_path / "entities.xlsx", ["Left Steps"], head='<!DOCTYPE a [<!ENTITY b "c">]>'),
        write_report(tmp_path / "deep.xlsx", ["Left Steps"], head="<a>" * 1000),
    ]
    (tmp_path / "cut.xlsx").write_bytes(files[1].read_bytes()[:5000])
    begun = time.process_time()
    for file in (*files, tmp_path / "cut.xlsx"):
        with pytest.raises(FormatError):
            read_events(file)
    assert time.process_time() - begun < 5.0


def test_no_damage_of_a_report_or_table_traces_back(tmp_path, share):
    good = write_report(tmp_path / "a.xlsx", ["Left Steps", "Right Steps"]).read_bytes()
    table = b"side,heel_strike_s,toe_off_s\n" + b"left,1,1.6\nright,1.5,2.1\n" * 5
    path = tmp_path / "b"
    for whole in (good, table, table.decode().encode("utf-16")):
        path.write_bytes(whole)
        refusals(path, round(200 * share), read_events, seed=7)


def test_our_events_are_within_20_and_35_ms_of_a_vendors(real_data):
    from plantar.formats import read_recording

    folder = real_data / "recordings"
    for report in sorted(folder.glob("*_report.xlsx")):
        recording = read_recording(folder / report.name.replace("_report.xlsx", ".txt"))
        recording = replace(recording, events=read_events(report))
        for side, gait in analyse_feet(recording).items():
            beside = stated_beside_own(recording.events[side], gait)
            assert beside is not None
            assert max(abs(d) for d in beside["heel_strike_difference_s"]) < 0.020
            assert max(abs(d) for d in beside["toe_off_difference_s"]) < 0.035
