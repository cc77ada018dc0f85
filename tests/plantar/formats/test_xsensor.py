"""The XSENSOR reader, on exports of every kind that the format allows."""

import re
from pathlib import Path

import numpy as np
import pytest

from plantar import FormatError
from plantar.formats import detect_format, read_recording
from plantar.formats.format import ReadOptions

from .corruption import survive_corruption

MMHG = 133.322387415
NAMES = ("HX210-DFM-LF S1", "HX210-DFM-RF S2")


def export(
    path: Path,
    feet: list[np.ndarray],
    *,
    names: tuple[str, ...] = NAMES,
    unit: str | None = "mmHg",
    factor: float = MMHG,
    size: tuple[float, float] | None = (0.86, 0.86),
    true_area: float = 0.7412e-4,
    step: float = 1.0 / 75.0,
    clock: bool = True,
    end: str = "\n",
    delimiter: str = ",",
    comma: bool = False,
    loads: bool = True,
    groups: bool = True,
    blank_lines: bool = True,
    start: float = 30077.982,
) -> None:
    """Write pressures (n, rows, columns) of each foot; each frame's load and area follow from the true cell area."""

    def text(value: float, digits: int = 2) -> str:
        return f"{value:.{digits}f}".rstrip("0").rstrip(".").replace(".", "," if comma else ".")

    rows: list[list[str]] = [["File:", '"walk.XSN"']]
    rows += [["Units:", unit]] if unit else []
    for k in range(len(feet[0])):
        t = (start + k * step) % 86400.0
        rows.append(["FRAME", str(1464 + k)])
        if clock:
            hours, rest = divmod(round(t * 1000), 3_600_000)
            minutes, rest = divmod(rest, 60_000)
            rows.append(["Time", f" {hours:02d}:{minutes:02d}:{rest // 1000:02d}.{rest % 1000:03d}"])
        for name, foot in zip(names, feet, strict=False):
            rows += [["SENSOR", name], ["Rows", str(foot.shape[1])], ["Columns", str(foot.shape[2])]]
            if size:
                rows += [["Sensel Width (cm)", text(size[0])], ["Sensel Height (cm)", text(size[1])]]
            rows.append([f"Average Pressure ({unit})" if unit else "Average Pressure", text(foot[k].mean())])
            if loads:
                rows.append(["Contact Area (cm²)", text((foot[k] > 0).sum() * true_area * 1e4)])
                rows.append(["Est. Load (N)", text(foot[k].sum() * factor * true_area)])
            rows += [["SENSELS"], *[[text(v) for v in line] for line in foot[k]]]
            if groups:
                rows += [["GROUP", "1"], ["Cells", "2"], ["Est. Load (N)", "0"], ["SENSELS"], ["1", "2"]]
    lines = [delimiter.join(r) + delimiter * 3 for r in rows]
    lines = [x for line in lines for x in ((line, delimiter * 5) if blank_lines else (line,))]
    path.write_bytes(b"\xef\xbb\xbf" + (end.join(lines) + end).encode())


@pytest.fixture
def feet():
    random = np.random.default_rng(3)
    out = []
    for rows, columns in ((13, 5), (13, 5)):
        foot = np.round(random.uniform(50.0, 900.0, size=(60, rows, columns)), 2)
        foot[:, :2, 0] = 0.0
        foot[40:50] = 0.0
        out.append(foot)
    return out


def test_two_insoles_with_their_stated_loads(tmp_path, feet):
    path = tmp_path / "walk.csv"
    export(path, feet)
    assert detect_format(path).name == "xsensor"
    recording = read_recording(path)
    assert list(recording.feet) == ["left", "right"]
    assert (len(recording.time), recording.grid, recording.raw) == (60, (13, 5), False)
    assert recording.rate_hz == pytest.approx(75.0, rel=0.002)
    for side, truth in zip(("left", "right"), feet, strict=True):
        foot = recording.feet[side]
        # the cells' area follows from the stated contact area: 0.86 cm is rounded
        assert foot.vertical_force == pytest.approx(truth.sum(axis=(1, 2)) * MMHG * 0.7412e-4, rel=1e-3)
        pressure = foot.pressure()
        assert pressure.reshape(truth.shape) == pytest.approx(truth * MMHG, rel=1e-9)
    path.write_bytes(path.read_bytes().decode("utf-8-sig").encode("utf-16-le"))
    assert (read_recording(path).feet["left"].force == recording.feet["left"].force).all()


@pytest.mark.parametrize(
    "options",
    [
        {"end": "\r\n"},
        {"delimiter": ";", "comma": True},
        {"delimiter": "\t", "end": "\r"},
        {"blank_lines": False},
        {"groups": False},
        {"unit": "kPa", "factor": 1e3},
        {"unit": "psi", "factor": 6894.757293168},
        {"step": 0.01, "start": 86399.9},  # over midnight
        {"loads": False, "true_area": 0.86e-2**2},
    ],
)
def test_ways_to_write_it(tmp_path, feet, options):
    path = tmp_path / "walk.csv"
    export(path, feet, **options)
    recording = read_recording(path)
    factor = float(options.get("factor", MMHG)) * float(options.get("true_area", 0.7412e-4))
    assert recording.feet["right"].vertical_force == pytest.approx(feet[1].sum(axis=(1, 2)) * factor, rel=1e-3)
    assert recording.rate_hz == pytest.approx(1.0 / float(options.get("step", 1 / 75)), rel=0.01)


def test_frames_without_times_lie_where_their_numbers_say(tmp_path, feet):
    path = tmp_path / "walk.csv"
    export(path, feet, clock=False)
    blocks = re.split(r"(?m)^(?=FRAME)", path.read_text(encoding="utf-8-sig"))
    path.write_text("".join(blocks[:3] + blocks[5:]), encoding="utf-8-sig")
    recording = read_recording(path)
    assert recording.time[:3] == pytest.approx([0.0, 0.01, 0.04])
    assert "2 frame number(s) are missing: gaps in time" in recording.warnings


def test_one_foot_other_names_and_missing_fields(tmp_path, feet):
    path = tmp_path / "walk.csv"
    export(path, feet[1:], names=NAMES[1:])
    assert list(read_recording(path).feet) == ["right"]
    export(path, feet[:1], names=("mat",))
    assert any("does not state which foot" in w for w in read_recording(path).warnings)
    assert list(read_recording(path, options=ReadOptions(side="right")).feet) == ["right"]
    export(path, feet, names=("one", "two"), clock=False, size=None, loads=False)
    recording = read_recording(path)
    text = " ".join(recording.warnings)
    assert "left and right in their order" in text
    assert "100 Hz is assumed" in text
    assert "8.6 x 8.6 mm is assumed" in text
    export(path, feet, unit=None)
    raw = read_recording(path)
    assert raw.raw
    assert any("raw counts" in w for w in raw.warnings)


def test_a_wrong_unit_or_cell_size_is_found_out(tmp_path, feet):
    path = tmp_path / "walk.csv"
    export(path, feet, unit="kPa", factor=MMHG)
    assert any("times the one that the file states: check unit" in w for w in read_recording(path).warnings)
    export(path, feet, size=(1.2, 0.86))
    assert any("do not agree" in w for w in read_recording(path).warnings)
    export(path, feet, unit="quatloo")
    with pytest.raises(FormatError, match="unknown unit of pressure 'quatloo'"):
        read_recording(path)


def test_a_cut_end_and_missing_cells(tmp_path, feet):
    path = tmp_path / "walk.csv"
    export(path, feet)
    whole = path.read_bytes()
    path.write_bytes(whole[: whole.rindex(b"SENSELS") - 300])
    recording = read_recording(path)
    assert len(recording.time) == 59
    assert any("cut short" in w for w in recording.warnings)
    lines = whole.split(b"\n")
    at = [i for i, line in enumerate(lines) if line.startswith(b"SENSELS")][4] + 2
    lines[at] = b"," + lines[at].partition(b",")[2]  # a blank is no zero
    lines[at + 2] = b"8x8" + lines[at + 2]
    path.write_bytes(b"\n".join(lines))
    damaged = read_recording(path)
    assert np.isnan(damaged.feet["left"].force).sum() == 1 + 5
    assert any("no numbers" in w for w in damaged.warnings)


def test_two_sensors_of_one_name_are_refused(tmp_path, feet):
    path = tmp_path / "walk.csv"
    export(path, feet, names=(NAMES[0], NAMES[0]))
    with pytest.raises(FormatError, match=r"60 of 60 frames hold more than one matrix of '[^']*': give each"):
        read_recording(path)


def test_damage(tmp_path, feet):
    path = tmp_path / "walk.csv"
    export(path, [f[:20] for f in feet])
    assert survive_corruption(path) > 20 / 40
    path.write_text("FRAME,1\nSENSOR,LF\nSENSELS\n")
    with pytest.raises(FormatError, match="no frame with a matrix"):
        read_recording(path)


def test_the_real_walk_agrees_with_its_frame_headers(real_data):
    path = real_data / "recordings" / "xsensor_walk.csv"
    recording = read_recording(path)
    assert (len(recording.time), recording.grid) == (101, (31, 11))
    assert recording.rate_hz == pytest.approx(75.0, rel=0.01)
    stated: dict[str, list[tuple[float, float]]] = {"LF": [], "RF": []}
    sensor, area = "", 0.0
    for line in path.read_text(encoding="utf-8-sig").splitlines():
        key, _, rest = line.partition(",")
        value = rest.partition(",")[0]
        if key in ("SENSOR", "GROUP", "FRAME"):
            sensor = value.split("-")[-1].split()[0] if key == "SENSOR" else ""
        elif sensor and key.startswith("Contact Area"):
            area = float(value)
        elif sensor and key.startswith("Est. Load"):
            stated[sensor].append((float(value), area))
    checked = 0
    for side, name in (("left", "LF"), ("right", "RF")):
        foot = recording.feet[side]
        for i, (load, contact) in enumerate(stated[name]):
            if load > 50.0:
                checked += 1
                assert foot.vertical_force[i] == pytest.approx(load, rel=0.005)
                assert foot.layout.areas[foot.force[i] > 0.0].sum() * 1e4 == pytest.approx(contact, rel=0.005)
    assert checked > 90
