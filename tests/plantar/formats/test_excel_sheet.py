"""Binary Excel workbooks, written here record by record, are read as the text that they would be saved as."""

import struct

import numpy as np
import pytest

from plantar.formats import detect_format, read_recording
from plantar.formats.excel_sheet import lines_of_workbook

from .corruption import refusals


def record(kind: int, body: bytes) -> bytes:
    return struct.pack("<HH", kind, len(body)) + body


def workbook(rows: list[list[float | str]]) -> bytes:
    """A workbook of one sheet: texts shared, whole numbers packed, others as doubles."""
    texts = list(dict.fromkeys(cell for row in rows for cell in row if isinstance(cell, str)))
    shared = struct.pack("<II", len(texts), len(texts))
    cut = b""
    for i, text in enumerate(texts):
        coded = struct.pack("<HB", len(text), 1) + text.encode("utf-16-le")
        if i == 0 and len(text) > 4:  # the first one goes on in another record, with narrow letters
            shared += struct.pack("<HB", len(text), 1) + text[:4].encode("utf-16-le")
            cut = b"\0" + text[4:].encode("latin-1")
        elif cut:
            cut += coded
        else:
            shared += coded
    stream = record(0x0809, b"\0" * 16) + record(0x00FC, shared) + (record(0x003C, cut) if cut else b"")
    stream += record(0x000A, b"") + record(0x0809, b"\0" * 16)
    for r, row in enumerate(rows):
        for c, cell in enumerate(row):
            at = struct.pack("<HHH", r, c, 0)
            if isinstance(cell, str):
                stream += record(0x00FD, at + struct.pack("<I", texts.index(cell)))
            elif cell == int(cell):
                stream += record(0x027E, at + struct.pack("<i", (int(cell) << 2) | 2))
            else:
                stream += record(0x0203, at + struct.pack("<d", cell))
    stream += record(0x000A, b"")
    stream = stream.ljust(max(4096, -(-len(stream) // 512) * 512), b"\0")
    count = len(stream) // 512
    fats = -(-(count + 2) // 127)
    table = [0xFFFFFFFD] * fats + [0xFFFFFFFE] + list(range(fats + 2, fats + 1 + count)) + [0xFFFFFFFE]
    fat = b"".join(struct.pack("<I", n) for n in table).ljust(512 * fats, b"\xff")

    def entry(name: str, kind: int, start: int, size: int) -> bytes:
        coded = (name + "\0").encode("utf-16-le")
        return (
            coded.ljust(64, b"\0") + struct.pack("<HB", len(coded), kind) + b"\0" * 49 + struct.pack("<IQ", start, size)
        )

    directory = (entry("Root Entry", 5, 0xFFFFFFFE, 0) + entry("Workbook", 2, fats + 1, len(stream))).ljust(512, b"\0")
    head = bytearray(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1".ljust(512, b"\0"))
    struct.pack_into("<HHHHH", head, 0x18, 0x3E, 3, 0xFFFE, 9, 6)
    struct.pack_into("<II", head, 0x2C, fats, fats)
    struct.pack_into("<IIIII", head, 0x38, 4096, 0xFFFFFFFE, 0, 0xFFFFFFFE, 0)
    struct.pack_into("<109I", head, 0x4C, *range(fats), *[0xFFFFFFFF] * (109 - fats))
    return bytes(head) + fat + directory + stream


def test_cells_of_all_kinds():
    rows: list[list[float | str]] = [["Time (s)", "Kräfte", "x"], [0.0, 1.5, -3.0], [1e-3, 123456789.25, "end"]]
    assert lines_of_workbook(workbook(rows)) == ["Time (s)\tKräfte\tx", "0\t1.5\t-3", "0.001\t123456789.25\tend"]


def test_a_plate(tmp_path):
    rows: list[list[float | str]] = [["footscan entire plate roll off"]]
    for i in range(30):
        rows.append([f"Frame {i} ({12.5 * i:g} ms)"])
        frame = np.zeros((20, 64))
        frame[4:16, 30:40] = 6.5 if 5 < i < 25 else 0.0
        rows += frame.tolist()
    path = tmp_path / "plate.xls"
    path.write_bytes(workbook(rows))
    assert detect_format(path).name == "xls"
    recording = read_recording(path)
    assert recording.format == "footscan"
    assert recording.path == path
    (foot,) = recording.feet.values()
    assert foot.vertical_force.max() == pytest.approx(6.5 * 120)


def test_damage_is_refused_in_one_line(tmp_path):
    path = tmp_path / "walk.xls"
    path.write_bytes(
        workbook([["Time (s)", "Left Fz (N)", "Right Fz (N)"], *([0.01 * i, 700.5, 650.0] for i in range(60))])
    )
    assert sorted(read_recording(path).feet) == ["left", "right"]
    assert len(refusals(path, trials=60, header=1600)) > 5
