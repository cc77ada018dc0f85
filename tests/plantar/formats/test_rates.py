"""A rate that no device has is refused by every reader, whatever states it."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from plantar.errors import FormatError, InputError
from plantar.formats import ReadOptions, read_recording
from plantar.recordings.pressure_recording import RATES, possible_rate, sampling

ROWS = "1,2,3\n4,5,6\n"


def tekscan(path: Path, period: str) -> None:
    frames = "".join(f"Frame {i}\n{ROWS}\n" for i in range(1, 30))
    head = "DATA_TYPE MOVIE\nROWS 2\nCOLS 3\nROW_SPACING 5 mm\nCOL_SPACING 5 mm\nUNITS KPa\nFILENAME left.fsx\n"
    path.write_text(f"{head}SECONDS_PER_FRAME {period}\nASCII_DATA @@\n\n{frames}")


def emed(path: Path, period: str) -> None:
    page = "\tPict-No.: {}  Force[N]=sum\n\t1\t2\tForce\n1\t5.0\t6.0\t0.28\nForce\t0.13\t0.15\t0.28\n\f\n"
    head = f"\tFile: left.dat \tMatrix: 2x2 \n\tSensor area: 0.25 cm2\tTime/picture:{period} s\n"
    path.write_text(f"\t\t\t\tPage 1\n{head}\tSensor size: 0.500x0.500 cm\n" + "".join(map(page.format, range(1, 30))))


def pedar(path: Path, period: str) -> None:
    rows = "".join(f"{0.02 * i:.2f}\t" + "1.0\t" * 98 + "1.0\n" for i in range(30))
    cells = "\t".join(map(str, range(1, 100)))
    head = f"sensor type:\tX99L\ntime per frame[secs]:\t{period}\npressure values in kPa\n\ntime[secs]\t{cells}\n"
    path.write_text(head + rows)


def rate_of_table(path: Path, period: str) -> None:
    value = 1.0 / float(period) if float(period) else float("inf")
    path.write_text(f"# rate: {value}\n# unit: N\nleft 1,left 2,left 3\n" + "1,2,3\n" * 40)


def times_of_table(path: Path, period: str) -> None:
    step = float(period)
    path.write_text("time [s],left 1 [N],left 2 [N]\n" + "".join(f"{step * i!r},1,2\n" for i in range(40)))


def rate_of_arrays(path: Path, period: str) -> None:
    with np.errstate(divide="ignore"), path.open("wb") as stream:
        np.savez(stream, left=np.ones((30, 4)), unit="N", rate_hz=1.0 / np.float64(period))


def times_of_arrays(path: Path, period: str) -> None:
    with np.errstate(over="ignore", invalid="ignore"), path.open("wb") as stream:
        np.savez(stream, left=np.ones((30, 4)), unit="N", time=np.arange(30) * np.float64(period))


KINDS: dict[str, tuple[Callable[[Path, str], None], str]] = {
    "tekscan": (tekscan, "tekscan"),
    "emed": (emed, "emed"),
    "pedar": (pedar, "pedar"),
    "rate of a table": (rate_of_table, "csv"),
    "times of a table": (times_of_table, "csv"),
    "rate of arrays": (rate_of_arrays, "arrays"),
    "times of arrays": (times_of_arrays, "arrays"),
}


@pytest.mark.parametrize("period", ["1e-300", "1e-7", "0", "0.0", "-0.02", "nan", "inf", "1e300", "60"])
@pytest.mark.parametrize("kind", KINDS)
def test_a_rate_that_no_device_has_is_one_line(tmp_path, kind, period):
    write, format_name = KINDS[kind]
    path = tmp_path / "file"
    write(path, period)
    if kind in ("pedar", "times of a table") and period in ("nan", "inf"):
        pytest.skip("what is no number is no statement here")
    with pytest.raises(
        FormatError, match=r"allowed: 0\.1 to 100000|is no number|no times that increase|frame times fall"
    ) as caught:
        read_recording(path, format_name)
    assert "\n" not in str(caught.value)
    read = read_recording(path, format_name, options=ReadOptions(rate_hz=50.0))
    assert read.rate_hz == 50.0
    assert np.diff(read.time) == pytest.approx(0.02)


@pytest.mark.parametrize("kind", KINDS)
def test_a_usual_rate_is_read(tmp_path, kind):
    write, format_name = KINDS[kind]
    path = tmp_path / "file"
    write(path, "0.02")
    assert read_recording(path, format_name).rate_hz == pytest.approx(50.0)


@pytest.mark.parametrize("rate", [0.0, -1.0, 0.09, 1.1e5, float("nan"), float("inf")])
def test_nobody_may_give_such_a_rate(tmp_path, rate):
    with pytest.raises(FormatError, match=r"the file states .* allowed: 0\.1 to 100000"):
        possible_rate(rate, "the file states")
    tekscan(tmp_path / "file", "0.02")
    with pytest.raises(InputError, match="allowed"):
        read_recording(tmp_path / "file", options=ReadOptions(rate_hz=rate))


def test_the_ends_of_the_range_are_in_it():
    for rate in RATES:
        assert possible_rate(rate, "") == rate


def test_frames_that_almost_coincide_have_no_velocity_of_any_size():
    time = 0.01 * np.arange(300.0)
    time[100] = time[99] + 1e-300
    time[200] = time[199] + 1e-15
    checked, rate, notes = sampling(time, None)
    assert rate == pytest.approx(100.0, rel=0.02)
    assert np.diff(checked).min() > 1e-6
    assert notes
    uneven = np.cumsum(np.random.default_rng(0).uniform(0.002, 0.05, 300))
    kept, _, notes = sampling(uneven, None)
    assert (kept == uneven).all()
    assert "not evenly spaced" in notes[0]


def test_exchanged_rows_leave_the_rate_as_it_is():
    time = 0.01 * np.arange(300.0).reshape(-1, 2)[:, ::-1].ravel()
    _, rate, notes = sampling(time, None)
    assert rate == pytest.approx(100.0)
    assert "not in order" in notes[0]


@pytest.mark.parametrize("stated", [None, 100.0])
def test_rows_in_reverse_order_are_refused(stated):
    time = 0.01 * np.arange(300.0)[::-1]
    time[::50] = time[10]
    with pytest.raises(FormatError, match=r"the frame times fall, from .* to .* s: are the rows in reverse order"):
        sampling(time, stated)
