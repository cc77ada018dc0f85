"""The registry of formats."""

import bz2
import gzip
import lzma
import zipfile

import pytest

from plantar import FormatError
from plantar.formats import detect_format, formats, read_recording


def test_each_format_is_registered_under_its_own_name():
    for name, entry in formats().items():
        assert name == entry.name
        assert entry.title
        assert all(suffix.startswith(".") or suffix == "folder" for suffix in entry.suffixes)
        assert not entry.recognises(b"")
        assert not entry.recognises(b"\x00" * 64)


def test_an_unknown_format_lists_the_allowed_ones(tmp_path):
    with pytest.raises(FormatError, match="unknown format 'gaitrite'; allowed: mcap, pedar"):
        read_recording(tmp_path / "x", "gaitrite")


def test_unreadable_files_are_named(tmp_path):
    for path in (tmp_path / "none.asc", tmp_path):
        with pytest.raises(FormatError, match="cannot be read"):
            detect_format(path)
        for name in formats():
            with pytest.raises(FormatError, match="cannot be read"):
                read_recording(path, name)


def test_an_excel_workbook_is_named(tmp_path):
    with zipfile.ZipFile(tmp_path / "walk.xlsx", "w") as archive:
        archive.writestr("xl/workbook.xml", "<workbook/>")
    with pytest.raises(FormatError, match=r"an Excel workbook \(.xlsx\); allowed: its sheet saved as CSV"):
        detect_format(tmp_path / "walk.xlsx")


@pytest.mark.parametrize("packed", [gzip.compress, bz2.compress, lzma.compress])
def test_a_packed_recording_is_to_be_unpacked(packed, tmp_path):
    file = tmp_path / "walk.csv.packed"
    file.write_bytes(packed(b"time,left,right\n0,1,2\n0.01,2,3\n"))
    with pytest.raises(FormatError, match="packed; allowed: what it holds, unpacked"):
        read_recording(file)
