"""Tables and arrays of any origin, with a layout file beside them."""

import io
import json
import pickle
import zipfile
from pathlib import Path

import numpy as np
import pytest

from plantar import FormatError, InputError, SoleLayout, hex_layout, mirrored, write_layout
from plantar.formats import detect_format, read_recording
from plantar.formats.format import ReadOptions
from plantar.formats.table_text import time_unit
from plantar.layouts.layout_file import layout_to_dict

from .corruption import survive_corruption


@pytest.fixture(scope="module")
def layout():
    return hex_layout([[0, -0.04], [0.2, -0.04], [0.2, 0.04], [0, 0.04]], name="mine", cell_area=691e-6)


@pytest.fixture(scope="module")
def values(layout):
    return np.round(np.random.default_rng(3).uniform(0.0, 90.0, size=(50, len(layout))), 3)


def write_csv(
    path: Path,
    columns: dict[str, np.ndarray],
    *,
    delimiter: str = ",",
    comma: bool = False,
    end: str = "\n",
    comments: tuple[str, ...] = (),
    header: bool = True,
) -> None:
    rows = [delimiter.join(columns)] if header else []
    for line in np.column_stack(list(columns.values())):
        cells = ["" if np.isnan(v) else f"{v:.6g}" for v in line]
        rows.append(delimiter.join(c.replace(".", ",") if comma else c for c in cells))
    path.write_bytes((end.join([*comments, *rows]) + end).encode())


def both(layout: SoleLayout, values: np.ndarray, unit: str = "[kPa]") -> dict[str, np.ndarray]:
    columns = {"time [s]": np.arange(50) * 0.01}
    for side, gain in (("left", 1.0), ("right", 2.0)):
        columns |= {f"{side} {i} {unit}".strip(): gain * values[:, k] for k, i in enumerate(layout.ids)}
    return columns


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"delimiter": ";", "comma": True},
        {"delimiter": "\t"},
        {"end": "\r\n"},
        {"comments": ("# unit: kPa", "# hello")},
    ],
)
def test_two_feet_with_units(tmp_path, layout, values, options):
    path = tmp_path / "walk.csv"
    write_csv(path, both(layout, values, "" if "comments" in options else "[kPa]"), **options)
    assert detect_format(path).name == "csv"
    recording = read_recording(path, layout=layout)
    assert (recording.rate_hz, recording.raw) == (pytest.approx(100.0), False)
    assert recording.feet["left"].force == pytest.approx(values * 1e3 * layout.areas, rel=1e-4)
    assert recording.feet["right"].force == pytest.approx(2.0 * values * 1e3 * layout.areas, rel=1e-4)
    assert recording.feet["right"].layout.side == "right"


def test_the_cells_are_found_by_their_ids(tmp_path, layout, values):
    path = tmp_path / "walk.csv"
    columns = {"t_ms": np.arange(50) * 10.0}
    columns |= {f"L_{i}_N": values[:, k] for k, i in reversed(list(enumerate(layout.ids)))}
    write_csv(path, columns)
    recording = read_recording(path, layout=layout)
    foot = recording.feet["left"]
    assert recording.rate_hz == pytest.approx(100.0)
    assert foot.layout.ids.tolist() == layout.ids.tolist()[::-1]
    assert foot.force == pytest.approx(values[:, ::-1], rel=1e-4)


@pytest.mark.parametrize("first", [0, 1, 101])
@pytest.mark.parametrize("order", ["rising", "falling", "as texts", "by chance"])
def test_cells_that_are_counted_are_found_by_their_numbers(tmp_path, layout, values, first, order):
    n = len(layout)
    columns = {
        "rising": list(range(n)),
        "falling": list(range(n))[::-1],
        "as texts": sorted(range(n), key=lambda k: str(k + first)),
        "by chance": np.random.default_rng(5).permutation(n).tolist(),
    }[order]
    write_csv(tmp_path / "walk.csv", {f"L{k + first} (N)": values[:, k] for k in columns})
    foot = read_recording(tmp_path / "walk.csv", layout=layout).feet["left"]
    assert foot.layout.positions == pytest.approx(layout.positions[columns])
    assert foot.force == pytest.approx(values[:, columns], rel=1e-4)


def test_what_is_not_stated_is_raw_or_assumed_aloud(tmp_path, layout, values):
    path = tmp_path / "walk.csv"
    write_csv(path, both(layout, values, ""))
    recording = read_recording(path, layout=layout)
    assert recording.raw
    assert any("raw counts (--unit" in w for w in recording.warnings)
    known = read_recording(path, options=ReadOptions(layout=layout, unit="N"))
    assert known.feet["left"].force == pytest.approx(values, rel=1e-4)
    write_csv(path, {str(i): values[:, k] for k, i in enumerate(layout.ids)}, header=False)
    bare = read_recording(path, options=ReadOptions(layout=layout, unit="N"))
    text = " ".join(bare.warnings)
    for word in ("the columns have no names", "states no rate", "does not state which foot"):
        assert word in text
    with pytest.raises(FormatError, match="the columns have no names"):
        read_recording(path, options=ReadOptions(unit="kPa"))
    with pytest.raises(InputError, match="unknown unit 'x'"):
        read_recording(path, options=ReadOptions(unit="x"))
    with pytest.raises(InputError, match="a rate of -1"):
        read_recording(path, options=ReadOptions(rate_hz=-1.0))


def test_missing_values_stay_missing(tmp_path, layout, values):
    path = tmp_path / "walk.csv"
    columns = both(layout, values)
    gone = columns["left 0 [kPa]"].copy()
    gone[10:20] = np.nan
    write_csv(path, {**columns, "left 0 [kPa]": gone})
    foot = read_recording(path, layout=layout).feet["left"]
    assert np.isnan(foot.force[10:20, 0]).all()
    assert np.isnan(foot.force).sum() == 10
    lines = path.read_text().splitlines()
    lines[5] = lines[5].replace(",", ",oops,", 1)
    lines[-1] = lines[-1][:30]
    path.write_text("\n".join(lines))
    damaged = read_recording(path, layout=layout)
    text = " ".join(damaged.warnings)
    assert "1 damaged row(s)" in text
    assert "last row is cut short" in text


def test_columns_in_other_units_are_no_cells(tmp_path, layout, values):
    path = tmp_path / "table.csv"
    columns = both(layout, values) | {
        "temperature [C]": np.full(50, 25.0),
        "left acc 1 [m/s2]": np.full(50, 9.8),
        "left total [N]": values.sum(axis=1),
    }
    write_csv(path, columns)
    found = read_recording(path, options=ReadOptions(layout=layout))
    assert found.feet["left"].force == pytest.approx(values * 1e3 * layout.areas)
    assert sum("is no cell" in w for w in found.warnings) == 3


def test_a_table_in_utf_16(tmp_path, layout, values):
    path = tmp_path / "table.csv"
    write_csv(path, both(layout, values), delimiter="\t")
    path.write_text(path.read_text(), encoding="utf-16")
    assert detect_format(path).name == "csv"
    assert read_recording(path, options=ReadOptions(layout=layout)).feet["left"].force == pytest.approx(
        values * 1e3 * layout.areas
    )


@pytest.mark.parametrize("decimals", [2, 1])
def test_times_that_frames_share_do_not_change_the_rate(tmp_path, layout, values, decimals):
    path = tmp_path / "table.csv"
    columns = both(layout, values)
    columns["time [s]"] = np.floor(np.arange(50) / 500.0 * 10**decimals + 1e-9) / 10**decimals  # 500 Hz
    write_csv(path, columns)
    if decimals == 1:  # all 50 share one time
        with pytest.raises(FormatError, match="no times that increase"):
            read_recording(path, options=ReadOptions(layout=layout))
        return
    found = read_recording(path, options=ReadOptions(layout=layout))
    assert found.rate_hz == pytest.approx(500.0)
    assert (np.diff(found.time) > 0.0).all()
    assert found.time[-1] - found.time[0] == pytest.approx(49 / 500.0)
    assert any("share their times" in w for w in found.warnings)


def test_a_table_that_fits_no_layout(tmp_path, layout, values):
    path = tmp_path / "walk.csv"
    write_csv(path, {"time": np.arange(50) * 0.01, **{f"left {i} [N]": values[:, i] for i in range(3)}})
    small = read_recording(path, layout=layout)  # the ids are there: a part of the sole
    assert small.feet["left"].force.shape == (50, 3)
    write_csv(path, {"time": np.arange(50) * 0.01, **{f"left {i + 500} [N]": values[:, i] for i in range(3)}})
    with pytest.raises(FormatError, match=r"left foot has 3 cells, layout 'mine' \d+"):
        read_recording(path, layout=layout)
    columns = both(layout, values)
    write_csv(path, {k.replace("right 1 [kPa]", "right 1 [N]"): v for k, v in columns.items()})
    with pytest.raises(FormatError, match="different units"):
        read_recording(path, layout=layout)
    path.write_text("a,b,c\n")
    with pytest.raises(FormatError):
        read_recording(path)


def test_arrays(tmp_path, layout, values):
    path = tmp_path / "walk.npz"
    text = json.dumps(layout_to_dict(layout))
    np.savez(path, time=np.arange(50) * 0.02, left=values, right=2 * values, unit="kPa", layout_left=text)
    assert detect_format(path).name == "arrays"
    with pytest.raises(FormatError, match="give a layout"):
        read_recording(path)  # there is none of the right sole
    recording = read_recording(path, layout=layout)
    assert recording.rate_hz == pytest.approx(50.0)
    assert recording.feet["right"].force == pytest.approx(2 * values * 1e3 * layout.areas)
    np.savez(path, left=values, rate_hz=200.0, unit="N", layout_left=text)
    one = read_recording(path)
    assert (one.rate_hz, list(one.feet)) == (200.0, ["left"])
    assert one.feet["left"].layout is not None
    np.save(tmp_path / "x.npy", values.reshape(50, -1, 1))
    bare = read_recording(tmp_path / "x.npy")
    assert bare.raw
    assert any("100 Hz is assumed" in w for w in bare.warnings)
    np.savez(path, left=np.array([{"a": 1}], dtype=object))
    with pytest.raises(FormatError, match="not an array file that can be read"):
        read_recording(path)
    np.savez(path, name="x")
    with pytest.raises(FormatError, match="no array of frames and cells"):
        read_recording(path)


class _Touch:
    """Unpickled, it creates a file."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def __reduce__(self) -> tuple[object, tuple[Path]]:
        return Path.touch, (self.path,)


@pytest.mark.parametrize("name", ["a.npy", "a.npz"])
def test_a_pickled_array_runs_no_code(tmp_path, name):
    """The shape agrees with the size of the pickle, so that no other check refuses it first."""
    packed = pickle.dumps(np.array([_Touch(tmp_path / "ran")], dtype=object))
    stream = io.BytesIO()
    rows = -(-len(packed) // 8)
    np.lib.format.write_array_header_1_0(stream, {"descr": "|O", "fortran_order": False, "shape": (rows,)})
    content = stream.getvalue() + packed.ljust(8 * rows, b"\0")
    if name.endswith("npz"):
        with zipfile.ZipFile(tmp_path / name, "w") as archive:
            archive.writestr("left.npy", content)
    else:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(FormatError, match="Python objects"):
        read_recording(tmp_path / name)
    assert not (tmp_path / "ran").exists()


def test_an_array_whose_head_breaks_off_is_refused(tmp_path):
    """Numpy takes the head of an array for Python's text, whose brackets may stay open."""
    path = tmp_path / "walk.npy"
    np.save(path, np.ones((40, 3)))
    path.write_bytes(path.read_bytes().replace(b"'shape': (40, 3), }", b"'shape': (40, 3L, }"))
    with pytest.raises(FormatError):
        read_recording(path)


def test_a_plantar_recording_survives_the_way_over_npz_and_csv(tmp_path, layout, values):
    from plantar.recordings.recorder import Recorder
    from plantar.recordings.recording import read_mcap

    with Recorder(tmp_path / "run.mcap", {}, {"left": layout}) as recorder:
        channel = recorder.channel("/skin/left", [("force", len(layout))])
        for i, row in enumerate(values):
            channel.write(i * 0.004, row)
    run = read_mcap(tmp_path / "run.mcap")
    arrays = read_recording(run.to_npz(tmp_path / "run.npz"))
    assert not arrays.raw
    assert arrays.rate_hz == pytest.approx(250.0)
    assert arrays.feet["left"].force == pytest.approx(values)
    run.to_csv(tmp_path / "out")
    table = read_recording(
        tmp_path / "out" / "skin_left.csv", options=ReadOptions(layout=layout, unit="N", side="left")
    )
    assert table.feet["left"].force == pytest.approx(values)


def test_an_export_of_two_clocks_is_read_as_its_recording(tmp_path, layout, values):
    from plantar.recordings.recorder import Recorder
    from plantar.recordings.recording import read_mcap

    soles = {"left": layout, "right": mirrored(layout)}
    with Recorder(tmp_path / "run.mcap", {"kind": "insole"}, soles) as recorder:
        left, right = (recorder.channel(f"/skin/{side}", [("force", len(layout))]) for side in soles)
        for i, row in enumerate(values):
            left.write(i * 0.02, row)
            if i != 20:
                right.write(i * 0.02 + 0.008, row)
    run = read_recording(tmp_path / "run.mcap")
    arrays = read_recording(read_mcap(tmp_path / "run.mcap").to_npz(tmp_path / "run.npz"))
    assert (arrays.kind, run.kind) == ("insole", "insole")
    assert arrays.time == pytest.approx(run.time)
    for side in soles:
        assert arrays.feet[side].force == pytest.approx(run.feet[side].force, nan_ok=True)
    assert arrays.warnings == run.warnings


def test_damage(tmp_path, layout, values):
    options = ReadOptions(layout=layout)
    write_csv(tmp_path / "walk.csv", both(layout, values))
    assert survive_corruption(tmp_path / "walk.csv", options=options) > 5 / 40
    np.savez(tmp_path / "walk.npz", time=np.arange(50) * 0.02, left=values, unit="kPa")
    survive_corruption(tmp_path / "walk.npz", options=options, trials=60)
    np.savez_compressed(tmp_path / "walk.npz", time=np.arange(50) * 0.02, left=values, unit="kPa")
    survive_corruption(tmp_path / "walk.npz", options=options, trials=60)
    write_layout(layout, tmp_path / "layout.json")


@pytest.mark.parametrize("words", [("left", "right"), ("L", "R"), ("0", "1"), ("1", "2"), ("Li", "Re")])
@pytest.mark.parametrize("shift", [0.0, 0.004])
def test_a_table_with_a_column_of_sides_is_two_feet(tmp_path, layout, values, words, shift):
    """Rows of both feet in turn; with a shift, the right foot is measured between the left one's times."""
    path = tmp_path / "soles.csv"
    rows = ["time [s],sole," + ",".join(f"cell {i} [N]" for i in layout.ids)]
    smooth = np.cumsum(values, axis=0)
    for k in range(50):
        rows.append(f"{k / 100},{words[0]}," + ",".join(f"{v:.6g}" for v in smooth[k]))
        rows.append(f"{k / 100 + shift},{words[1]}," + ",".join(f"{2.0 * v:.6g}" for v in smooth[k]))
    path.write_text("\n".join(rows) + "\n")
    assert detect_format(path).name == "csv"
    recording = read_recording(path, layout=layout)
    assert list(recording.feet) == ["left", "right"]
    assert recording.rate_hz == pytest.approx(100.0)
    assert recording.feet["left"].force == pytest.approx(smooth[-len(recording.time) :], rel=1e-4)
    at = np.arange(50) / 100 + shift
    truth = np.column_stack([np.interp(recording.time, at, 2.0 * column) for column in smooth.T])
    assert recording.feet["right"].force == pytest.approx(truth, rel=1e-4)
    assert any("interpolated" in w for w in recording.warnings) == (shift > 0.0)
    assert any("smaller is taken as the left" in w for w in recording.warnings) == words[0].isdigit()


@pytest.mark.parametrize("lost", ["left", "right"])
@pytest.mark.parametrize("shift", [0.0, 0.004])
@pytest.mark.parametrize("span", [(0.0, 0.2), (0.15, 0.3), (0.3, 0.6)])
@pytest.mark.parametrize("unit", ["s", "ms"])
def test_rows_that_a_foot_lacks_are_not_drawn_and_cost_the_other_none(tmp_path, layout, lost, shift, span, unit):
    """One foot's connection breaks, at the begin, in between, or at the end."""
    path, rows = tmp_path / "soles.csv", [f"time [{unit}],sole," + ",".join(f"cell {i} [N]" for i in layout.ids)]
    for k in range(50):
        for side, late in (("left", 0.0), ("right", shift)):
            if side != lost or not span[0] <= k / 100 < span[1]:
                rows.append(
                    f"{(k / 100 + late) * {'s': 1, 'ms': 1000}[unit]:.3f},{side},"
                    + ",".join(f"{k + 1}" for _ in layout.ids)
                )
    path.write_text("\n".join(rows) + "\n")
    recording = read_recording(path, layout=layout)
    kept = recording.feet["right" if lost == "left" else "left"].force
    assert np.isfinite(kept).sum(axis=0).min() >= 49  # but for a shift at the ends
    force = recording.feet[lost].force
    at = recording.time - recording.time[0] + (0.0 if len(recording.time) == 50 else shift)
    gone = (at > span[0] + 0.02) & (at < span[1] - 0.02)
    assert np.isnan(force[gone]).all()
    assert np.isfinite(force[(at < span[0] - 0.02) | (at > span[1] + 0.02)]).all()


def clock(seconds: float, form: str) -> str:
    """A time after 23:59:59.8 on the last day of a year, so that midnight passes."""
    hours, rest = divmod(86399.8 + seconds, 3600.0)
    minutes, rest = divmod(rest, 60.0)
    day = "2023-12-31" if hours < 24 else "2024-01-01"
    text = f"{int(hours) % 24:02d}:{int(minutes):02d}:{rest:06.3f}"
    half = f"{(int(hours) - 1) % 12 + 1}{text[2:]} {'AM' if int(hours) % 24 < 12 else 'PM'}"
    forms = {
        "day": text,
        "comma": text.replace(".", ","),
        "colon": text.replace(".", ":"),
        "iso": f"{day}T{text}",
        "date": f"{day} {text}",
    }
    return (forms | {"german": f"{day[8:]}.{day[5:7]}.{day[:4]} {text}", "half": half})[form]


@pytest.mark.parametrize("form", ["day", "comma", "colon", "iso", "date", "german", "half"])
@pytest.mark.parametrize("delimiter", [";", "\t", ",", "|"])
@pytest.mark.parametrize("header", [True, False])
def test_times_of_day_and_dates(tmp_path, layout, values, form, delimiter, header):
    if form == "comma" and delimiter == ",":
        return  # would be two cells
    names = delimiter.join(["Time", *(f"left {i} [kPa]" for i in layout.ids)])
    rows = [delimiter.join([clock(0.01 * k, form), *(f"{v:g}" for v in row)]) for k, row in enumerate(values)]
    path = tmp_path / "table.csv"
    path.write_text("\n".join([names] * header + rows) + "\n")
    assert detect_format(path).name == "csv"
    options = ReadOptions(layout=layout, unit="kPa", side="left")
    recording = read_recording(path, options=options)
    assert recording.time == pytest.approx(np.arange(50) * 0.01, abs=1e-6)
    assert recording.rate_hz == pytest.approx(100.0)
    assert recording.feet["left"].force == pytest.approx(values * 1e3 * layout.areas)


def test_times_of_day_in_the_last_column_of_rows_that_may_be_damaged(tmp_path, layout):
    """Also where the last line that is looked at first is the damaged one."""
    names = [*(f"left {i} [kPa]" for i in layout.ids), "Time"]
    rows = [[*("1" for _ in layout.ids), clock(0.01 * k, "day")] for k in range(100)]
    for damaged in (0, 30, 58, 59):
        lines = [",".join(row if k != damaged else row[:3]) for k, row in enumerate([names, *rows], -1)]
        path = tmp_path / "table.csv"
        path.write_text("\n".join(lines) + "\n")
        recording = read_recording(path, layout=layout)
        assert recording.time == pytest.approx(np.arange(100) * 0.01 + recording.time[0], abs=1e-6)
        assert any("damaged row" in warning for warning in recording.warnings)


@pytest.mark.parametrize(
    ("name", "factor"), [("time [min]", 60.0), ("time_min", 60.0), ("t (h)", 3600.0), ("time [s]", 1.0)]
)
def test_times_in_minutes_and_hours(tmp_path, layout, values, name, factor):
    columns = both(layout, values)
    columns = {name: columns.pop("time [s]") / factor, **columns}
    path = tmp_path / "table.csv"
    lines = [
        ",".join(columns),
        *(",".join(f"{v:.12g}" for v in row) for row in np.column_stack(list(columns.values()))),
    ]
    path.write_text("\n".join(lines) + "\n")
    recording = read_recording(path, layout=layout)
    assert recording.rate_hz == pytest.approx(100.0, rel=1e-6)
    assert recording.time[-1] == pytest.approx(0.49, rel=1e-6)


@pytest.mark.parametrize("before", ["", "Elapsed ", "frame_"])
@pytest.mark.parametrize("word", ["Time", "t", "Timestamp", "Zeit"])
@pytest.mark.parametrize(
    ("after", "seconds"), [(" [s]", 1.0), ("_ms", 1e-3), ("/s", 1.0), (" (usec)", 1e-6), (" in min", 60.0), ("", 0.0)]
)
def test_names_of_times_say_their_unit(before, word, after, seconds):
    assert time_unit(before + word + after) == seconds


@pytest.mark.parametrize(
    "name", ["T [C]", "T (deg)", "min", "h", "left 1", "t1", "time to peak", "total [N]", "temperature", ""]
)
def test_other_names_are_no_times(name):
    assert time_unit(name) is None


def test_quoted_numbers_may_have_a_decimal_comma(tmp_path, layout, values):
    columns = both(layout, values)
    names = ",".join(f'"{name}, of the insole"' if i == 0 else f'"{name}"' for i, name in enumerate(columns))
    rows = [",".join(f'"{v:.6g}"'.replace(".", ",") for v in row) for row in np.column_stack(list(columns.values()))]
    path = tmp_path / "table.csv"
    path.write_text("\n".join([names, *rows]) + "\n")
    assert detect_format(path).name == "csv"
    recording = read_recording(path, layout=layout)
    assert recording.feet["right"].force == pytest.approx(2.0 * values * 1e3 * layout.areas)


def test_times_that_begin_again_are_told(tmp_path, layout, values):
    """Two recordings one after the other, with the row of names between them or without."""
    path = tmp_path / "table.csv"
    values = np.tile(values, (3, 1))
    columns = {"time [s]": np.arange(150) * 0.01} | {f"left {i} [kPa]": values[:, k] for k, i in enumerate(layout.ids)}
    write_csv(path, columns)
    text = path.read_text()
    for again, frame in ((text, 152), (text.partition("\n")[2], 151)):
        path.write_text(text + again)
        (told,) = [w for w in read_recording(path, layout=layout).warnings if "not in order" in w]
        assert told.endswith(
            f"begin again at frame {frame}: several recordings in one file? A contact there may be made of two"
        )
    columns["time [s]"] = np.random.default_rng(0).permutation(columns["time [s]"])
    write_csv(path, columns)
    assert not any("begin again" in w for w in read_recording(path, layout=layout).warnings)


def test_stated_raw_counts_are_told(tmp_path, layout, values):
    path = tmp_path / "table.csv"
    write_csv(path, both(layout, values, "[raw]"))
    recording = read_recording(path, layout=layout)
    assert recording.raw
    assert sum("raw counts" in warning for warning in recording.warnings) == 1


def test_times_that_count_the_frames_of_a_stated_rate(tmp_path):
    rows = ["# rate: 50", "time,left 1 [N],left 2 [N]", *(f"{k},{k % 40},3" for k in range(100))]
    (tmp_path / "counted.csv").write_text("\n".join(rows) + "\n")
    assert read_recording(tmp_path / "counted.csv").rate_hz == 50.0


def test_times_of_a_clock_count_from_the_first_frame_and_it_is_told(tmp_path, layout):
    rows = ["time [s]," + ",".join(f"left {i} [N]" for i in layout.ids)]
    rows += [f"{1.7e9 + k / 100:.2f}," + ",".join("1" for _ in layout.ids) for k in range(50)]
    (tmp_path / "clock.csv").write_text("\n".join(rows) + "\n")
    recording = read_recording(tmp_path / "clock.csv", layout=layout)
    assert recording.time == pytest.approx(np.arange(50) / 100, abs=1e-6)
    assert "the times begin at 1700000000 s: here they count from the first frame" in recording.warnings
