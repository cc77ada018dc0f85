"""Passes over a walkway: frames of a stream that carry load, as samples of loaded cells."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FormatError
from plantar.formats.grid_file import open_grid
from plantar.formats.walkway import PITCH, THRESHOLD, WalkwayFile
from plantar.layouts.cell_grid import CellGrid

_BLOCK = 8_000_000  # bytes of frames that are looked at together
_PAUSE = 1.0  # s without load after which another pass begins
_MOST = 30_000_000  # Samples of one pass: 200 footsteps that overlap
_WORD = 8  # cells of one byte that are looked at at once


@dataclass(frozen=True, eq=False)
class WalkwayPass:
    """Load of a pass: m frames of k cells.

    `first`: number of its first frame; `cells`: those that are ever loaded; `force`: force (m, k) in N; `shape`: rows
    and columns of the walkway.
    """

    first: int
    cells: CellGrid
    force: NDArray[np.float64]
    shape: tuple[int, int]


def passes_of(file: WalkwayFile) -> Iterator[WalkwayPass]:
    """Yields passes in order, parted by 1 s without load.

    Raises:
        FormatError: For values below 0, or a pass without end.
    """
    with open_grid(file.path) as array:
        shape = (array.shape[1], array.shape[2])
        least = THRESHOLD / file.factor
        pause = round(_PAUSE * file.rate_hz)
        held: list[_Samples] = []
        count = 0
        loaded = -1  # the last frame that carries load
        first = 0
        for block in array.blocks(_BLOCK):
            for part in _split(_samples(block, first, least), loaded, pause):
                if held and part.loaded.size and part.loaded[0] - loaded > pause:
                    yield _pass_of(held, file.factor, shape)
                    held = []
                    count = 0
                if part.loaded.size:
                    loaded = int(part.loaded[-1])
                    held.append(part)
                    count += len(part.cell)
                if count > _MOST:
                    raise FormatError(
                        f"the walkway carries load without a pause from frame {int(held[0].frame[0])} on, more than "
                        f"{_MOST:g} loaded cells; allowed: passes, and cells that read 0 where nobody stands"
                    )
            first += len(block)
        if held:
            yield _pass_of(held, file.factor, shape)


@dataclass(frozen=True, eq=False)
class _Samples:
    """Values above 0: frame, cell and value (n,) each; `loaded`: frames (j,) with a cell above the threshold."""

    frame: NDArray[np.int64]
    cell: NDArray[np.int64]
    value: NDArray[Any]
    loaded: NDArray[np.int64]


def _samples(block: NDArray[Any], first: int, least: float) -> _Samples:
    frames = len(block)
    flat = block.reshape(frames, -1)
    cells = flat.shape[1]
    if block.dtype.itemsize == 1 and cells % _WORD == 0:
        words = np.flatnonzero(flat.view(np.uint64))
        row, byte = np.nonzero(flat.reshape(-1, _WORD)[words])
        at = words[row] * _WORD + byte
    else:
        at = np.flatnonzero(flat)
    value = flat.reshape(-1)[at]
    if block.dtype.kind != "u" and not (value >= 0).all():
        raise FormatError("the walkway holds values below 0, or that are no numbers; allowed: pressures")
    frame = at // cells
    loaded = np.flatnonzero(np.bincount(frame[value > least], minlength=frames)) + first
    return _Samples(frame + first, at % cells, value, loaded)


def _split(samples: _Samples, loaded: int, pause: int) -> Iterator[_Samples]:
    """Samples parted where no frame carries load for a pause."""
    frames = samples.loaded
    ends = np.flatnonzero(np.diff(frames, prepend=loaded if loaded >= 0 else frames[:1]) > pause)
    bounds = [0, *ends[ends > 0].tolist(), len(frames)]
    for a, b in pairwise(bounds):
        own = frames[a:b]
        if not len(own):
            continue
        low = np.searchsorted(samples.frame, own[0])
        high = np.searchsorted(samples.frame, own[-1], side="right")
        part = slice(int(low), int(high))
        yield _Samples(samples.frame[part], samples.cell[part], samples.value[part], own)


def _pass_of(parts: list[_Samples], factor: float, shape: tuple[int, int]) -> WalkwayPass:
    frame = np.concatenate([part.frame for part in parts])
    cell = np.concatenate([part.cell for part in parts])
    value = np.concatenate([part.value for part in parts])
    index = np.zeros(shape[0] * shape[1], dtype=np.int64)
    index[cell] = 1
    kept = np.flatnonzero(index)
    index[kept] = np.arange(len(kept))
    first = int(frame[0])
    force = np.zeros((int(frame[-1]) - first + 1, len(kept)))
    force[frame - first, index[cell]] = value * (factor * PITCH**2)
    row, column = np.divmod(kept, shape[1])
    return WalkwayPass(first, CellGrid(row, column, (PITCH, PITCH)), force, shape)
