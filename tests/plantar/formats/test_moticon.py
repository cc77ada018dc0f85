"""The Moticon reader, on exports of every kind that the format allows."""

import numpy as np
import pytest

from plantar import FormatError
from plantar.formats import detect_format, read_recording
from plantar.formats.format import ReadOptions
from plantar.formats.nominal_insole import moticon_insole

from .corruption import survive_corruption

AREAS = moticon_insole(7, "left").areas


def export(
    path,
    feet,
    *,
    unit="N/cm²",
    factor=1e4,
    total=True,
    cop=True,
    size=7,
    rate=100.0,
    end="\n",
    comma=False,
    missing=None,
    events=False,
    header=True,
):
    """Write pressures (n, 16) of each foot; the total force is that of the insole's own areas."""
    n = len(next(iter(feet.values())))
    names = ["time"]
    columns: list[list[str]] = [[f"{i / rate:.3f}" for i in range(n)]]
    for side, pressure in feet.items():
        gone = np.zeros(n, dtype=bool)
        if missing and side in missing:
            gone[missing[side]] = True

        def column(values: np.ndarray, digits: int = 2, gone: np.ndarray = gone) -> list[str]:
            return ["" if g else f"{v:.{digits}f}" for v, g in zip(values, gone, strict=True)]

        for c in range(16):
            names.append(f"{side} pressure {c + 1}" + (f"[{unit}]" if unit else ""))
            columns.append(column(pressure[:, c]))
        names.append(f"{side} acceleration X[g]")
        columns.append(column(np.zeros(n), 6))
        force = pressure @ (AREAS * factor)
        if total:
            names.append(f"{side} total force[N]")
            columns.append(column(force))
        if cop:
            for axis, at in (("X", -0.1), ("Y", 0.2)):
                names.append(f"{side} center of pressure {axis}[-0.5...+0.5]")
                columns.append(column(np.full(n, at), 6))
    if events:
        names += ["Left Events label[]", "Left Events[]", "left steps[]"]
        columns += [
            ["Event" if i == 7 else "" for i in range(n)],
            ["1.00" if i == 7 else "" for i in range(n)],
            [""] * n,
        ]
    head = ["# Start time: 27.09.2023 10:21:14.922", "# Duration: 00:17.496", "# Sensor insoles: Left SN1, Right SN2"]
    head += [f"# Size: {size}"] if size is not None else []
    lines = [*(head if header else []), "# " + "\t".join(names)]
    lines += ["\t".join(row) for row in zip(*columns, strict=True)]
    text = end.join(lines) + end
    if comma:
        first = text.index("\n", text.index("# time")) + 1
        text = text[:first] + text[first:].replace(".", ",")
    path.write_bytes(text.encode())


@pytest.fixture
def feet():
    random = np.random.default_rng(3)
    share = np.abs(np.sin(np.linspace(0.0, 9.0, 200)))[:, None]
    return {side: np.round(share * random.uniform(0.0, 6.0, size=(1, 16)) * 4.0) / 4.0 for side in ("left", "right")}


def test_two_insoles_with_dropouts(tmp_path, feet):
    path = tmp_path / "walk.txt"
    export(path, feet, missing={"left": slice(0, 50), "right": slice(100, 103)}, events=True)
    assert detect_format(path).name == "moticon"
    recording = read_recording(path)
    assert (len(recording.time), recording.rate_hz) == (200, pytest.approx(100.0))
    for side, gone in (("left", slice(0, 50)), ("right", slice(100, 103))):
        foot = recording.feet[side]
        missing = np.zeros(200, dtype=bool)
        missing[gone] = True
        assert (np.isnan(foot.vertical_force) == missing).all()  # a dropout is no zero
        assert (np.isnan(foot.force).all(axis=1) == missing).all()
        truth = feet[side] @ (AREAS * 1e4)
        assert foot.vertical_force[~missing] == pytest.approx(truth[~missing], abs=0.01)
        cop = foot.center_of_pressure(20.0)
        loaded = ~missing & (truth > 20.5)
        assert cop[loaded, 0] == pytest.approx(0.4 * 0.297)
        outward = 1.0 if side == "right" else -1.0
        assert cop[loaded, 1] == pytest.approx(outward * 0.2 * 0.31 * 0.297)


@pytest.mark.parametrize(
    "options",
    [
        {"end": "\r\n"},
        {"comma": True},
        {"unit": "kPa", "factor": 1e3},
        {"rate": 50.0},
        {"header": False},
        {"total": False, "cop": False},
    ],
)
def test_ways_to_write_it(tmp_path, feet, options):
    path = tmp_path / "walk.txt"
    export(path, feet, **options)
    recording = read_recording(path)
    truth = feet["left"] @ (AREAS * float(options.get("factor", 1e4)))
    assert recording.feet["left"].vertical_force == pytest.approx(truth, abs=0.01)
    assert recording.rate_hz == pytest.approx(float(options.get("rate", 100.0)))
    if "header" in options:
        assert any("size 7) is assumed" in w for w in recording.warnings)
    if "total" in options:
        assert any("no total force" in w for w in recording.warnings)


def test_one_foot_and_units(tmp_path, feet):
    path = tmp_path / "walk.txt"
    export(path, {"right": feet["right"]})
    recording = read_recording(path)
    assert list(recording.feet) == ["right"]
    assert any("right foot only" in w for w in recording.warnings)
    export(path, feet, unit="")
    assert any("N/cm2 is assumed" in w for w in read_recording(path).warnings)
    export(path, feet, unit="kPa")  # with a total force of N/cm2: the unit is wrong
    assert any("check the unit" in w for w in read_recording(path).warnings)
    export(path, feet, unit="Q")
    with pytest.raises(FormatError, match="unknown unit of pressure 'Q'"):
        read_recording(path)
    raw = read_recording(path, options=ReadOptions(unit="raw"))
    assert raw.raw
    assert raw.feet["left"].vertical_force == pytest.approx(feet["left"].sum(axis=1))


@pytest.mark.parametrize("value", ["", "0"])
def test_an_empty_column_of_the_total_force_is_none(tmp_path, feet, value):
    path = tmp_path / "walk.txt"
    export(path, feet)
    lines = path.read_text().splitlines()
    first = next(i for i, line in enumerate(lines) if "left pressure 1" in line)
    at = next(i for i, name in enumerate(lines[first].split("\t")) if "left total force" in name)
    rows = [line.split("\t") for line in lines[first + 1 :]]
    text = ["\t".join([*row[:at], value, *row[at + 1 :]]) for row in rows]
    path.write_text("\n".join([*lines[: first + 1], *text]) + "\n")
    recording = read_recording(path)
    assert any("no total force of the left foot" in w for w in recording.warnings)
    assert recording.feet["left"].vertical_force == pytest.approx(recording.feet["right"].vertical_force, rel=1.0)


def test_a_cut_end_and_damaged_values(tmp_path, feet):
    path = tmp_path / "walk.txt"
    export(path, feet)
    text = path.read_text()
    path.write_text(text[:-60])
    recording = read_recording(path)
    assert len(recording.time) == 199
    assert any("cut short" in w for w in recording.warnings)
    lines = text.splitlines()
    lines[20] = lines[20].replace("\t", "\tx", 1)
    lines[30] = lines[30][:40]
    path.write_text("\n".join(lines) + "\n")
    damaged = read_recording(path)
    assert len(damaged.time) == 200
    assert np.isnan(damaged.feet["right"].force).any(axis=1).sum() == 1
    assert any("1 damaged row" in w for w in damaged.warnings)
    assert any("1 value(s) are no numbers" in w for w in damaged.warnings)


def test_a_channel_that_is_there_twice_is_refused(tmp_path, feet):
    path = tmp_path / "walk.txt"
    export(path, feet)
    path.write_text(path.read_text().replace("right ", "left "))
    with pytest.raises(FormatError, match="the channel 'left pressure 1' is there twice"):
        read_recording(path)


def test_damage(tmp_path, feet):
    path = tmp_path / "walk.txt"
    export(path, feet)
    assert survive_corruption(path) > 15 / 40
    path.write_text("# time\tleft pressure 1[N/cm²]\n")
    with pytest.raises(FormatError, match="no row of data"):
        read_recording(path)
