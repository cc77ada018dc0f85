"""Footsteps of a stack (n, times, rows, columns), one by one, with their table metadata.csv.

StepUP-P150's pipeline 1 turns each footstep upright (toes at row 0, medial as it was), puts the middle of its box in
the middle of the grid, and takes the nearest of its frames at 101 times from the first to the last. Here the frames of
100 Hz are taken back, each once.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plantar.errors import FormatError
from plantar.formats.grid_file import open_grid
from plantar.formats.step_table import NAME, StatedStep, StepTable
from plantar.formats.walkway import PITCH, WalkwayFile
from plantar.layouts.cell_grid import CellGrid
from plantar.recordings.walkway_step import WalkwayStep

_BLOCK = 8_000_000  # bytes of footsteps that are read together
_ONE = 1e-3  # Distance from 1 of the mean sum of a footstep that was divided by it


def steps_of_stack(file: WalkwayFile, table: StepTable | None) -> Iterator[WalkwayStep]:
    """Yields the footsteps that its table lists, in the order of the stack; empty ones are left out.

    Raises:
        FormatError: Without a table, or if the stack has no such footstep, negative values, or shares of a mean.
    """
    if table is None:
        raise FormatError(
            f"a stack of footsteps without {NAME} beside it, which states side, first and last frame of each: no "
            "contact time is known; allowed: both files in one folder"
        )
    stated = {step.number: step for step in table.steps}
    with open_grid(file.path) as array:
        if max(stated) >= array.shape[0]:
            raise FormatError(
                f"{NAME} lists footstep {max(stated)}, the stack has {array.shape[0]}, from 0; allowed: its own table"
            )
        place = 0
        for block in array.blocks(_BLOCK):
            for values in block:
                if place in stated:
                    step = _step(values, stated[place], file)
                    if step is not None:
                        yield step
                place += 1


def frames_of_times(times: int, frames: int) -> NDArray[np.int64]:
    """Which of a stack's times (n,) show the frames of a footstep: each once where there are fewer than times.

    Example:
        >>> frames_of_times(101, 51)[:4].tolist()
        [0, 2, 4, 6]
    """
    if frames > times:
        return np.arange(times)
    return np.rint(np.arange(frames) * (times - 1) / (frames - 1)).astype(np.int64)


def _step(values: NDArray[Any], stated: StatedStep, file: WalkwayFile) -> WalkwayStep | None:
    times, rows, columns = values.shape
    flat = values.reshape(times, rows * columns)
    highest = flat.max(axis=0)
    kept = np.flatnonzero(highest > 0)
    if not len(kept):
        return None
    frames = stated.end - stated.begin + 1
    chosen = frames_of_times(times, frames)
    pressure = np.take(flat[chosen], kept, axis=1)
    if values.dtype.kind != "u" and not (np.isfinite(highest).all() and values.min() >= 0):
        raise FormatError(f"footstep {stated.number} holds values below 0, or that are no numbers; allowed: pressures")
    if values.dtype.kind == "f" and abs(float(flat.sum()) / times - 1.0) < _ONE:
        raise FormatError(
            f"footstep {stated.number} is divided by its mean sum, as in StepUP-P150's pipeline 2: no pressure is "
            "known; allowed: pipeline 1"
        )
    row, column = np.divmod(kept, columns)
    # Upright seen from above: forward is to row 0, left to column 0.
    cells = CellGrid(rows - 1 - row, columns - 1 - column, (PITCH, PITCH))
    at = stated.begin + chosen * (frames - 1) / (times - 1) if frames > times else stated.begin + np.arange(frames)
    return WalkwayStep(
        side=stated.side,
        cells=cells,
        force=np.multiply(pressure, file.factor * PITCH**2, dtype=float),
        time=at / file.rate_hz,
        strike=stated.begin / file.rate_hz,
        lift=stated.end / file.rate_hz,
        walk=stated.walk,
        forward=np.array([1.0, 0.0]),
        pose=_pose(stated, (rows, columns)),
        unused=stated.unused,
    )


def _pose(stated: StatedStep, shape: tuple[int, int]) -> tuple[float, float, float] | None:
    """Place of the grid's frame on the walkway, in the direction of walking: middle of box to middle of grid."""
    if stated.box is None or stated.backwards is None or stated.turn_deg is None:
        return None
    first_row, last_row, first_column, last_column = stated.box
    middle = 0.5 * PITCH * np.array([first_row + last_row + 1, first_column + last_column + 1])
    turn = -np.radians(stated.turn_deg) + (np.pi if stated.backwards else 0.0)
    c = np.cos(turn)
    s = np.sin(turn)
    corner = middle - np.array([[c, -s], [s, c]]) @ (0.5 * PITCH * np.array(shape))
    return float(corner[0]), float(corner[1]), float(turn)
