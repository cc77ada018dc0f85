"""Large tables of frames: what lies in a file behaves as what lies in memory."""

import errno
from pathlib import Path

import numpy as np
import pytest

from plantar.errors import InputError
from plantar.recordings import frame_table as module
from plantar.recordings.frame_table import FrameTable, blocks_of_frames, column_extremes, let_go, room, scale_frames


@pytest.mark.parametrize("large", [0, 10**9])
def test_a_table_keeps_its_numbers_wherever_it_lies(monkeypatch, large):
    """Growing, letting go, scaling and reading again; with a limit of 0 everything lies in a file."""
    monkeypatch.setattr(module, "LARGE", large)
    monkeypatch.setattr(module, "_BLOCK", 50)
    truth = np.random.default_rng(0).normal(0.0, 1.0, (101, 7))
    table = FrameTable(7, 3)
    for begin in range(0, 101, 10):
        table.add(truth[begin : begin + 10])
    rows = table.rows
    assert np.array_equal(rows, truth)
    scale_frames(rows, np.arange(7.0))
    let_go(rows)
    assert np.array_equal(rows, truth * np.arange(7.0))
    assert sum(part.stop - part.start for part in blocks_of_frames(rows)) == 101
    rows[5, 3] = np.nan
    low, high, lacking = column_extremes(rows)
    with_zero = np.vstack([rows, np.zeros(7)])
    assert low.tolist() == np.nanmin(with_zero, axis=0).tolist()
    assert high.tolist() == np.nanmax(with_zero, axis=0).tolist()
    assert [part.start <= 5 < part.stop for part in lacking] == [True]


@pytest.mark.skipif(
    "not hasattr(__import__('os'), 'pwrite')", reason="tables are assigned where files cannot be written"
)
def test_a_full_disk_is_reported(monkeypatch):
    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(module, "LARGE", 0)
    monkeypatch.setattr(module.os, "pwrite", full)
    with pytest.raises(InputError, match=r"no room in .* \(No space left on device\); free some, or name another"):
        FrameTable(2, 3).add(np.ones((3, 2)))


@pytest.mark.skipif("not __import__('sys').platform.startswith('linux')", reason="reads /proc")
def test_room_in_a_file_takes_no_memory():
    before = _resident()
    table = room(50_000_000, 4)
    table[::10_000_000] = 1.0
    assert table[10_000_000].tolist() == [1.0] * 4
    assert _resident() - before < 100_000  # kB: of a table of 1.6 GB
    assert room(2, 3).shape == (2, 3)


def _resident() -> int:
    """Memory in kB that this process holds."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("VmRSS"))
