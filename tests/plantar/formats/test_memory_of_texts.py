"""Text exports are read in memory once, and files that would make much of little are refused at once."""

from collections.abc import Callable, Iterable, Iterator

import numpy as np
import pytest

from plantar.errors import FormatError
from plantar.formats import ReadOptions, read_recording
from plantar.formats.text import blocks_of_lines, open_text
from plantar.recordings.frame_table import FrameTable

TEKSCAN = (
    "DATA_TYPE MOVIE\nROWS {}\nCOLS {}\nROW_SPACING 5 mm\nCOL_SPACING 5 mm\nSECONDS_PER_FRAME 0.01\nUNITS KPa\n"
    "FILENAME left.fsx\nASCII_DATA @@\n\n"
)
TABLE = "time [s],left 1 [N],left 2 [N],left 3 [N]\n"
EMED = (
    "\t\t\t\tPage 1\n\tFile: 1.dat \tMatrix: {} \n\tSensor area: 0.25 cm2\tTime/picture:10.0 ms\n"
    "\tSensor size: 0.500x0.500 cm\n"
)
PEDAR = (
    "file type:\tx\nsensor type:\tX99L\nscanning rate[Hz]:\t50\npressure values in kPa\n\ntime[secs]\t"
    + "\t".join(map(str, range(1, 100)))
    + "\n"
)
MOTICON = "# start: x\n# time\tleft pressure 1[N/cm2]\tleft pressure 2[N/cm2]\tleft pressure 3[N/cm2]\n"
XSENSOR = "FRAME,1\nTIME,00:00:00.01\nSENSOR,LEFT\nRows,{}\nColumns,{}\nSENSELS\n"
ROW = "1.0\t" * 98 + "1.0\n"

HOSTILE: dict[str, tuple[str, Callable[[], Iterable[str]], str]] = {
    "tekscan: a line without an end": (
        "tekscan",
        lambda: [TEKSCAN.format(6, 5), "Frame 1\n", "0," * 3_000_000],
        "line",
    ),
    "tekscan: a frame without an end": (
        "tekscan",
        lambda: [TEKSCAN.format(6, 5), "Frame 1\n", "0,0,0,0,0\n" * 1_000_000],
        "the first frame has no end",
    ),
    "tekscan: frames of a huge matrix without a row": (
        "tekscan",
        lambda: [TEKSCAN.format(400, 500), *(f"Frame {i}\n" + "0," * 499 + "0\n" for i in range(1, 3000))],
        "of 32 frames are no matrix of 400 x 500",
    ),
    "tekscan: a matrix of any size": (
        "tekscan",
        lambda: [TEKSCAN.format(10**9, 10**9), "Frame 1\n0\n"],
        "cannot be read",
    ),
    "csv: a wide header over short rows": (
        "csv",
        lambda: [",".join(f"left {i}" for i in range(90_000)) + "\n", "1\n" * 500_000],
        "another width",
    ),
    "csv: more columns than any sensor has": (
        "csv",
        lambda: ["a," * 200_000 + "\n", "1,1\n" * 9],
        "allowed: up to 100000",
    ),
    "csv: short rows": ("csv", lambda: [TABLE, "1\n" * 3_000_000], "another width"),
    "emed: a huge matrix of one cell a frame": (
        "emed",
        lambda: [EMED.format("1000x1000"), *(f"\tPict-No.: {i} F\n\t1\tForce\n1\t5\t1\n\n" for i in range(20_000))],
        "frames of 1000 x 1000 cells are more than its tables can mean",
    ),
    "emed: pages without a table": (
        "emed",
        lambda: [EMED.format("64x95"), *(f"\tPict-No.: {i} F\n" for i in range(500_000))],
        "hold no table",
    ),
    "emed: one frame on any number of pages": (
        "emed",
        lambda: [EMED.format("64x95"), *(f"\tPict-No.: 1 F\n\t{i}\n1\t5\n\n" for i in range(60_000))],
        "rows and columns 1 to 1024",
    ),
    "pedar: rows that are none": ("pedar", lambda: [PEDAR, "x\n" * 3_000_000], "no whole frame"),
    "pedar: a header without an end": ("pedar", lambda: ["x" * 900_000 + "\n"] * 20, "no row of column names"),
    "moticon: short rows": ("moticon", lambda: [MOTICON, "1\n" * 3_000_000], "another width than 4"),
    "moticon: a header without an end": ("moticon", lambda: ["# a: b\n" * 3_000_000], "no line names the channels"),
    "xsensor: wide rows that are damaged": (
        "xsensor",
        lambda: [XSENSOR.format(100, 1000), "1\n" * 500_000],
        "no frame with a matrix",
    ),
    "xsensor: frames without a matrix": (
        "xsensor",
        lambda: [XSENSOR.format(1, 1000), "1," * 999 + "1\n", "FRAME,2\n" * 500_000],
        "hold a matrix",
    ),
    "xsensor: sensors without end": (
        "xsensor",
        lambda: ["FRAME,1\n", *(f"SENSOR,s{i}\nSENSELS\n1,2\n3,4\n" for i in range(50_000))],
        "sensors",
    ),
}


@pytest.mark.sample(6)
@pytest.mark.parametrize("name", HOSTILE)
def test_what_would_make_much_of_little_is_refused(tmp_path, within, name):
    kind, pieces, words = HOSTILE[name]
    path = tmp_path / "file"
    with path.open("w") as stream:
        stream.writelines(pieces())
    with within(megabytes=400, seconds=5.0), pytest.raises(FormatError, match=words) as caught:
        read_recording(path, kind)
    assert "\n" not in str(caught.value)


NAMES = {
    "csv: a comment of blanks and letters": ("csv", "#" + " a" * 300_000 + "\n" + TABLE),
    "csv: a name of blanks": ("csv", "time" + " " * 500_000 + "x,left 1 [N" + " " * 300_000 + ",left 2 [N]\n"),
    "moticon: a name of blanks": ("moticon", "# time\tleft a" + " " * 500_000 + "x\tleft pressure 1\n"),
    "tekscan: a number of a frame of any length": ("tekscan", TEKSCAN.format(1, 3) + "Frame " + "9" * 6000 + "\n"),
}


@pytest.mark.parametrize("name", NAMES)
def test_names_and_numbers_of_any_length_take_no_time(tmp_path, within, name):
    kind, head = NAMES[name]
    path = tmp_path / "file"
    path.write_text(
        head + "".join(f"0.{i:02d},1,2,3\n".replace(",", "\t" if kind == "moticon" else ",") for i in range(90))
    )
    with within(megabytes=200, seconds=5.0):
        try:
            read_recording(path, kind)
        except FormatError as error:
            assert "\n" not in str(error)  # noqa: PT017  either way will do


def tekscan(frames: int) -> Iterator[str]:
    random = np.random.default_rng(0)
    bodies = []
    for _ in range(5):
        matrix = random.integers(0, 900, (60, 21))
        bodies.append(
            "".join(",".join("B" if k < 4 else f"{v}.25" for k, v in enumerate(row)) + "\n" for row in matrix)
        )
    yield TEKSCAN.format(60, 21)
    for i in range(frames):
        yield f"Frame {i + 1}\n{bodies[i % 5]}\n"


def pedar(frames: int) -> Iterator[str]:
    yield PEDAR
    for i in range(frames):
        yield f"{0.02 * i:.2f}\t{ROW}"


def table(frames: int) -> Iterator[str]:
    yield "time [s]," + ",".join(f"left {i} [N]" for i in range(99)) + "\n"
    for i in range(frames):
        yield f"{0.01 * i:.2f}," + ROW.replace("\t", ",")


def moticon(frames: int) -> Iterator[str]:
    yield "# time\t" + "\t".join(f"left pressure {i + 1}[N/cm2]" for i in range(16)) + "\n"
    for i in range(frames):
        yield f"{0.01 * i:.2f}\t" + "\t".join(["1.00"] * 16) + "\n"


def xsensor(frames: int) -> Iterator[str]:
    for i in range(frames):
        yield f"FRAME,{i}\nTIME,00:{i // 6000:02d}:{i // 100 % 60:02d}.{i % 100:02d}\n"
        yield "SENSOR,LEFT\nRows,31\nColumns,11\nSENSELS\n" + ("1.00," * 10 + "1.00\n") * 31


LONG = {
    "tekscan": (tekscan, 4000, 60 * 17),
    "pedar": (pedar, 60_000, 99),
    "csv": (table, 60_000, 99),
    "moticon": (moticon, 100_000, 16),
    "xsensor": (xsensor, 8_000, 341),
}


@pytest.mark.sample(2)
@pytest.mark.parametrize("kind", LONG)
def test_a_long_recording_is_in_memory_once(tmp_path, within, kind):
    """The array that comes out is 13 to 49 MB large; a second one of it would not find room."""
    make, frames, cells = LONG[kind]
    path = tmp_path / "file"
    with path.open("w") as stream:
        stream.writelines(make(frames))
    with within(megabytes=1.6 * frames * cells * 8 / 1e6 + 25, seconds=60.0):
        recording = read_recording(path, kind, options=ReadOptions(side="left"))
    assert recording.feet["left"].force.shape == (frames, cells)


def test_a_table_that_outgrows_its_estimate_keeps_its_rows():
    values = np.arange(3000.0).reshape(1000, 3)
    table = FrameTable(3, expected=10)
    for start in range(0, 1000, 7):
        table.add(values[start : start + 7])
    assert (table.rows == values).all()
    table.drop_last()
    assert len(table) == 999
    kept = np.array([True, False, True])
    assert (table.columns(kept) == values[:-1, kept]).all()
    assert len(table) == 0


def test_a_table_of_more_than_can_be_held_is_refused():
    table = FrameTable(1_000_000, expected=0)
    with pytest.raises(FormatError, match=r"more than 400 frames of 1000000 values; allowed: 400 million values"):
        table.add(np.broadcast_to(0.0, (401, 1_000_000)))


def test_blocks_hold_all_lines_in_order():
    lines = [f"{i}\n" * (1 + i % 3) for i in range(1000)]
    blocks = list(blocks_of_lines(iter(lines), most=50, characters=100))
    assert [line for block in blocks for line in block] == lines
    assert max(map(len, blocks)) <= 50


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "latin-1", "utf-8-sig"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_lines_of_any_encoding_and_end_are_one(tmp_path, encoding, end):
    path = tmp_path / "file"
    lines = [f"größe {i}" for i in range(50_000)]
    path.write_bytes(end.join(lines).encode(encoding))
    with open_text(path) as stream:
        assert [line.rstrip("\n") for line in stream] == lines
