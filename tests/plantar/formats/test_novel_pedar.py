"""The pedar and pliance reader, on exports of every kind that the format allows."""

from pathlib import Path

import numpy as np
import pytest

from plantar import FormatError, InputError, write_layout
from plantar.common.sides import other_side
from plantar.formats import ReadOptions, detect_format, read_recording
from plantar.formats.nominal_insole import CELL_AREAS, nominal_insole
from plantar.formats.recorded_layouts import polygon_layout

from .corruption import survive_corruption


def export(
    path: Path,
    left: np.ndarray | None,
    right: np.ndarray | None,
    *,
    rate: float = 100.0,
    unit: str | None = "kPa",
    sensor: str = "y-1865l-1870r-pxf306",
    end: str = "\n",
    comma: bool = False,
    mask: bool = True,
    stated_rate: bool = True,
    tail: str = "",
    cells: list[int] | None = None,
) -> np.ndarray:
    """Write an export of pressures (n, cells) a foot; returns the times."""
    feet = [f for f in (left, right) if f is not None]
    time = (np.arange(len(feet[0])) + 1) / rate
    lines = ["file name:  walk.sol\tdate/time  01.01.26 10.00", f"sensor type:  {sensor} "]
    if stated_rate:
        lines.append(
            f"total time [secs]:  {time[-1]:.3f}\ttime per frame [secs]:  {1 / rate:.5f}"
            f"\tscanning rate [Hz]:   {rate:g}"
        )
    if unit is not None:
        lines.append(f"pressure values in  {unit}")
    lines.append("")
    numbers = [list(range(1, f.shape[1] + 1)) if cells is None else cells for f in feet]
    if mask:
        lines.append("mask definition: ")
        for name, foot in (("left", left), ("right", right)):
            listed = "" if foot is None else ",".join(str(c) for c in numbers[0]) + ","
            lines.append(f"{name} insole: {listed}")
        lines.append("")
    lines.append("time[secs]    \t" + "\t".join(f"{c:7d}" for n in numbers for c in n) + "\t")
    for t, *rows in zip(time, *feet, strict=True):
        values = [f"{t:12.5f}", *(f"{v:7.3f}" for row in rows for v in row)]
        lines.append("\t".join(v.replace(".", ",") if comma else v for v in values) + "\t")
    path.write_bytes((end.join(lines) + end + tail).encode("latin-1"))
    return time


@pytest.fixture
def pressures():
    random = np.random.default_rng(5)
    left, right = (np.round(random.uniform(0, 200, size=(50, 99)), 3) for _ in range(2))
    return left, right


def read_pa(path: Path, side: str) -> np.ndarray:
    pressure = read_recording(path).feet[side].pressure()
    assert pressure is not None
    return pressure


def test_two_insoles(tmp_path, pressures):
    path = tmp_path / "walk.asc"
    time = export(path, *pressures)
    assert detect_format(path).name == "pedar"
    recording = read_recording(path)
    assert recording.rate_hz == 100.0
    assert np.abs(recording.time - time).max() < 1e-9
    for side, truth in zip(("left", "right"), pressures, strict=True):
        assert np.abs(read_pa(path, side) - truth * 1e3).max() < 1e-6
        layout = recording.feet[side].layout
        assert layout.side == side
        assert layout.areas.mean() == pytest.approx(193e-6, rel=1e-3)
        assert recording.feet[side].force == pytest.approx(truth * 1e3 * layout.areas)
    assert any("nominal 99-cell insole of size Y" in w for w in recording.warnings)


def test_a_mask_that_lists_the_right_insole_first(tmp_path, pressures):
    path = tmp_path / "walk.asc"
    export(path, *pressures)
    text = path.read_text(encoding="latin-1")
    turned = text.replace("left insole", "*").replace("right insole", "left insole").replace("*", "right insole")
    path.write_text(turned, encoding="latin-1")
    assert any("lists the right insole first" in w for w in read_recording(path).warnings)
    for side, truth in zip(("right", "left"), pressures, strict=True):
        assert np.abs(read_pa(path, side) - truth * 1e3).max() < 1e-6


@pytest.mark.parametrize(("mask", "sensor", "told"), [(True, "y", 0), (False, "y-1865l-1870r", 0), (False, "y", 1)])
def test_which_insole_is_first_is_known_or_told(tmp_path, pressures, mask, sensor, told):
    path = tmp_path / "walk.asc"
    export(path, *pressures, mask=mask, sensor=sensor)
    assert sum("which insole is which" in w for w in read_recording(path).warnings) == told


@pytest.mark.parametrize("first", ["left", "right"])
def test_side_says_whose_the_first_columns_are(tmp_path, pressures, first):
    path = tmp_path / "walk.asc"
    export(path, *pressures, mask=False, sensor="y")
    recording = read_recording(path, options=ReadOptions(side=first))
    assert not any("which insole is which" in w for w in recording.warnings)
    for side, truth in zip((first, other_side(first)), pressures, strict=True):
        layout = recording.feet[side].layout
        assert recording.feet[side].force == pytest.approx(truth * 1e3 * layout.areas)


def test_side_is_not_used_where_the_file_knows(tmp_path, pressures):
    path = tmp_path / "walk.asc"
    export(path, *pressures)
    recording = read_recording(path, options=ReadOptions(side="right"))
    assert any("--side is not used" in w for w in recording.warnings)
    assert np.abs(read_pa(path, "left") - pressures[0] * 1e3).max() < 1e-6


@pytest.mark.parametrize(
    "options",
    [
        {"rate": 50.0},
        {"rate": 62.5},
        {"end": "\r\n"},
        {"comma": True},
        {"mask": False},
        {"stated_rate": False, "unit": "kPa"},
        {"end": "\r\n", "comma": True, "mask": False, "rate": 200.0},
    ],
)
def test_variants_hold_the_same_values(tmp_path, pressures, options):
    path = tmp_path / "walk.ASC"
    export(path, *pressures, **options)
    recording = read_recording(path)
    assert recording.rate_hz == pytest.approx(options.get("rate", 100.0), rel=1e-3)
    for side, truth in zip(("left", "right"), pressures, strict=True):
        assert np.abs(read_pa(path, side) - truth * 1e3).max() < 1e-6


@pytest.mark.parametrize(
    ("unit", "pascals"), [("kPa", 1e3), ("N/cm²", 1e4), ("N/cm2", 1e4), ("mmHg", 133.322387415), ("psi", 6894.757)]
)
def test_units(tmp_path, pressures, unit, pascals):
    path = tmp_path / "walk.asc"
    export(path, *pressures, unit=unit)
    assert read_pa(path, "left") == pytest.approx(pressures[0] * pascals)


def test_unit_that_is_missing_is_said_and_an_unknown_one_refused(tmp_path, pressures):
    path = tmp_path / "walk.asc"
    export(path, *pressures, unit=None)
    assert any("kPa is assumed" in w for w in read_recording(path).warnings)
    export(path, *pressures, unit="kQa")
    with pytest.raises(FormatError, match=r"unknown unit of pressure 'kQa'; allowed: kpa, n/cm2"):
        read_recording(path)


@pytest.mark.parametrize(
    ("which", "mask", "sensor", "side", "assumed"),
    [
        ("left", True, "y-1865l-1870r", "left", False),
        ("right", True, "y-1865l-1870r", "right", False),
        ("right", False, "w-1870r-x", "right", False),
        ("left", False, "w-1870l-x", "left", False),
        ("right", False, "w", "left", True),
    ],
)
def test_one_foot(tmp_path, pressures, which, mask, sensor, side, assumed):
    path = tmp_path / "walk.asc"
    export(path, *((pressures[0], None) if which == "left" else (None, pressures[0])), mask=mask, sensor=sensor)
    recording = read_recording(path)
    assert list(recording.feet) == [side]
    assert any("does not state which foot" in w for w in recording.warnings) == assumed
    assert read_pa(path, side) == pytest.approx(pressures[0] * 1e3)


def test_masked_cells_keep_their_places(tmp_path, pressures):
    path = tmp_path / "walk.asc"
    cells = [1, 2, 3, 50, 98, 99]
    export(path, pressures[0][:, :6], pressures[1][:, :6], cells=cells)
    left = read_recording(path).feet["left"]
    assert left.layout.ids.tolist() == cells
    whole = nominal_insole("y", "left")
    assert left.layout.positions == pytest.approx(whole.positions[[c - 1 for c in cells]])


@pytest.mark.parametrize("after", ["-12l-12r", "_v-1865l-1870r-pxf306", " 12", "_V2"])
@pytest.mark.parametrize("size", sorted(CELL_AREAS))
def test_the_size_is_taken_from_the_sensor(tmp_path, pressures, size, after):
    """Whatever follows the letters of the size; the force is that of each cell's own area."""
    path = tmp_path / "walk.asc"
    export(path, *pressures, sensor=size.upper() + after)
    recording = read_recording(path)
    right = recording.feet["right"]
    assert right.layout.areas == pytest.approx(CELL_AREAS[size])
    assert right.vertical_force == pytest.approx(pressures[1] @ CELL_AREAS[size] * 1e3)
    assert not any("assumed" in w for w in recording.warnings)


def test_a_size_that_is_not_known_is_said_with_what_it_may_cost(tmp_path, pressures):
    path = tmp_path / "walk.asc"
    export(path, *pressures, sensor="custom-12l-12r")
    (warning,) = (w for w in read_recording(path).warnings if "nominal" in w)
    assert "forces may be 0.73 to 1.25 times these" in warning
    given = read_recording(path, options=ReadOptions(insole_size="UW"))
    assert given.feet["left"].vertical_force == pytest.approx(pressures[0] @ CELL_AREAS["uw"] * 1e3)
    with pytest.raises(InputError, match="unknown insole size 'q'; allowed: u, v, w"):
        read_recording(path, options=ReadOptions(insole_size="q"))
    table = tmp_path / "table.csv"
    table.write_text("time,left_1 [N],left_2 [N]\n" + "".join(f"{i / 100},1,{i}\n" for i in range(9)))
    with pytest.raises(InputError, match="--insole-size is for pedar recordings"):
        read_recording(table, options=ReadOptions(insole_size="x"))


def test_truncated_last_row_is_dropped_and_said(tmp_path, pressures):
    path = tmp_path / "walk.asc"
    export(path, *pressures)
    whole = path.read_bytes()
    path.write_bytes(whole[:-700])
    recording = read_recording(path)
    assert len(recording.time) == 49
    assert any("last frame is cut short" in w for w in recording.warnings)


def test_a_damaged_frame_is_a_dropout_not_a_zero(tmp_path, pressures):
    path = tmp_path / "walk.asc"
    export(path, *pressures)
    lines = path.read_text("latin-1").splitlines(keepends=True)
    lines[-20] = lines[-20].replace("\t", "\tx", 3)
    path.write_text("".join(lines), "latin-1")
    recording = read_recording(path)
    assert len(recording.time) == 50
    assert np.isnan(recording.feet["left"].vertical_force).sum() == 1
    assert np.diff(recording.time) == pytest.approx(0.01)
    assert any("1 damaged frame" in w for w in recording.warnings)


def test_layout_file_overrides_the_geometry(tmp_path, pressures):
    path = tmp_path / "walk.asc"
    export(path, *pressures)
    small = nominal_insole("u", "left")
    recording = read_recording(path, layout=small)
    left, right = recording.feet["left"], recording.feet["right"]
    assert left.layout.areas == pytest.approx(small.areas)
    assert right.layout.positions[:, 1] == pytest.approx(-small.positions[:, 1])
    assert not any("nominal" in w for w in recording.warnings)
    square = np.array([[0.0, 0.0], [0.01, 0.0], [0.01, 0.01], [0.0, 0.01]])
    other = polygon_layout([square], ids=[7], side="left", name="one cell")
    write_layout(other, tmp_path / "layout.json")
    with pytest.raises(FormatError, match="left foot has 99 cells, layout 'one cell' 1"):
        read_recording(path, layout=other)


def pliance(path: Path, *, geometry: bool = True) -> np.ndarray:
    """A mat of 2 x 3 cells of 10 x 20 mm with the corner table that pliance appends."""
    values = np.round(np.random.default_rng(2).uniform(0, 90, size=(12, 6)), 3)
    lines = [
        "file name: mat.mat date/time 17.06.23 15.21",
        "mat type s2160_001",
        "total times [secs]: 0.5 time per frame [secs]: 0.04167 scanning rate [Hz]: 24",
        "pressure values in kPa",
        "",
        "electrical:",
        "time[secs]       4       5       6      12      13      14",
    ]
    lines += [f"{5.8 + i / 24:10.5f} " + " ".join(f"{v:7.3f}" for v in row) for i, row in enumerate(values)]
    lines += ["MVP " + " ".join(f"{v:7.3f}" for v in values.max(axis=0)), ""]
    if geometry:
        x0, y0 = np.array([0, 1, 2, 0, 1, 2.0]), np.array([0, 0, 0, 2, 2, 2.0])
        lines.append("corner coordinates [cm]")
        for k, (dx, dy) in enumerate(((0, 0), (1, 0), (1, 2), (0, 2))):
            lines.append(f"x[{k}] " + " ".join(f"{v:8.4f}" for v in x0 + dx))
            lines.append(f"y[{k}] " + " ".join(f"{v:8.4f}" for v in y0 + dy))
        lines.append("area " + " ".join(["2.0000"] * 6))
    path.write_text("\n".join(lines) + "\n")
    return values


def test_pliance_mat_with_its_own_geometry(tmp_path):
    values = pliance(tmp_path / "mat.asc")
    recording = read_recording(tmp_path / "mat.asc")
    foot = recording.feet["left"]
    assert recording.rate_hz == pytest.approx(24.0)
    assert foot.layout.areas == pytest.approx([2e-4] * 6)
    assert foot.force == pytest.approx(values * 1e3 * 2e-4)
    assert foot.layout.positions[0, :2] == pytest.approx([0.01, -0.005])
    assert [len(n) for n in foot.layout.neighbours] == [2, 3, 2, 2, 3, 2]


def test_cells_without_geometry_ask_for_a_layout(tmp_path):
    pliance(tmp_path / "mat.asc", geometry=False)
    text = (tmp_path / "mat.asc").read_text().replace("     14\n", "    400\n")
    (tmp_path / "mat.asc").write_text(text)
    with pytest.raises(FormatError, match="give one with --layout"):
        read_recording(tmp_path / "mat.asc")


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"\x00\x01\x02\x03" * 500,
        b"hello\n" * 100,
        b"time,left,right\n0,1,2\n",
        b"pressure values in kPa\ntime[secs]\t1\t2\n",
        b"pressure values in kPa\ntime[secs]\t1\t2\nabc\tdef\tghi\nx\ty\tz\n",
        b"scanning rate [Hz]: 0\npressure values in kPa\ntime[secs]\t1\t2\n0.0\t1\t2\n",
        b"scanning rate [Hz]: 100\ntime[secs]\t1\t2\t1\t2\t1\t2\n0.0\t1\t2\t1\t2\t1\t2\n",
    ],
)
def test_nonsense_is_refused_in_one_line(tmp_path, content):
    path = tmp_path / "bad.asc"
    path.write_bytes(content)
    for name in (None, "pedar"):
        with pytest.raises(FormatError) as caught:
            read_recording(path, name)
        assert str(caught.value).startswith(str(path))
        assert "\n" not in str(caught.value)


def test_damage(tmp_path, pressures):
    def check(recording):
        assert recording.metadata["pressure_unit_pa"] == 1e3
        assert recording.rate_hz == pytest.approx(100.0)

    export(tmp_path / "walk.asc", *pressures)
    assert survive_corruption(tmp_path / "walk.asc", trials=80, header=2500, check=check) > 20 / 80


def test_real_recording(real_data):
    path = real_data / "recordings" / "pedar_walk.asc"
    recording = read_recording(path)
    assert (recording.format, len(recording.time), recording.rate_hz) == ("pedar", 1505, 100.0)
    assert {side: foot.force.shape[1] for side, foot in recording.feet.items()} == {"left": 99, "right": 99}
    assert read_pa(path, "right").max() == pytest.approx(247.5e3)
