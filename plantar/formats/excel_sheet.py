"""Binary Excel workbooks (.xls, BIFF8 in OLE2), as footscan exports: the fullest sheet as text.

Sources: [MS-CFB] and [MS-XLS], Microsoft.
"""

import struct
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from plantar.errors import FormatError
from plantar.files.input_file import read_input
from plantar.formats.format import Format, ReadOptions
from plantar.recordings.pressure_recording import PressureRecording

__all__ = ["FORMAT", "lines_of_workbook"]

_MAGIC = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
_LARGEST = 100_000_000
_MOST_CELLS, _LONGEST_LINE = 20_000_000, 16_384
_BOF, _EOF, _SST, _CONTINUE, _NUMBER, _RK, _MULRK, _LABELSST, _LABEL, _FORMULA = (
    *(0x0809, 0x000A, 0x00FC, 0x003C, 0x0203, 0x027E, 0x00BD, 0x00FD, 0x0204, 0x0006),
)


def _recognises(head: bytes) -> bool:
    return head.startswith(_MAGIC)


def lines_of_workbook(data: bytes) -> list[str]:
    """Rows of a workbook's fullest sheet, tabs between cells; FormatError if damaged, encrypted or empty."""
    try:
        sheets = _sheets(_stream(data))
    except (struct.error, IndexError, UnicodeDecodeError, ValueError) as error:
        raise FormatError(f"not an Excel workbook (.xls) that can be read ({type(error).__name__})") from None
    cells = max(sheets, key=len, default={})
    if not cells:
        raise FormatError("the workbook holds no cells")
    rows: dict[int, dict[int, str]] = {}
    for (row, column), text in cells.items():
        rows.setdefault(row, {})[column] = text
    return ["\t".join(rows[r].get(c, "") for c in range(max(rows[r]) + 1)) for r in sorted(rows)]


def _stream(data: bytes) -> bytes:
    """ "Workbook" stream of an OLE2 file."""
    if not data.startswith(_MAGIC) or len(data) < 1536:
        raise ValueError("no OLE2 file")
    shift, small = struct.unpack_from("<HH", data, 0x1E)
    if shift not in (9, 12) or small != 6:
        raise ValueError("sector size")
    size = 1 << shift
    most = len(data) // size + 1

    def sector(number: int) -> bytes:
        return data[(number + 1) * size : (number + 2) * size]

    tables = [s for s in struct.unpack_from("<109I", data, 0x4C) if s < most]
    following, count = struct.unpack_from("<II", data, 0x44)
    for _ in range(min(count, most)):
        if following >= most:
            break
        part = struct.unpack(f"<{size // 4}I", sector(following))
        tables += [s for s in part[:-1] if s < most]
        following = part[-1]
    table = [n for s in tables[:most] for n in struct.unpack(f"<{size // 4}I", sector(s).ljust(size, b"\xff"))]

    def chain(first: int, entries: list[int]) -> Iterator[int]:
        for _ in range(len(entries) + 1):
            if first >= len(entries):
                return
            yield first
            first = entries[first]
        raise ValueError("a chain of sectors without an end")

    start, cutoff, small_start = (struct.unpack_from("<I", data, at)[0] for at in (0x30, 0x38, 0x3C))
    directory = b"".join(map(sector, chain(start, table)))
    root = wanted = None
    for at in range(0, len(directory) - 127, 128):
        length, kind = struct.unpack_from("<H", directory, at + 64)[0], directory[at + 66]
        name = directory[at : at + max(0, min(length, 64) - 2)].decode("utf-16-le")
        entry = struct.unpack_from("<II", directory, at + 116)
        root = entry if kind == 5 else root
        wanted = entry if kind == 2 and name in ("Workbook", "Book") else wanted
    if wanted is None or root is None:
        raise ValueError("no workbook")
    begin, length = wanted
    if length >= cutoff:
        return b"".join(map(sector, chain(begin, table)))[:length]
    whole = b"".join(map(sector, chain(root[0], table)))
    fat = b"".join(map(sector, chain(small_start, table)))
    entries = list(struct.unpack(f"<{len(fat) // 4}I", fat))
    return b"".join(whole[64 * s : 64 * s + 64] for s in chain(begin, entries))[:length]


def _records(stream: bytes) -> Iterator[tuple[int, bytes]]:
    at = 0
    while at + 4 <= len(stream):
        kind, length = struct.unpack_from("<HH", stream, at)
        yield kind, stream[at + 4 : at + 4 + length]
        at += 4 + length


def _sheets(stream: bytes) -> list[dict[tuple[int, int], str]]:
    texts: list[str] = []
    parts: list[bytes] = []
    sheets: list[dict[tuple[int, int], str]] = []
    total = 0
    for kind, body in _records(stream):
        if kind == 0x002F:
            raise ValueError("encrypted")
        if kind == _SST or (kind == _CONTINUE and parts):
            parts.append(body)
            continue
        if parts:
            texts, parts = _strings(parts), []
        if kind == _BOF:
            sheets.append({})
            continue
        if not sheets or kind not in (_NUMBER, _RK, _MULRK, _LABELSST, _LABEL, _FORMULA):
            continue
        row, column = struct.unpack_from("<HH", body)
        cells = sheets[-1]
        if kind in (_NUMBER, _FORMULA):
            if kind == _NUMBER or body[12:14] != b"\xff\xff":
                cells[row, column] = f"{struct.unpack_from('<d', body, 6)[0]:.12g}"
        elif kind == _RK:
            cells[row, column] = _rk(struct.unpack_from("<I", body, 6)[0])
        elif kind == _MULRK:
            for k in range((len(body) - 6) // 6):
                cells[row, column + k] = _rk(struct.unpack_from("<I", body, 6 + 6 * k)[0])
        elif kind == _LABELSST:
            cells[row, column] = texts[struct.unpack_from("<I", body, 6)[0]]
        else:
            count = struct.unpack_from("<H", body, 6)[0]
            wide = len(body) > 8 and body[8] == 1
            cells[row, column] = (
                body[9 : 9 + 2 * count].decode("utf-16-le") if wide else body[9 : 9 + count].decode("latin-1")
            )
        total += 1
        if total > _MOST_CELLS:
            raise ValueError("too many cells")
    return [{at: " ".join(text.split())[:_LONGEST_LINE] for at, text in cells.items()} for cells in sheets]


def _rk(value: int) -> str:
    """Number in 30 bits: a double's high ones, or an integer; over 100 if the first bit is set."""
    number = float(struct.unpack("<i", struct.pack("<I", value & 0xFFFFFFFC))[0] >> 2) if value & 2 else 0.0
    if not value & 2:
        number = struct.unpack("<d", struct.pack("<II", 0, value & 0xFFFFFFFC))[0]
    return f"{number / 100.0 if value & 1 else number:.12g}"


def _strings(parts: list[bytes]) -> list[str]:
    """Shared strings; a continued string states its width again in the next record."""
    part, at = 0, 8
    unique = struct.unpack_from("<I", parts[0], 4)[0]
    out: list[str] = []

    def take(count: int) -> bytes:
        nonlocal part, at
        found = b""
        while len(found) < count:
            piece = parts[part][at : at + count - len(found)]
            found += piece
            at += len(piece)
            if len(found) < count:
                part, at = part + 1, 0
        return found

    while len(out) < unique:
        if at >= len(parts[part]):
            if part + 1 >= len(parts):
                break
            part, at = part + 1, 0
        count, flags = struct.unpack("<HB", take(3))
        runs = struct.unpack("<H", take(2))[0] if flags & 8 else 0
        extra = struct.unpack("<I", take(4))[0] if flags & 4 else 0
        text, wide = "", bool(flags & 1)
        while len(text) < count:
            room = (len(parts[part]) - at) // (2 if wide else 1)
            here = min(count - len(text), room)
            piece = take(here * (2 if wide else 1))
            text += piece.decode("utf-16-le") if wide else piece.decode("latin-1")
            if len(text) < count:
                part, at = part + 1, 0
                wide = bool(take(1)[0] & 1)
        take(4 * runs + extra)
        out.append(text)
    return out


def _read(path: Path, options: ReadOptions) -> PressureRecording:
    from plantar.formats import detect_format

    lines = lines_of_workbook(read_input(path, FormatError, _LARGEST))
    with TemporaryDirectory(prefix="plantar-") as folder:
        text = Path(folder) / f"{path.stem}.txt"
        text.write_text("\n".join(lines) + "\n", encoding="utf-8")
        found = detect_format(text)
        if found.read is None:
            raise FormatError("the workbook holds no recording")
        return replace(found.read(text, options), path=path)


FORMAT = Format(
    name="xls",
    title="binary Excel workbook of a text export, such as footscan's",
    suffixes=(".xls",),
    recognises=_recognises,
    read=_read,
    order=30,
)
