"""The footscan reader, on exports with plates, delimiters, rates and damages of every kind."""

from pathlib import Path

import numpy as np
import pytest

from plantar import FormatError
from plantar.formats import detect_format, read_recording
from plantar.formats.format import ReadOptions
from plantar.gait.analysis.analyse import analyse

from .corruption import survive_corruption


def export(path: Path, frames: np.ndarray, *, delimiter: str = "\t", period: float = 12.5, comma: bool = False) -> None:
    """Write forces in N (n, rows, columns), the first row of the matrix the hind one."""
    lines = ["footscan entire plate roll off", ""]
    for i, frame in enumerate(frames):
        lines.append(f"Frame {i} ({i * period:g} ms)")
        lines += [delimiter.join(f"{v:.1f}".replace(".", "," if comma else ".") for v in row) for row in frame] + [""]
    path.write_text("\r\n".join(lines))


@pytest.fixture
def frames():
    """A foot of 24 x 12 cells that is rolled over from its hind rows to its front ones on a plate of 48 x 64."""
    out = np.zeros((60, 48, 64))
    for i in range(6, 54):
        share = (i - 6) / 48
        row = np.arange(24)[:, None]
        load = np.exp(-(((row - 2 - 20 * share) / 4.0) ** 2)) * np.ones(12)
        out[i, 10:34, 30:42] = np.round(700.0 * np.sin(np.pi * share) ** 0.5 * load / load.sum(), 1)
    return out


@pytest.mark.parametrize(("delimiter", "comma"), [("\t", False), (";", True), (",", False)])
def test_a_plate(tmp_path, frames, delimiter, comma):
    path = tmp_path / "walk_left.txt"
    export(path, frames, delimiter=delimiter, comma=comma)
    assert detect_format(path).name == "footscan"
    recording = read_recording(path)
    foot = recording.feet["left"]
    assert (recording.kind, recording.grid, recording.raw) == ("platform", (48, 64), False)
    assert recording.rate_hz == pytest.approx(80.0)
    assert foot.vertical_force == pytest.approx(np.round(frames, 1).sum(axis=(1, 2)))
    assert foot.layout.areas == pytest.approx(5.08e-3 * 7.62e-3)
    cop = foot.center_of_pressure(20.0)
    assert cop[40, 0] > cop[20, 0]  # the hind rows come first in the file
    assert 0.0 < 32 * 5.08e-3 - 30 * 5.08e-3 - cop[30, 1] < 12 * 5.08e-3  # columns from the left


def test_a_step_is_measured(tmp_path, frames):
    """Contact time, impulse and length of the foot are those of what was written."""
    path = tmp_path / "walk.txt"
    export(path, frames)
    walk = analyse(path, options=ReadOptions(side="left"))
    (step,) = walk.feet["left"].steps
    force = frames.sum(axis=(1, 2))
    assert step["impulse_Ns"] == pytest.approx(force.sum() * 12.5e-3, rel=0.01)
    assert step["contact_time_s"] == pytest.approx(48 * 12.5e-3, abs=25e-3)
    assert step["peak_pressure_Pa"] == pytest.approx(frames.max() / (5.08e-3 * 7.62e-3), rel=1e-6)
    assert step["foot_length_m"] == pytest.approx(24 * 7.62e-3, rel=0.1)


def test_a_plate_that_is_walked_across_its_rows(tmp_path, frames):
    """64 rows of 48 cells: the cells' long side goes with the columns."""
    path = tmp_path / "walk.txt"
    export(path, frames.transpose(0, 2, 1))
    layout = read_recording(path).feet["left"].layout
    assert np.ptp(layout.outline, axis=0) == pytest.approx([64 * 5.08e-3, 48 * 7.62e-3])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda t: t.replace("Frame 1 (12.5 ms)", "Frame 1 (0 ms)"), "times in ms do not rise"),
        (lambda t: t.replace("Frame 0 (0 ms)", "Frame 0 (1.2.3 ms)"), r"'1.2.3' ms of frame 0 is no number"),
        (lambda t: t[: t.index("Frame 0 (0 ms)") + 15], "0 x 0 cells cannot be read"),
        (lambda t: t[: t.index("Frame 1")], "holds one frame"),
    ],
)
def test_damaged_files_are_named(tmp_path, frames, change, message):
    path = tmp_path / "walk.txt"
    export(path, frames[:5])
    path.write_text(change(path.read_text()))
    with pytest.raises(FormatError, match=message):
        read_recording(path)


def test_excel_files_are_told_what_to_do(tmp_path):
    path = tmp_path / "walk.xls"
    path.write_bytes(b"\xd0\xcf\x11\xe0" + bytes(600))
    with pytest.raises(FormatError, match="a binary Excel file; save it as text"):
        read_recording(path, "footscan")


def test_random_damage(tmp_path, frames):
    path = tmp_path / "walk.txt"
    export(path, frames[20:32, 8:36, 28:44])
    assert survive_corruption(path, trials=30) > 5 / 30
