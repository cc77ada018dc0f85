"""Binary Excel workbooks, written here record by record, are read as the text that they would be saved as."""

import struct
from pathlib import Path

import numpy as np
import pytest

from plantar import FormatError
from plantar.formats import detect_format, read_recording
from plantar.formats.excel_sheet import text_of_workbook

from .corruption import refusals


def record(kind: int, body: bytes) -> bytes:
    return struct.pack("<HH", kind, len(body)) + body


def workbook(rows: list[list[float | str]], more: bytes = b"", first: bytes = b"") -> bytes:
    """A workbook of one sheet: texts shared, whole numbers packed, others as doubles; `more` cells, `first` records."""
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
    texts_of_book = first + record(0x00FC, shared) + (record(0x003C, cut) if cut else b"") + record(0x000A, b"")
    begin, name = struct.pack("<HHHHII", 0x0600, 5, 0, 1997, 0, 6), b"\x04\0Walk"
    length = len(record(0x0809, begin)) + len(record(0x0085, bytes(6) + name)) + len(texts_of_book)
    stream = bytearray(record(0x0809, begin) + record(0x0085, struct.pack("<IH", length, 0) + name) + texts_of_book)
    stream += record(0x0809, struct.pack("<HHHHII", 0x0600, 0x10, 0, 1997, 0, 6))
    for r, row in enumerate(rows):
        for c, cell in enumerate(row):
            at = struct.pack("<HHH", r, c, 0)
            if isinstance(cell, str):
                stream += record(0x00FD, at + struct.pack("<I", texts.index(cell)))
            elif cell == int(cell):
                stream += record(0x027E, at + struct.pack("<i", (int(cell) << 2) | 2))
            else:
                stream += record(0x0203, at + struct.pack("<d", cell))
    stream += more + record(0x000A, b"")
    stream = stream.ljust(max(4096, -(-len(stream) // 512) * 512), b"\0")
    count = len(stream) // 512
    fats = -(-(count + 2) // 127)
    table = [0xFFFFFFFD] * fats + [0xFFFFFFFE] + list(range(fats + 2, fats + 1 + count)) + [0xFFFFFFFE]
    fat = b"".join(struct.pack("<I", n) for n in table).ljust(512 * fats, b"\xff")

    def entry(name: str, kind: int, child: int, start: int, size: int) -> bytes:
        coded = (name + "\0").encode("utf-16-le")
        links = struct.pack("<HBBiii", len(coded), kind, 1, -1, -1, child)
        return coded.ljust(64, b"\0") + links + bytes(36) + struct.pack("<IQ", start, size)

    directory = entry("Root Entry", 5, 1, 0xFFFFFFFE, 0) + entry("Workbook", 2, -1, fats + 1, len(stream))
    directory = directory.ljust(512, b"\0")
    head = bytearray(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1".ljust(512, b"\0"))
    struct.pack_into("<HHHHH", head, 0x18, 0x3E, 3, 0xFFFE, 9, 6)
    struct.pack_into("<II", head, 0x2C, fats, fats)
    struct.pack_into("<IIIII", head, 0x38, 4096, 0xFFFFFFFE, 0, 0xFFFFFFFE, 0)
    struct.pack_into("<109I", head, 0x4C, *range(fats), *[0xFFFFFFFF] * (109 - fats))
    return bytes(head) + fat + directory + stream


def text_of(path: Path) -> list[str]:
    return text_of_workbook(path)["text"].tobytes().decode().splitlines()


def test_cells_of_all_kinds(tmp_path):
    rows: list[list[float | str]] = [["Time (s)", "Kräfte", "x"], [], [0.0, 1.5, -3.0], [1e-3, 123456789.25, "end"]]
    path = tmp_path / "cells.xls"
    path.write_bytes(workbook(rows))
    assert text_of(path) == ["Time (s)\tKräfte\tx", "0\t1.5\t-3", "0.001\t123456789.25\tend"]


def test_formulas_are_their_results(tmp_path):
    """A formula's text follows in a record of its own; a truth value and an error leave the cell empty."""
    results = (struct.pack("<d", 2.5), b"\0" * 6 + b"\xff\xff", b"\1\0\1\0\0\0\xff\xff", b"\2\0\7\0\0\0\xff\xff")
    cells = [struct.pack("<HHH", 1, c, 0) + result + bytes(8) for c, result in enumerate(results)]
    text = record(0x0207, struct.pack("<HB", 4, 0) + b"left")
    path = tmp_path / "formulas.xls"
    path.write_bytes(workbook([["a", "b", "c", "d"]], b"".join([record(6, c) + text * (c is cells[1]) for c in cells])))
    assert text_of(path) == ["a\tb\tc\td", "2.5\tleft\t\t"]


def test_what_is_no_recording_is_refused(tmp_path):
    path = tmp_path / "walk.xls"
    for data, message in (
        (workbook([]), "the workbook holds no cells"),
        (workbook([["a"]], first=record(0x002F, bytes(4))), r"\(XLRDError: Workbook is encrypted\)"),
        (workbook([["a"]])[:700], r"not a workbook that can be read \(\w+: "),
    ):
        path.write_bytes(data)
        with pytest.raises(FormatError, match=message):
            read_recording(path)


def test_a_refusal_names_the_workbook_alone(tmp_path):
    path = tmp_path / "report.xls"
    path.write_bytes(workbook([["Estimate", "SE"], [0.5, 0.1], [0.25, 0.2]]))
    with pytest.raises(FormatError) as refused:
        read_recording(path)
    assert str(refused.value).startswith(f"{path}: ")
    assert ".txt" not in str(refused.value).partition("known: ")[0]


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
    assert len(refusals(path, trials=8, header=1600)) > 1
