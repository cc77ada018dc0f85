"""loadsol exports with zones: made with the names of the app's, and other numbers."""

import numpy as np
import pytest

from plantar import FormatError
from plantar.formats import detect_format, read_recording
from plantar.gait.analysis.analyse import analyse

from .test_table_kinds import LEFT, RIGHT, TIME, check


def export(path, lost=(), zones=("heel", "medial", "lateral"), total=1.0):
    shares = [0.5, 0.3, 0.2][: len(zones)]
    names, units, columns = [], [], []
    for sensor, force in (("PGV9-L", LEFT), ("PGV4-R", RIGHT)):
        names += ["", *(f"{sensor}::{z}" for z in zones), sensor, "", f"{sensor}::xAcc", f"{sensor}::xGyro"]
        units += ["Time[secs]", *["Force[N]"] * (len(zones) + 1), "Time[secs]", "[g]", "[rad/s]"]
        own = [np.round(force * share / sum(shares), 1) for share in shares]
        columns += [TIME, *own, total * sum(own), TIME, 0.1 * np.sin(TIME), 0.1 * np.cos(TIME)]
    table = np.column_stack(columns)
    for i in lost:
        table[i, 1 : 1 + len(zones)], table[i, 1 + len(zones)] = -1.0, 0.0
    lines = ["loadapp.loadflux", "comment", "\t".join(names), "\t".join(units) + "\t"]
    path.write_text("\n".join([*lines, *("\t".join(f"{v:.3f}" for v in row) + "\t\t" for row in table)]) + "\n")


@pytest.mark.parametrize("zones", [("heel",), ("medial", "heel"), ("heel", "medial", "lateral")])
def test_zones_are_cells_and_their_total_is_the_force(tmp_path, zones):
    path = tmp_path / "walk.txt"
    export(path, zones=zones)
    assert detect_format(path).name == "loadsol"
    walk = analyse(path)
    check(walk)
    assert walk.recording.feet["left"].force.shape[1] == len(zones)
    assert walk.recording.metadata["zones"]["right"] == list(zones)


def test_an_export_between_commas_is_the_same(tmp_path):
    export(tmp_path / "walk.txt")
    text = (tmp_path / "walk.txt").read_text().replace("\t", ",")
    (tmp_path / "walk.csv").write_text(text)
    assert detect_format(tmp_path / "walk.csv").name == "loadsol"
    check(analyse(tmp_path / "walk.csv"))


def test_frames_that_did_not_arrive_were_not_measured(tmp_path):
    path = tmp_path / "walk.txt"
    export(path, lost=range(100, 800, 20))
    recording = read_recording(path)
    assert np.isnan(recording.feet["left"].vertical_force).sum() == 35
    assert np.isfinite(recording.feet["right"].vertical_force).all()
    assert any("35 of 800 frames of the left insole" in w for w in recording.warnings)


def test_a_total_that_is_not_the_zones_sum_is_reported(tmp_path):
    path = tmp_path / "walk.txt"
    export(path, total=0.9)
    assert sum("differs from the sum" in w for w in read_recording(path).warnings) == 2


def test_an_export_without_totals_is_refused(tmp_path):
    path = tmp_path / "walk.txt"
    export(path)
    path.write_text(path.read_text().replace("\tPGV9-L\t", "\tx\t").replace("\tPGV4-R\t", "\tx\t"))
    with pytest.raises(FormatError, match="no insole has zones and a total"):
        read_recording(path)
