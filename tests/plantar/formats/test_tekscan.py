"""The Tekscan reader, on exports of every kind that the format allows."""

from pathlib import Path

import numpy as np
import pytest

from plantar import FormatError
from plantar.formats import detect_format, read_recording
from plantar.formats.format import ReadOptions

from .corruption import survive_corruption


def export(
    path: Path,
    frames: np.ndarray,
    *,
    unit: str | None = "KPa",
    spacing: tuple[str, str] | None = ("5.08 mm", "5.08 mm"),
    area: str | None = "25.8064 mm2",
    period: float | None = 0.01,
    end: str = "\r\n",
    delimiter: str = ",",
    comma: bool = False,
    name: str = "walk_left.fsx",
    numbers: list[int] | None = None,
    sizes: bool = True,
    separator: str = " ",
) -> None:
    """Write readings (n, rows, columns), NaN for places without a cell."""
    head = [f"DATA_TYPE{separator}MOVIE", f"VERSION{separator}Tekscan Pressure Measurement System 6.33"]
    head += [f"FILENAME{separator}{name}", f"SENSOR_TYPE{separator}FSCAN"]
    if sizes:
        head += [f"ROWS{separator}{frames.shape[1]}", f"COLS{separator}{frames.shape[2]}"]
    if spacing:
        head += [f"ROW_SPACING{separator}{spacing[0]}", f"COL_SPACING{separator}{spacing[1]}"]
    head += [f"SENSEL_AREA{separator}{area}"] if area else []
    head += [f"SECONDS_PER_FRAME{separator}{period:g}"] if period else []
    head += ["COMMENTS:", "a walk", f"START_FRAME{separator}1", f"END_FRAME{separator}{len(frames)}"]
    head += [f"UNITS{separator}{unit}"] if unit else []
    head += ["ASCII_DATA @@", ""]

    def text(value: float) -> str:
        return "B" if np.isnan(value) else f"{value:g}".replace(".", "," if comma else ".")

    for i, frame in enumerate(frames):
        head.append(f"Frame {i + 1 if numbers is None else numbers[i]}")
        head += [delimiter.join(text(v) for v in row) for row in frame] + [""]
    path.write_bytes((end.join([*head, "@@"]) + end).encode())


@pytest.fixture
def frames():
    random = np.random.default_rng(3)
    out = np.round(random.uniform(0.0, 150.0, size=(40, 30, 11)), 1)
    out[:, 0, :4] = np.nan
    return out


def test_an_insole(tmp_path, frames):
    path = tmp_path / "walk.asf"
    export(path, frames)
    assert detect_format(path).name == "tekscan"
    recording = read_recording(path)
    foot = recording.feet["left"]
    assert (recording.rate_hz, recording.grid, recording.kind, recording.raw) == (100.0, (30, 11), "insole", False)
    assert foot.force.shape == (40, 30 * 11 - 4)
    assert foot.vertical_force == pytest.approx(np.nansum(frames, axis=(1, 2)) * 1e3 * 5.08e-3**2)
    assert foot.layout.positions[0, 0] == pytest.approx(29.5 * 5.08e-3)  # the first row is the front
    assert foot.layout.positions[0, 1] == pytest.approx((5.5 - 4.5) * 5.08e-3)  # the fifth column, from the left
    path.write_bytes(path.read_bytes().decode().encode("utf-16"))
    assert (read_recording(path).feet["left"].force == foot.force).all()


@pytest.mark.parametrize(
    ("unit", "factor"),
    [("KPa", 1e3), ("PSI", 6894.757293168), ("mmHg", 133.322387415), ("N/cm2", 1e4), ("g/cm2", 98.0665)],
)
@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
def test_units_and_delimiters(tmp_path, frames, unit, factor, delimiter):
    path = tmp_path / "walk.csv"
    export(path, frames, unit=unit, delimiter=delimiter, comma=delimiter != ",", end="\n")
    foot = read_recording(path).feet["left"]
    assert foot.vertical_force == pytest.approx(np.nansum(frames, axis=(1, 2)) * factor * 5.08e-3**2)


def test_raw_counts_stay_raw_and_say_so(tmp_path, frames):
    path = tmp_path / "walk.csv"
    for unit, word in (("Raw", "raw counts"), (None, "states no unit")):
        export(path, frames, unit=unit)
        recording = read_recording(path)
        assert recording.raw
        assert recording.feet["left"].vertical_force == pytest.approx(np.nansum(frames, axis=(1, 2)))
        assert any(word in w for w in recording.warnings)
    export(path, frames, unit="Furlong")
    with pytest.raises(FormatError, match=r"unknown unit 'Furlong'; allowed: kPa, N"):
        read_recording(path)
    foot = read_recording(path, options=ReadOptions(unit="kPa")).feet["left"]
    assert foot.vertical_force[0] == pytest.approx(np.nansum(frames[0]) * 1e3 * 5.08e-3**2)


def test_other_sizes_sides_and_a_platform(tmp_path, frames):
    path = tmp_path / "x.csv"
    export(path, frames, name="walk_R.fsx", spacing=("0.2 in", "0.508 cm"), separator=",")
    recording = read_recording(path)
    assert list(recording.feet) == ["right"]
    assert recording.feet["right"].layout.areas == pytest.approx(5.08e-3**2)
    export(path, frames, name="walk.fsx")
    assert any("does not state which foot" in w for w in read_recording(path).warnings)
    assert list(read_recording(path, options=ReadOptions(side="right")).feet) == ["right"]
    export(path, np.zeros((3, 90, 88)) + 5.0, name="mat.fsx", end="\n")
    assert read_recording(path).kind == "platform"


def test_missing_fields_are_assumed_aloud(tmp_path, frames):
    path = tmp_path / "walk.csv"
    export(path, frames, spacing=None, area=None, period=None, sizes=False)
    recording = read_recording(path)
    assert recording.grid == (30, 11)
    text = " ".join(recording.warnings)
    assert "5.08 mm is assumed" in text
    assert "100 Hz is assumed" in text
    export(path, frames, spacing=None)
    assert any("square cells of its sensel area" in w for w in read_recording(path).warnings)
    export(path, frames, area="60 mm2")
    assert any("do not agree" in w for w in read_recording(path).warnings)


@pytest.mark.parametrize("key", ["MIRROR_ROW", "MIRROR_COL"])
def test_a_mirrored_matrix_is_told(tmp_path, frames, key):
    path = tmp_path / "walk.asf"
    for value, told in (("1", 1), ("0", 0)):
        export(path, frames)
        path.write_text(path.read_text().replace("ASCII_DATA", f"{key} {value}\nASCII_DATA"))
        assert sum(f"{key} {value}: the matrix is" in warning for warning in read_recording(path).warnings) == told


def test_lost_damaged_and_cut_frames(tmp_path, frames):
    path = tmp_path / "walk.asf"
    export(path, frames, numbers=[i + 1 if i < 20 else i + 31 for i in range(40)])
    recording = read_recording(path)
    assert recording.time[-1] == pytest.approx(0.69)
    assert any("30 frame(s) are missing" in w for w in recording.warnings)
    export(path, frames)
    text = path.read_text()
    path.write_text(text[: text.index("Frame 40") + 200])
    cut = read_recording(path)
    assert len(cut.time) == 39
    assert any("cut short" in w for w in cut.warnings)
    rows = text.split("\n")
    at = rows.index("Frame 7") + 5
    rows[at] = rows[at].replace(",", ",x,", 1)
    path.write_text("\n".join(rows))
    odd = read_recording(path)
    assert len(odd.time) == 40
    assert any("1 damaged frame" in w for w in odd.warnings)


@pytest.mark.parametrize("numbers", [[1] * 40, [*range(1, 21), *range(1, 21)], list(range(40, 0, -1))], ids=str)
def test_frame_numbers_that_do_not_rise_are_told(tmp_path, frames, numbers):
    export(tmp_path / "walk.asf", frames, numbers=numbers)
    recording = read_recording(tmp_path / "walk.asf")
    assert recording.time == pytest.approx(np.arange(40) * 0.01)
    assert any("numbers do not rise" in warning for warning in recording.warnings)


def test_damage(tmp_path, frames):
    path = tmp_path / "walk.asf"
    export(path, frames)
    assert survive_corruption(path, header=500) > 15 / 40
    path.write_text("ROWS 2\nCOLS 2\nUNITS KPa\nDATA_TYPE MOVIE\n")
    with pytest.raises(FormatError, match="no line 'Frame 1'"):
        read_recording(path)


def test_the_real_insole(real_data):
    recording = read_recording(real_data / "recordings" / "fscan_walk_left.asf")
    assert (len(recording.time), recording.rate_hz, recording.grid) == (205, 31.25, (60, 21))
    assert list(recording.feet) == ["left"]
    assert recording.feet["left"].layout.areas == pytest.approx(25.8064e-6)
