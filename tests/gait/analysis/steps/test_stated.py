"""Events that a file states: read, shown beside ours, and used."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from plantar import FormatError, InputError
from plantar.formats.stated_events import read_events
from plantar.gait.analysis.options import AnalysisOptions
from plantar.gait.analysis.parameters import analyse_feet
from plantar.gait.analysis.steps.stated import stated_beside_own, stated_contacts
from plantar.recordings.pressure_recording import StatedEvents

from ..walks import made_walk


def test_stated_events_are_used_and_shown(tmp_path: Path) -> None:
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


def test_contacts_that_the_recording_cuts() -> None:
    time = np.arange(500) * 0.01
    contacts = stated_contacts(time, StatedEvents(np.array([1.0, 2.1, 4.5]), np.array([0.4, 1.7, 2.8])))
    assert [(c.heel_strike, c.toe_off) for c in contacts] == [(None, 0.4), (1.0, 1.7), (2.1, 2.8), (4.5, None)]
    assert contacts[-1].end == 500


def test_what_holds_no_events_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "events.csv"
    for content in (b"", b"PK\x03\x04nothing", b"a,b\n1,2\n", b"side,heel_strike_s,toe_off_s\nnone,1,2\n"):
        path.write_bytes(content or b"\n")
        with pytest.raises(FormatError, match="no events; allowed: a Moticon report"):
            read_events(path)


def test_our_events_are_within_20_and_35_ms_of_a_vendors(real_data: Path) -> None:
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
