"""`plantar calibrate` as users call it: files of counts in, a calibrated layout out; and what reads it."""

import json

import numpy as np
import pytest
import typer

from plantar import InputError, Percept, Reading, grid_layout, read, read_layout, write_layout
from plantar.commands.calibrate import calibrate as command
from plantar.formats import ReadOptions, read_recording
from plantar.live import open_live

SOLE = grid_layout([[0, 0], [0.12, 0], [0.12, 0.08], [0, 0.08]], pitch=(0.04, 0.04))
N = len(SOLE)
GAIN = np.linspace(0.06, 0.14, N)  # N per count


def written(path, time, force, more=()) -> str:
    counts = np.round(200.0 + force / GAIN)
    columns = np.hstack([counts, *more])
    names = [f"{side}_{i}" for side in ("left", "right")[: columns.shape[1] // N] for i in range(N)]
    rows = [",".join(map(str, (t, *row))) for t, row in zip(time.round(4), columns.astype(int), strict=True)]
    path.write_text("\n".join([",".join(["time", *names]), *rows]) + "\n")
    return str(path)


@pytest.fixture
def files(tmp_path):
    """Air, and a minute in which one taxel after the other is pressed with a rising and falling force."""
    time = np.arange(1200) / 20.0
    force = 60.0 * np.abs(np.sin(time * np.pi / 2.0))[:, None] * (np.arange(N) == (time // 2.0)[:, None] % N)
    scale = tmp_path / "scale.csv"
    scale.write_text(
        "time,force\n" + "".join(f"{t:.4f},{f:.3f}\n" for t, f in zip(time, force.sum(axis=1), strict=True))
    )
    return {
        "layout": write_layout(SOLE, tmp_path / "sole.json"),
        "zero": [written(tmp_path / "air.csv", time[:40], np.zeros((40, N)))],
        "press": [written(tmp_path / "press.csv", time, force)],
        "scale": [scale],
        "output": tmp_path / "out" / "mine.json",
    }


def test_files_of_counts_become_a_calibrated_layout(files, tmp_path, capsys):
    command(**files, as_json=True)
    found = json.loads(capsys.readouterr().out)
    assert found["soles"]["left"]["gain_error_max"] < 0.02
    layout = read_layout(files["output"])
    assert layout.calibration.gain == pytest.approx(GAIN, rel=0.01)
    assert layout.calibration.date
    assert layout.calibration.method.endswith("pressed by known forces")

    force = np.tile(np.linspace(5.0, 30.0, N), (60, 1))
    path = written(tmp_path / "later.csv", np.arange(60) / 20.0, force)
    converted = read_recording(path, layout=layout, options=ReadOptions(unit="raw"))
    assert not converted.raw
    assert converted.feet["left"].vertical_force == pytest.approx(force.sum(axis=1), rel=0.02)
    assert converted.feet["left"].force[30] == pytest.approx(force[30], rel=0.12)  # crosstalk was not observed
    assert any("by its calibration of" in line for line in converted.warnings)
    assert read(path, options=ReadOptions(unit="raw")).raw

    lines = tmp_path / "lines.csv"
    lines.write_text(
        "".join(f"left,{k / 20},{','.join(map(str, np.round(200.0 + force[0] / GAIN)))}\n" for k in range(5))
    )
    stream = open_live(f"file:{lines}", layout, counts=True)
    side, reading = next(stream.readings)
    stream.close()
    assert side == "left"
    assert reading.force.sum() == pytest.approx(force[0].sum(), rel=0.02)
    assert Percept(layout, Reading(0.0, reading.force)).cop_deviation_in_sole.max() < 1e-3


def test_check_ends_with_exit_code_1_where_gains_changed(files, tmp_path, capsys):
    command(**files)
    time = np.arange(200) / 20.0
    share = np.where(time < 7.0, 1.0, 0.0)[:, None]
    force = 20.0 * share * np.ones(N)
    good = written(tmp_path / "today.csv", time, force)
    command(layout="check", checked=files["output"], recording=good, weight=20.0 * N)
    assert "holds" in capsys.readouterr().out
    with pytest.raises(typer.Exit) as ended:
        command(layout="check", checked=files["output"], recording=good, weight=30.0 * N)
    assert ended.value.exit_code == 1
    assert "the gains changed" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"scale": []}, "1 of --press and 0 of --scale"),
        ({"motion": ["walk.csv"]}, "needs --weight or --mass"),
        ({"weight": 700.0, "mass": 70.0}, "allowed: one of them"),
        ({"weight": -1.0}, "a body of -1 N"),
        ({"checked": "a.json"}, "allowed beside: check"),
        ({"layout": "check"}, "check needs them all"),
    ],
)
def test_options_that_do_not_fit_are_refused(files, given, words):
    with pytest.raises(InputError, match=words):
        command(**(files | given))
    assert not files["output"].exists()
