"""Takes: counts and loads that fit together, from files too."""

from dataclasses import replace

import numpy as np
import pytest

from plantar import FormatError, InputError, grid_layout
from plantar.calibration import Take, read_take
from plantar.layouts.calibration import SoleCalibration
from plantar.recordings.recorder import Recorder

TIME = np.arange(20) / 100
SOLE = grid_layout([[0, 0], [0.08, 0], [0.08, 0.04], [0, 0.04]], pitch=(0.04, 0.04))


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"kind": "jump"}, "allowed: zero, press, motion"),
        ({"time": TIME[::-1]}, "times do not rise"),
        ({"time": TIME[:5], "counts": {"left": np.ones((5, 3))}}, "5 frames; allowed: 10 or more"),
        ({"counts": {"left": np.ones((19, 3))}}, r"shape \(19, 3\)"),
        ({"counts": {}}, "holds no sole"),
        ({"load": None}, "needs a load"),
        ({"load": -3.0}, "no force above 0 N"),
        ({"load": np.ones(3)}, "load"),
        ({"cop": {"right": np.zeros((20, 2))}}, "no counts"),
        ({"cop": {"left": np.full((20, 2), 12.0)}}, "more than 1 m"),
    ],
)
def test_what_does_not_fit_is_refused(given, words):
    usual = {"kind": "press", "time": TIME, "counts": {"left": np.ones((20, 3))}, "load": 5.0}
    with pytest.raises(InputError, match=words):
        Take(**(usual | given))


def table(path, columns: str, rows) -> str:
    path.write_text("\n".join([columns, *(",".join(map(str, row)) for row in rows)]) + "\n")
    return str(path)


def test_a_reference_is_put_on_the_times_of_the_counts(tmp_path):
    counts = table(tmp_path / "walk.csv", "time,left_0,left_1,left_2", [(k / 100, 100 + k, 7, 9) for k in range(300)])
    rows = [(0.5, 100.0, 0.01, ""), (2.5, 300.0, 0.03, "")]
    take = read_take("motion", counts, reference=table(tmp_path / "ref.csv", "time,force,left_x,left_y", rows))
    assert take.counts["left"][3].tolist() == [103.0, 7.0, 9.0]
    assert take.load[150] == pytest.approx(200.0)
    assert np.isnan(take.load[0])
    assert take.cop["left"][150] == pytest.approx([0.02, np.nan], nan_ok=True)
    assert read_take("motion", counts, 700.0).load[0] == 700.0
    with pytest.raises(InputError, match="columns are time, newton"):
        read_take("press", counts, reference=table(tmp_path / "bad.csv", "time,newton", rows))
    with pytest.raises(InputError, match="weight and a reference"):
        read_take("motion", counts, 700.0, tmp_path / "ref.csv")


def test_counts_stay_counts_where_the_layout_is_calibrated_and_newtons_are_no_counts(tmp_path):
    """A recording holds its layout, whose calibration would make newtons of counts, or once more of newtons."""
    known = SoleCalibration.linear(0.5 * np.ones(len(SOLE)), 100.0 * np.ones(len(SOLE)))
    layout = replace(SOLE, calibrations={"left": known})
    counts = np.arange(100.0, 120.0)[:, None] * np.ones(len(SOLE))
    for unit in ("counts", "N"):
        with Recorder(tmp_path / f"{unit}.mcap", {"unit": unit}, {"left": layout}) as recorder:
            skin = recorder.channel("/skin/left", [("force", len(SOLE))])
            for t, row in zip(TIME, counts, strict=True):
                skin.write(t, row)
    assert read_take("zero", tmp_path / "counts.mcap").counts["left"].tolist() == counts.tolist()
    with pytest.raises(FormatError, match="which holds forces in N"):
        read_take("zero", tmp_path / "N.mcap")
