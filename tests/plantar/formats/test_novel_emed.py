"""The emed reader, on exports of every kind that the format allows."""

import numpy as np
import pytest

from plantar import FormatError
from plantar.formats import detect_format, read_recording
from plantar.formats.format import ReadOptions

from .corruption import survive_corruption


def export(
    path,
    pressure,
    *,
    first=(30, 26),
    matrix="64x95",
    size="0.500x0.500 cm",
    area="0.25 cm²",
    time="10.0 ms",
    scale=1e3,
    forces=True,
    end="\n",
    comma=False,
    split=None,
    encoding="latin-1",
    start=1,
    summary=False,
    cell=25e-6,
):
    """Write pressures (n, rows, columns) as pages; `first` is the number of the first row and column."""
    lines: list[str] = []
    page = 0
    for k, frame in enumerate(pressure):
        parts = [slice(0, frame.shape[1])] if split is None else [slice(0, split), slice(split, frame.shape[1])]
        for part in parts:
            page += 1
            lines += ["", f"\t\t\t\tPage {page}", ""]
            lines.append("\tFile: C:\\novel\\1.dat" + (f" \tMatrix: {matrix} " if matrix else ""))
            facts = [f"Sensor area: {area}" if area else "", f"Time/picture:{time}" if time else ""]
            lines.append("\t" + "\t".join(f for f in facts if f))
            if size:
                lines.append(f"\tSensor size: {size}")
            lines += [f"\tPict-No.: {start + k}  Force[N]=sum*sensor_area in row/column", ""]
            lines += table(
                frame[:, part], first[0], first[1] + part.start, frame if forces else None, scale * cell, comma
            )
            lines.append("\f")
    if summary:
        lines += ["", "\t\t\t\tPage 99", "", "\tMPP over frames", ""]
        lines += table(pressure.max(axis=0), *first, None, 0.0, comma)
    path.write_bytes((end.join(lines) + end).encode(encoding))


def table(shown: np.ndarray, row: int, column: int, whole: np.ndarray | None, factor: float, comma: bool) -> list[str]:
    def text(value: float) -> str:
        return f"{value:.2f}".replace(".", ",") if comma else f"{value:.2f}"

    out = ["\t" + "\t".join(str(column + j) for j in range(shown.shape[1])) + ("\tForce" if whole is not None else "")]
    for i, line in enumerate(shown):
        cells = [text(v) for v in line] + ([text(line.sum() * factor)] if whole is not None else [])
        out.append(f"{row + i}\t" + "\t".join(cells))
    if whole is not None:
        out.append("Force\t" + "\t".join(text(v * factor) for v in [*shown.sum(axis=0), whole.sum()]))
    return out


@pytest.fixture
def step():
    random = np.random.default_rng(3)
    share = np.sin(np.pi * np.linspace(0.05, 0.95, 30))[:, None, None]
    return np.round(share * random.uniform(0.0, 160.0, size=(30, 20, 12)) / 5.0) * 5.0


def test_a_step_with_its_forces(tmp_path, step):
    path = tmp_path / "step.lst"
    export(path, step, summary=True)
    assert detect_format(path).name == "emed"
    recording = read_recording(path)
    (foot,) = recording.feet.values()
    assert (len(recording.time), recording.rate_hz, recording.grid, recording.kind) == (30, 100.0, (95, 64), "platform")
    assert foot.layout.areas == pytest.approx(25e-6)
    assert foot.vertical_force == pytest.approx(step.sum(axis=(1, 2)) * 1e3 * 25e-6)
    pressure = foot.pressure()
    window = pressure.reshape(30, 95, 64)[:, 29:49, 25:37]
    assert window == pytest.approx(step * 1e3)
    assert pressure.sum() == pytest.approx(window.sum())
    assert any("kPa, follows from the file's own forces" in w for w in recording.warnings)


@pytest.mark.parametrize(
    "options",
    [
        {"end": "\r\n"},
        {"comma": True},
        {"encoding": "utf-8"},
        {"split": 5},
        {"size": None},
        {"area": None},
        {"matrix": "100x40", "first": (1, 1)},
        {"matrix": None},
        {"time": "0.01 s"},
    ],
)
def test_ways_to_write_it(tmp_path, step, options):
    path = tmp_path / "step.lst"
    export(path, step, **options)
    recording = read_recording(path)
    (foot,) = recording.feet.values()
    assert foot.vertical_force == pytest.approx(step.sum(axis=(1, 2)) * 0.025)
    assert recording.rate_hz == pytest.approx(100.0)


def test_the_unit_follows_from_the_forces(tmp_path, step):
    path = tmp_path / "step.lst"
    export(path, step / 10.0, scale=1e4)  # N/cm2
    (foot,) = read_recording(path).feet.values()
    assert foot.vertical_force == pytest.approx(step.sum(axis=(1, 2)) * 0.025)
    export(path, step, scale=133.322)  # mmHg, which emed does not write
    with pytest.raises(FormatError, match="which is no unit of pressure"):
        read_recording(path)
    (foot,) = read_recording(path, options=ReadOptions(unit="mmHg")).feet.values()
    assert foot.vertical_force == pytest.approx(step.sum(axis=(1, 2)) * 25e-6 * 133.322387415)
    export(path, step, forces=False)
    recording = read_recording(path)
    assert any("kPa is assumed" in w for w in recording.warnings)


def test_what_is_missing_is_assumed_aloud(tmp_path, step):
    path = tmp_path / "step.lst"
    export(path, step, size=None, area=None, time=None)
    recording = read_recording(path)
    text = " ".join(recording.warnings)
    assert "5 x 5 mm is assumed" in text
    assert "100 Hz is assumed" in text
    assert read_recording(path, options=ReadOptions(rate_hz=50.0)).rate_hz == 50.0
    export(path, step, size="0.700x0.700 cm", area="0.25 cm²")
    assert any("do not agree" in w for w in read_recording(path).warnings)


def test_a_last_frame_that_is_cut_short_and_several_trials(tmp_path, step):
    path = tmp_path / "step.lst"
    export(path, step)
    text = path.read_bytes()
    path.write_bytes(text[: text.rindex(b"Pict-No") + 400])
    recording = read_recording(path)
    assert len(recording.time) == 29
    assert any("cut short" in w for w in recording.warnings)
    export(path, step)
    path.write_bytes(path.read_bytes() * 2)
    twice = read_recording(path)
    assert len(twice.time) == 60
    assert np.diff(twice.time).max() > 2.0
    assert any("2 trials" in w for w in twice.warnings)


def test_damage(tmp_path, step):
    path = tmp_path / "step.lst"
    export(path, step[:8])
    assert survive_corruption(path) > 20 / 40
    path.write_text("\tPict-No.: 1 Sensor\n\nnothing here\n")
    with pytest.raises(FormatError, match="holds no frame"):
        read_recording(path)


def test_the_real_step_agrees_with_its_force_column(real_data):
    path = real_data / "recordings" / "emed_step.lst"
    recording = read_recording(path)
    (foot,) = recording.feet.values()
    lines = path.read_text(encoding="latin-1").splitlines()
    stated = np.array([float(line.split("\t")[-1]) for line in lines if line.startswith("Force\t")])[
        : len(recording.time)
    ]
    assert len(stated) == len(recording.time) == 106
    assert np.abs(foot.vertical_force - stated).max() < 0.01
    assert foot.force.shape[1] == 95 * 64
    assert recording.rate_hz == 100.0
